// What a headset does wrong, each once: it is told, nothing is lost, and the session goes on.
#include <array>

#include "tests/devices/openxr_headset.h"

namespace parafovea {
namespace {

// Runs frames up to the runtime's frame `last` and returns what was begun.
std::vector<OpenXrFrame> run_frames(OpenXrSession& session, Headset& headset, int count,
                                    SimulatedClock& clock) {
    std::vector<OpenXrFrame> frames;
    for (int i = 0; i < count; ++i) {
        const std::optional<OpenXrFrame> frame = run_frame(session, headset.gpu());
        if (!frame) continue;
        clock.wait_until(frame->display_time);
        frames.push_back(*frame);
    }
    return frames;
}

std::vector<std::size_t> faulty(const std::vector<OpenXrFrame>& frames, DisplayTimeFault fault) {
    std::vector<std::size_t> indices;
    for (std::size_t i = 0; i < frames.size(); ++i)
        if (frames[i].checked.fault == fault) indices.push_back(i);
    return indices;
}

void expect_times_increase(const std::vector<OpenXrFrame>& frames) {
    for (std::size_t i = 1; i < frames.size(); ++i)
        EXPECT_LT(frames[i - 1].display_time, frames[i].display_time) << i;
}

TEST(OpenXrFault, NegativeTimesAreToldAndReplaced) {
    Headset headset("pacing=simulated;negative_time@20:3");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    const std::vector<OpenXrFrame> frames = run_frames(session, headset, 40, clock);
    ASSERT_EQ(frames.size(), 40u);
    EXPECT_THAT(faulty(frames, DisplayTimeFault::not_positive), testing::ElementsAre(20, 21, 22));
    EXPECT_LT(frames[20].predicted.ns, 0) << "the raw time is kept";
    expect_times_increase(frames);
    for (const OpenXrFrame& frame : frames) EXPECT_EQ(frame.checked.missed_refreshes, 0);
}

TEST(OpenXrFault, TimesThatRunBackwardsAreToldAndReplaced) {
    Headset headset("pacing=simulated;backwards_time@20:2");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    const std::vector<OpenXrFrame> frames = run_frames(session, headset, 40, clock);
    EXPECT_THAT(faulty(frames, DisplayTimeFault::backwards), testing::ElementsAre(20, 21));
    EXPECT_LT(frames[20].predicted, frames[19].predicted);
    expect_times_increase(frames);
}

TEST(OpenXrFault, LateFramesAreCountedRefreshByRefresh) {
    Headset headset("pacing=simulated;late@20:3;late@30");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    const std::vector<OpenXrFrame> frames = run_frames(session, headset, 40, clock);
    for (std::size_t i = 0; i < frames.size(); ++i)
        EXPECT_EQ(frames[i].checked.missed_refreshes, i == 20 ? 3 : i == 30 ? 1 : 0) << i;
    EXPECT_THAT(faulty(frames, DisplayTimeFault::none), testing::SizeIs(40));
}

TEST(OpenXrFault, ALostSessionIsMadeAgainAndKeepsCountingTime) {
    Headset headset("pacing=simulated;session_lost@20");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    const std::vector<OpenXrFrame> before = run_frames(session, headset, 20, clock);
    ASSERT_EQ(before.size(), 20u);
    EXPECT_FALSE(session.begin_frame());
    EXPECT_EQ(session.state(), SessionState::lost);
    EXPECT_FALSE(session.begin_frame()) << "for good";
    EXPECT_EQ(session.read_gaze({1}).activity, GazeActivity::absent);

    ASSERT_TRUE(session.restart());
    EXPECT_EQ(session.restarts(), 1);
    run_until_focused(session, headset.gpu());
    const std::vector<OpenXrFrame> after = run_frames(session, headset, 5, clock);
    ASSERT_EQ(after.size(), 5u);
    EXPECT_LT(before.back().display_time, after.front().display_time);
    EXPECT_TRUE(after.front().should_render);
}

TEST(OpenXrFault, AHeadsetTakenOffAndPutOnAgainGoesOn) {
    Headset headset("pacing=simulated;stopping@10");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    std::vector<SessionState> seen;
    for (int i = 0; i < 40; ++i) {
        run_frame(session, headset.gpu());
        if (seen.empty() || seen.back() != session.state()) seen.push_back(session.state());
    }
    using enum SessionState;
    EXPECT_THAT(seen, testing::ElementsAre(starting, synchronized, visible, focused, visible, synchronized,
                                           starting, synchronized, visible, focused));
}

TEST(OpenXrFault, TheUserMayQuit) {
    Headset headset("pacing=simulated;exiting@10");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    for (int i = 0; i < 30; ++i) run_frame(session, headset.gpu());
    EXPECT_EQ(session.state(), SessionState::exiting);
}

TEST(OpenXrFault, WhatIsHiddenIsNotDrawn) {
    Headset headset("pacing=simulated;hidden@10:10");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    const std::vector<OpenXrFrame> frames = run_frames(session, headset, 40, clock);
    ASSERT_EQ(frames.size(), 40u);
    EXPECT_TRUE(frames[10].should_render);
    EXPECT_FALSE(frames[18].should_render);
    EXPECT_TRUE(frames[39].should_render);
    EXPECT_EQ(session.state(), SessionState::focused);
}

TEST(OpenXrFault, AnotherApplicationMayTakeTheFocus) {
    Headset headset("pacing=simulated;unfocused@10:10");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    run_frames(session, headset, 15, clock);
    EXPECT_EQ(session.state(), SessionState::visible);
    EXPECT_EQ(session.read_gaze(*headset.instance().device_from_host(clock.now())).activity,
              GazeActivity::absent);
    run_frames(session, headset, 15, clock);
    EXPECT_EQ(session.state(), SessionState::focused);
}

// The layers are really listening: misuse that they must complain of is told.
TEST(OpenXrFault, TheValidationLayerWouldSpeakUp) {
    const TemporaryFolder folder;
    setenv("XR_RUNTIME_JSON", SIMULATED_HEADSET_JSON, 1);
    setenv("PARAFOVEA_HEADSET", "", 1);
    setenv("XR_ENABLE_API_LAYERS", "XR_APILAYER_LUNARG_core_validation", 1);
    setenv("XR_CORE_VALIDATION_EXPORT_TYPE", "text", 1);
    setenv("XR_CORE_VALIDATION_FILE_NAME", (folder / "openxr.txt").c_str(), 1);
    {
        const OpenXrInstance instance;
        XrSystemGetInfo wrong{XR_TYPE_SYSTEM_GET_INFO, nullptr, static_cast<XrFormFactor>(77)};
        XrSystemId system = XR_NULL_SYSTEM_ID;
        EXPECT_NE(xrGetSystem(instance.handle(), &wrong, &system), XR_SUCCESS);
    }
    EXPECT_THAT(text_of(folder / "openxr.txt"),
                testing::HasSubstr("VUID-XrSystemGetInfo-formFactor-parameter"));
}

}  // namespace
}  // namespace parafovea
