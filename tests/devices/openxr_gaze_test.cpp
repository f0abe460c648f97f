// The eye tracker of an OpenXR headset, against the recording that the simulated one plays.
#include "devices/openxr/openxr_gaze.h"

#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "devices/gaze_recording.h"
#include "tests/devices/openxr_headset.h"

namespace parafovea {
namespace {

constexpr std::int64_t kSample_ns = 8'333'333;

// A 120 Hz recording that looks somewhere else in every sample, with a blink in each second.
std::vector<GazeSample> wandering_gaze(int count) {
    std::vector<GazeSample> samples;
    for (int i = 0; i < count; ++i) {
        GazeSample sample;
        sample.sequence = i;
        sample.host_time = sample.arrival_time = {i * kSample_ns};
        sample.device_time = {i * kSample_ns};
        const bool blinks = i % 120 >= 100 && i % 120 < 112;
        sample.status = blinks       ? GazeStatus::blink
                        : i % 2 == 0 ? GazeStatus::tracked
                                     : GazeStatus::low_accuracy;
        if (!blinks) sample.direction = DirectionDeg{20 * std::sin(i * 0.05), 15 * std::cos(i * 0.03)};
        samples.push_back(sample);
    }
    return samples;
}

struct Played {
    std::vector<GazeSample> truth, got;
    std::vector<OpenXrFrame> frames;
};

// Plays the recording for `frames` frames, draining before each one as a trial does.
Played play(const std::string& settings, int frames) {
    const TemporaryFolder folder;
    Played played;
    played.truth = wandering_gaze(240);
    {
        std::ofstream file(folder / "gaze.csv");
        write_gaze_csv(file, played.truth);
    }
    Headset headset("pacing=simulated;gaze=" + (folder / "gaze.csv").string() + ";" + settings);
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    OpenXrGaze gaze(session, OpenXrGaze::Looks::at_drain);
    run_until_focused(session, headset.gpu());
    for (int i = 0; i < frames; ++i) {
        const std::optional<OpenXrFrame> frame = run_frame(session, headset.gpu());
        // What is drained next is what could be known when this frame's turn began.
        clock.wait_until({frame->display_time.ns - frame->period.ns});
        gaze.drain(played.got);
        played.frames.push_back(*frame);
    }
    return played;
}

TEST(OpenXrGaze, DeliversEverySampleOfTheTrackerOnceWithItsOwnTime) {
    const Played played = play("", 200);
    // From 200 frames at 70 Hz come 342 samples at 120 Hz; the first wait for the tracker's latency.
    ASSERT_GT(played.got.size(), 335u);
    for (std::size_t i = 1; i < played.got.size(); ++i) {
        EXPECT_NEAR(static_cast<double>((played.got[i].device_time - played.got[i - 1].device_time).ns),
                    static_cast<double>(kSample_ns), 2);
        EXPECT_EQ(played.got[i].sequence, played.got[i - 1].sequence + 1);
    }
}

TEST(OpenXrGaze, DirectionsAndLossesAreThoseOfTheRecording) {
    const Played played = play("", 200);
    // The session began when the recording did, one second after the simulated host's epoch.
    constexpr std::int64_t kBegin_ns = 1'000'000'000;
    int lost = 0, tracked = 0;
    for (const GazeSample& sample : played.got) {
        const double index = static_cast<double>(sample.host_time.ns - kBegin_ns) / kSample_ns;
        EXPECT_NEAR(index, std::round(index), 1e-3);
        const GazeSample& truth = played.truth[static_cast<std::size_t>(std::lround(index)) % 240];
        if (truth.status == GazeStatus::blink) {
            EXPECT_EQ(sample.status, GazeStatus::lost) << "OpenXR cannot tell a blink from a loss";
            EXPECT_FALSE(sample.direction);
            ++lost;
            continue;
        }
        EXPECT_EQ(sample.status, truth.status);
        ASSERT_TRUE(sample.direction);
        EXPECT_LT(angle_between_deg(*sample.direction, *truth.direction), 1e-4);
        ++tracked;
    }
    EXPECT_GT(lost, 20);
    EXPECT_GT(tracked, 200);
}

TEST(OpenXrGaze, TheRawTimeIsTheRuntimesAndTheMappedOneTheHosts) {
    const Played played = play("", 50);
    for (const GazeSample& sample : played.got) {
        EXPECT_GT(sample.device_time.ns, 1'000'000'000'000'000) << "XrTime has an epoch of its own";
        EXPECT_LT(sample.host_time.ns, 10'000'000'000);
        EXPECT_LE(sample.host_time, sample.arrival_time);
        EXPECT_GT(sample.host_time_error.ns, 0);
        EXPECT_LE(sample.host_time_error.ns, 1'000'000);
        // The tracker's latency of 15 ms and up to a frame's wait until somebody drains.
        EXPECT_GE((sample.arrival_time - sample.host_time).ms(), 14.99);
        EXPECT_LE((sample.arrival_time - sample.host_time).ms(), 15 + 1000.0 / 70 + 0.01);
    }
}

TEST(OpenXrGaze, ARuntimeWithoutSampleTimesGivesWiderBoundsAndNoTwins) {
    for (const char* const habit : {"gaze_times=zero", "gaze_times=echo"}) {
        SCOPED_TRACE(habit);
        const Played played = play(habit, 100);
        ASSERT_GT(played.got.size(), 60u);
        const std::optional<DirectionDeg>* last = nullptr;
        for (const GazeSample& sample : played.got) {
            EXPECT_LE(sample.host_time, sample.arrival_time);
            EXPECT_GE(sample.host_time_error.ms(), 2) << "half the span between two looks";
            if (sample.direction && last != nullptr && *last) {
                EXPECT_NE(*sample.direction, **last) << "the same look twice is one sample";
            }
            last = &sample.direction;
        }
    }
}

TEST(OpenXrGaze, AnEyeThatIsNotSeenIsLostDataNotAGap) {
    const Played played = play("gaze_missing@60:20", 120);
    int lost_frames = 0;
    for (const OpenXrFrame& frame : played.frames) {
        const HostTime until = frame.display_time;
        const HostTime from{until.ns - frame.period.ns};
        lost_frames += std::ranges::any_of(played.got, [&](const GazeSample& sample) {
            return sample.status == GazeStatus::lost && sample.arrival_time >= from &&
                   sample.arrival_time < until;
        });
    }
    EXPECT_GE(lost_frames, 20);
    for (std::size_t i = 1; i < played.got.size(); ++i)
        EXPECT_NEAR((played.got[i].host_time - played.got[i - 1].host_time).ms(), 1000.0 / 120, 0.01);
}

TEST(OpenXrGaze, ATrackerThatGoesAwayIsLostDataAndComesBack) {
    const Played played = play("gaze_inactive@60:20", 120);
    // While it is away there are no sample times, so these lie at the looks, and stay coarse.
    std::vector<GazeSample> away;
    std::ranges::copy_if(played.got, std::back_inserter(away),
                         [](const GazeSample& sample) { return sample.host_time_error.ms() > 1; });
    ASSERT_GT(away.size(), 15u);
    for (const GazeSample& sample : away) EXPECT_EQ(sample.status, GazeStatus::lost);
    EXPECT_LT((away.back().host_time - away.front().host_time).ms(), 21 * 1000.0 / 70);
    ASSERT_FALSE(played.got.empty());
    EXPECT_TRUE(played.got.back().direction) << "the tracker is back";
}

TEST(OpenXrGaze, AHeadsetWithoutEyeTrackerIsRefusedInOneLine) {
    Headset headset("pacing=simulated;gaze=none");
    SimulatedClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    EXPECT_FALSE(headset.instance().has_eye_tracker());
    try {
        const OpenXrGaze gaze(session);
        FAIL() << "no tracker, no gaze source";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("no eye tracker of Simulated FOVE-like headset"));
    }
}

// In real time and on a thread of its own, while frames go on and a session is lost and made again.
TEST(OpenXrGaze, ItsThreadDeliversWhileFramesRunAndOutlivesALostSession) {
    const TemporaryFolder folder;
    {
        std::ofstream file(folder / "gaze.csv");
        write_gaze_csv(file, wandering_gaze(240));
    }
    Headset headset("gaze=" + (folder / "gaze.csv").string() + ";session_lost@15");
    SteadyClock clock;
    OpenXrSession session(headset.instance(), headset.vulkan(), clock);
    OpenXrGaze gaze(session);
    run_until_focused(session, headset.gpu());
    std::vector<GazeSample> before, after;
    for (int i = 0; i < 100 && session.state() != SessionState::lost; ++i) run_frame(session, headset.gpu());
    gaze.drain(before);
    ASSERT_EQ(session.state(), SessionState::lost);
    ASSERT_TRUE(session.restart());
    run_until_focused(session, headset.gpu());
    for (int i = 0; i < 10; ++i) run_frame(session, headset.gpu());
    gaze.drain(after);
    const auto seen = [](const std::vector<GazeSample>& samples) {
        return std::ranges::count_if(samples,
                                     [](const GazeSample& sample) { return sample.direction.has_value(); });
    };
    EXPECT_GT(seen(before), 0);
    EXPECT_GT(seen(after), 0);
    EXPECT_GT(after.front().sequence, before.back().sequence);
    EXPECT_EQ(gaze.overflowed(), 0);
}

}  // namespace
}  // namespace parafovea
