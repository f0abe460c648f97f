// Sessions on the simulated headset, through Debian's OpenXR loader and both validation layers.
#include "devices/openxr/openxr_session.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "tests/devices/openxr_headset.h"

namespace parafovea {
namespace {

using testing::ElementsAre;

TEST(OpenXrSession, WalksFromStartToFocusAndOutAgain) {
    Headset headset("pacing=simulated");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    run_until_focused(session, headset.gpu());
    for (int i = 0; i < 10; ++i) {
        const std::optional<OpenXrFrame> frame = run_frame(session, headset.gpu());
        ASSERT_TRUE(frame);
        EXPECT_TRUE(frame->should_render);
        EXPECT_EQ(frame->views.size(), 2u);
    }
    session.request_exit();
    for (int i = 0; i < 10 && session.update() != SessionState::exiting; ++i)
        run_frame(session, headset.gpu());
    EXPECT_EQ(session.state(), SessionState::exiting);
    EXPECT_FALSE(session.begin_frame());
}

TEST(OpenXrSession, TellsWhatIsThere) {
    Headset headset("pacing=simulated");
    EXPECT_EQ(headset.instance().headset_name(), "Simulated FOVE-like headset");
    EXPECT_EQ(headset.instance().runtime_name(), "Parafovea simulated headset 1.0.0");
    EXPECT_TRUE(headset.instance().has_eye_tracker());
    EXPECT_THAT(headset.instance().view_sizes(), ElementsAre(SizePx{1280, 1440}, SizePx{1280, 1440}));
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    ASSERT_TRUE(session.refresh_hz());
    EXPECT_NEAR(*session.refresh_hz(), 70, 1e-4);
}

TEST(OpenXrSession, KeepsTheHeadsetsRefreshRateWithoutDrift) {
    Headset headset("pacing=simulated");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    run_until_focused(session, headset.gpu());
    const std::optional<OpenXrFrame> first = run_frame(session, headset.gpu());
    constexpr int kFrames = 140;
    std::optional<OpenXrFrame> last;
    for (int i = 0; i < kFrames; ++i) {
        last = run_frame(session, headset.gpu());
        EXPECT_EQ(last->checked.missed_refreshes, 0);
    }
    EXPECT_NEAR((last->display_time - first->display_time).seconds(), kFrames / 70.0, 2e-9);
}

TEST(OpenXrSession, BothEyesSeeOneHundredDegreesFromTheirOwnPlaces) {
    Headset headset("pacing=simulated");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    run_until_focused(session, headset.gpu());
    const std::optional<OpenXrFrame> frame = run_frame(session, headset.gpu());
    ASSERT_EQ(frame->views.size(), 2u);
    const XrView& left = frame->views[0];
    const XrView& right = frame->views[1];
    for (const XrView& view : frame->views)
        EXPECT_NEAR(deg_from_rad(view.fov.angleRight - view.fov.angleLeft), 100, 1e-3);
    EXPECT_FLOAT_EQ(left.fov.angleLeft, -right.fov.angleRight);
    EXPECT_LT(left.fov.angleLeft, -left.fov.angleRight) << "more is seen on the temple's side";
    EXPECT_NEAR(right.pose.position.x - left.pose.position.x, 0.063, 1e-6);
    EXPECT_NEAR(left.pose.orientation.w, 1, 1e-6) << "in the head's frame the eyes do not turn with it";
}

TEST(OpenXrSession, EveryNumberOfViewsIsShownWhole) {
    for (const int views : {1, 2, 4}) {
        SCOPED_TRACE(views);
        Headset headset("pacing=simulated;views=" + std::to_string(views));
        SimulatedClock clock;
        OpenXrSession session(headset.instance(), headset.vulkan(), clock);
        run_until_focused(session, headset.gpu());
        const std::optional<OpenXrFrame> frame = run_frame(session, headset.gpu());
        EXPECT_EQ(frame->views.size(), static_cast<std::size_t>(views));
        const std::string log = text_of(headset.log_path());
        const std::string last = log.substr(log.rfind('\n', log.size() - 2) + 1);
        EXPECT_EQ(std::stoi(last.substr(last.rfind(',') + 1)), views);
    }
}

// What was drawn is what the headset shows, each eye its own.
TEST(OpenXrSession, EachEyeGetsItsOwnPicture) {
    const TemporaryFolder pictures;
    Headset headset("pacing=simulated;capture=" + pictures.path().string() + ";capture@6");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    run_until_focused(session, headset.gpu());
    for (int i = 0; i < 6; ++i) {
        const std::optional<OpenXrFrame> frame = session.begin_frame();
        for (std::size_t view = 0; view < 2; ++view) {
            const std::optional<VkImage> image = session.acquire_image(view);
            draw_colour(headset.gpu(), *image, {view == 0 ? 1.f : 0.f, 0, view == 1 ? 1.f : 0.f, 1});
            session.release_image(view);
        }
        session.end_frame(*frame, true);
    }
    const std::string header = "P6\n1280 1440\n255\n";
    const std::string left = text_of(pictures / "frame_6_view_0.ppm");
    const std::string right = text_of(pictures / "frame_6_view_1.ppm");
    ASSERT_EQ(left.size(), header.size() + 1280 * 1440 * 3);
    ASSERT_EQ(right.size(), left.size());
    for (const std::size_t pixel : {0, 1280 * 720 + 640, 1280 * 1440 - 1}) {
        EXPECT_EQ(left.substr(header.size() + pixel * 3, 3), std::string("\xff\0\0", 3));
        EXPECT_EQ(right.substr(header.size() + pixel * 3, 3), std::string("\0\0\xff", 3));
    }
}

TEST(OpenXrSession, RecentringPutsTheHeadIntoTheMiddleOfTheRoom) {
    Headset headset("pacing=simulated");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock, PictureFrame::room);
    run_until_focused(session, headset.gpu());
    const auto middle = [&] {
        // Of the eyes, at the time of the next frame.
        const std::optional<OpenXrFrame> frame = run_frame(session, headset.gpu());
        clock.wait_until(frame->display_time);
        const XrView &left = frame->views[0], &right = frame->views[1];
        return XrPosef{left.pose.orientation,
                       {(left.pose.position.x + right.pose.position.x) / 2,
                        (left.pose.position.y + right.pose.position.y) / 2,
                        (left.pose.position.z + right.pose.position.z) / 2}};
    };
    for (int i = 0; i < 100; ++i) middle();
    const XrPosef before = middle();
    EXPECT_GT(before.position.y, 1) << "the origin is on the floor at first";
    EXPECT_GT(std::abs(before.orientation.y), 0.03) << "and the head has turned";
    ASSERT_TRUE(session.recentre());
    const XrPosef after = middle();
    // The head turns at most 3.2 degrees a second: 0.05 degrees, or 0.0004 of a quaternion, a frame.
    EXPECT_NEAR(after.position.x, 0, 1e-6);
    EXPECT_NEAR(after.position.y, 0, 1e-6);
    EXPECT_NEAR(after.orientation.y, 0, 1e-3);
    EXPECT_NEAR(after.orientation.w, 1, 1e-5);
}

TEST(OpenXrSession, AnotherRefreshRateCanBeAskedFor) {
    Headset headset("pacing=simulated");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    EXPECT_THAT(session.refresh_rates(), ElementsAre(60, 70, 90));
    run_until_focused(session, headset.gpu());
    session.request_refresh_rate(90);
    EXPECT_NEAR(*session.refresh_hz(), 90, 1e-4);
    const std::optional<OpenXrFrame> a = run_frame(session, headset.gpu());
    const std::optional<OpenXrFrame> b = run_frame(session, headset.gpu());
    EXPECT_NEAR((b->display_time - a->display_time).seconds(), 1 / 90.0, 2e-9);
    EXPECT_EQ(b->checked.missed_refreshes, 0);
}

TEST(OpenXrSession, TheRateFollowsFromTheFramesWhereTheRuntimeDoesNotSayIt) {
    Headset headset("pacing=simulated;refresh_hz=72;without=XR_FB_display_refresh_rate");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    EXPECT_FALSE(session.refresh_hz());
    run_until_focused(session, headset.gpu());
    EXPECT_NEAR(*session.refresh_hz(), 72, 1e-4);
    EXPECT_THAT(session.refresh_rates(), testing::IsEmpty());
}

// A mesh of the corners: each triangle lies on the field's edge and none reaches the middle.
TEST(OpenXrSession, TheLensesHideOnlyTheCorners) {
    Headset headset("pacing=simulated");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    const std::vector<XrVector2f> corners = session.hidden_triangles(0);
    ASSERT_EQ(corners.size(), 12u);
    double area = 0;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const XrVector2f a = corners[i], b = corners[i + 1], c = corners[i + 2];
        area += std::abs((b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y)) / 2;
        for (const XrVector2f p : {a, b, c}) EXPECT_GT(std::hypot(p.x, p.y), 0.8);
    }
    // Each corner cuts a fifth of both sides: 4 * (1/5)^2 / 2 of the field.
    const double width = std::tan(rad_from_deg(52)) + std::tan(rad_from_deg(48));
    EXPECT_NEAR(area / (width * width * 1440 / 1280), 0.08, 1e-5);
}

// In a process of its own: the loader remembers what a runtime offers.
[[noreturn]] void open_and_exit(const char* settings) {
    setenv("XR_RUNTIME_JSON", SIMULATED_HEADSET_JSON, 1);
    setenv("PARAFOVEA_HEADSET", settings, 1);
    unsetenv("XR_ENABLE_API_LAYERS");
    try {
        const OpenXrInstance instance;
    } catch (const std::runtime_error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        std::_Exit(1);
    }
    std::_Exit(0);
}

TEST(OpenXrInstance, SaysWhatIsMissingInOneLine) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(open_and_exit("headset=unplugged"), testing::ExitedWithCode(1),
                "no headset is connected; plug it in");
    EXPECT_EXIT(open_and_exit("without=XR_KHR_convert_timespec_time"), testing::ExitedWithCode(1),
                "lacks XR_KHR_convert_timespec_time");
    EXPECT_EXIT(open_and_exit("without=XR_KHR_vulkan_enable2"), testing::ExitedWithCode(1),
                "lacks XR_KHR_vulkan_enable2");
    EXPECT_EXIT(open_and_exit("gaze=none"), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace parafovea
