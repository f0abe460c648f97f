// Event detection on made-up gaze whose events are known, on the simulated eye, and on real recordings.
#include "devices/event_detection.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "devices/gaze_recording.h"
#include "devices/simulated/simulated_gaze.h"

namespace parafovea {
namespace {

// 120 Hz gaze from a function of time in seconds; absent where it returns none.
template <typename Function>
std::vector<GazeSample> gaze(double seconds, Function direction, GazeStatus absent = GazeStatus::lost) {
    std::vector<GazeSample> samples;
    for (int i = 0; i < seconds * 120; ++i) {
        GazeSample sample;
        sample.sequence = i;
        sample.host_time = HostTime{} + Duration::from_seconds(i / 120.0);
        sample.direction = direction(i / 120.0);
        sample.status = sample.direction ? GazeStatus::tracked : absent;
        samples.push_back(sample);
    }
    return samples;
}

using Maybe = std::optional<DirectionDeg>;

std::vector<EyeEventKind> kinds(const std::vector<EyeEvent>& events) {
    std::vector<EyeEventKind> result;
    for (const EyeEvent& event : events) result.push_back(event.kind);
    return result;
}

int count(const std::vector<EyeEvent>& events, EyeEventKind kind) {
    int n = 0;
    for (const EyeEvent& event : events) n += event.kind == kind;
    return n;
}

TEST(GazeVelocity, OfAConstantSweepIsItsSpeedAtEveryEccentricity) {
    const auto samples = gaze(2, [](double t) { return Maybe{{-20 + 20 * t, 0}}; });
    for (const auto& v : gaze_velocity(samples)) EXPECT_NEAR(v.value(), 20, 1e-5);
    // At 60 deg elevation a degree of azimuth is half a degree of arc.
    const auto high = gaze(2, [](double t) { return Maybe{{-20 + 20 * t, 60}}; });
    for (const auto& v : gaze_velocity(high)) EXPECT_NEAR(v.value(), 10, 0.01);
}

TEST(GazeVelocity, IsAbsentInAndNotBridgedAcrossGaps) {
    const auto samples = gaze(1, [](double t) {
        return t < 0.4 ? Maybe{{0, 0}} : t < 0.6 ? Maybe{} : Maybe{{30, 0}};
    });
    const auto velocities = gaze_velocity(samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_EQ(velocities[i].has_value(), samples[i].direction.has_value());
        EXPECT_EQ(velocities[i].value_or(0), 0) << i;
    }
    EXPECT_FALSE(gaze_velocity(std::span(samples).first(1))[0].has_value());
    EXPECT_TRUE(gaze_velocity({}).empty());
}

TEST(DetectByVelocity, TwoFixationsAndTheSaccadeBetween) {
    const auto samples = gaze(2, [](double t) {
        return Maybe{{t < 1 ? 0 : t < 1.04 ? 250 * (t - 1) : 10, 5}};
    });
    const auto events = detect_by_velocity(samples);
    ASSERT_THAT(kinds(events),
                testing::ElementsAre(EyeEventKind::fixation, EyeEventKind::saccade, EyeEventKind::fixation));
    EXPECT_NEAR(events[1].begin.ns * 1e-9, 1.0, 0.018);
    EXPECT_NEAR(events[1].end.ns * 1e-9, 1.04, 0.018);
    EXPECT_NEAR(events[1].amplitude_deg, 10, 0.1);
    EXPECT_NEAR(events[1].peak_velocity_deg_per_s, 250, 10);
    EXPECT_NEAR(events[2].centre.azimuth_deg, 10, 0.1);
    EXPECT_NEAR(events[2].centre.elevation_deg, 5, 0.1);
}

TEST(DetectByVelocity, ASpikeInAFixationDoesNotBreakItInTwo) {
    const auto samples = gaze(1, [](double t) { return Maybe{{t > 0.5 && t < 0.509 ? 0.9 : 0, 0}}; });
    EXPECT_THAT(kinds(detect_by_velocity(samples)), testing::ElementsAre(EyeEventKind::fixation));
}

TEST(DetectByVelocity, AFixationTooShortIsNone) {
    const auto samples = gaze(1, [](double t) { return Maybe{{t < 0.5 ? 0 : t < 0.54 ? 8.0 : 16.0, 0}}; });
    EXPECT_EQ(count(detect_by_velocity(samples), EyeEventKind::fixation), 2);
}

TEST(Gaps, AreBlinksWhereTheDeviceSaysSo) {
    const auto look = [](double t) { return t > 0.4 && t < 0.6 ? Maybe{} : Maybe{{0, 0}}; };
    EXPECT_EQ(count(detect_by_velocity(gaze(1, look, GazeStatus::blink)), EyeEventKind::blink), 1);
}

TEST(Gaps, AreBlinksByTheirLengthWhereTheDeviceCannotTell) {
    for (const auto& [length_s, blinks] : {std::pair{0.03, 0}, {0.15, 1}, {0.4, 1}, {0.8, 0}}) {
        const auto look = [&](double t) { return t > 1 && t < 1 + length_s ? Maybe{} : Maybe{{0, 0}}; };
        const auto events = detect_by_dispersion(gaze(3, look));
        EXPECT_EQ(count(events, EyeEventKind::blink), blinks) << length_s;
        EXPECT_EQ(count(events, EyeEventKind::loss), 1 - blinks) << length_s;
    }
}

TEST(DetectByDispersion, FindsFixationsAndLeavesSweepsOut) {
    const auto samples = gaze(3, [](double t) { return Maybe{{t < 1 ? 0 : t < 2 ? 30 * (t - 1) : 30, 0}}; });
    const auto events = detect_by_dispersion(samples);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_NEAR((events[0].end - events[0].begin).seconds(), 1, 0.05);
    EXPECT_NEAR(events[1].centre.azimuth_deg, 30, 0.2);
}

TEST(Detection, OfNothingIsNothing) {
    EXPECT_TRUE(detect_by_velocity({}).empty());
    EXPECT_TRUE(detect_by_dispersion({}).empty());
}

TEST(Detection, TheSimulatedEyesSaccadesAndBlinksAreFound) {
    SimulatedClock clock;
    SimulatedGazeSettings settings;
    settings.noise_sd_deg = 0.05;
    settings.loss_rate_hz = 0;
    settings.eye.microsaccade_rate_hz = 0;
    SimulatedGaze tracker(clock, settings);
    std::vector<GazeSample> samples;
    const int jumps = 40;
    for (int i = 0; i < jumps; ++i) {
        tracker.fixate({i % 2 ? 8.0 : -8.0, 0});
        clock.wait_until(clock.now() + Duration::from_seconds(1.5));
        tracker.drain(samples);
    }
    int large = 0, true_blinks = 0;
    for (std::size_t i = 1; i < samples.size(); ++i)
        true_blinks += samples[i].status == GazeStatus::blink && samples[i - 1].status != GazeStatus::blink;
    const auto events = detect_by_velocity(samples);
    for (const EyeEvent& event : events)
        large += event.kind == EyeEventKind::saccade && event.amplitude_deg > 8;
    EXPECT_GE(large, jumps - 5);  // some hide in blinks
    EXPECT_LE(large, jumps);
    EXPECT_EQ(count(events, EyeEventKind::blink), true_blinks);
    EXPECT_GE(count(events, EyeEventKind::fixation), jumps);
    for (std::size_t i = 1; i < events.size(); ++i) EXPECT_LT(events[i - 1].last, events[i].first);
}

TEST(Detection, TheRealValidationHasAFixationOnEveryTarget) {
    const auto path =
        std::filesystem::path(PARAFOVEA_SHARED_DIR) / "gaze_recordings" / "tobii_spectrum_120hz.tsv";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
    const GazeRecording recording = read_gaze_recording(path);
    const auto by_velocity = detect_by_velocity(recording.samples);
    const auto by_dispersion = detect_by_dispersion(recording.samples);
    for (int id = 1; id <= 9; ++id) {
        std::optional<DirectionDeg> target;
        for (const auto& t : recording.targets)
            if (t && t->id == id) target = t->direction;
        ASSERT_TRUE(target);
        for (const auto* events : {&by_velocity, &by_dispersion}) {
            bool found = false;
            for (const EyeEvent& e : *events)
                found |= e.kind == EyeEventKind::fixation && angle_between_deg(e.centre, *target) < 2 &&
                         e.end - e.begin > Duration::from_ms(300);
            EXPECT_TRUE(found) << id;
        }
    }
}

}  // namespace
}  // namespace parafovea
