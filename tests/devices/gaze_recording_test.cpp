// Reading real and our own recordings, and playing them.
#include "devices/gaze_recording.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <random>
#include <sstream>

#include "devices/replay_gaze.h"
#include "devices/simulated/simulated_gaze.h"
#include "tests/message_of.h"

namespace parafovea {
namespace {

using testing::HasSubstr;

const std::filesystem::path kRecordings = std::filesystem::path(PARAFOVEA_SHARED_DIR) / "gaze_recordings";

std::string error_of(std::string_view text) {
    return message_of([&] { parse_gaze_recording(text, "file.csv"); });
}

std::vector<GazeSample> simulated_samples(std::size_t at_most = 1'000'000) {
    SimulatedClock clock;
    SimulatedGazeSettings settings;
    settings.loss_rate_hz = 1;
    SimulatedGaze gaze(clock, settings);
    gaze.fixate({30, -4});
    clock.wait_until({20'000'000'000});
    std::vector<GazeSample> samples;
    gaze.drain(samples);
    if (samples.size() > at_most) samples.resize(at_most);
    return samples;
}

std::string csv_of(std::span<const GazeSample> samples) {
    std::ostringstream out;
    write_gaze_csv(out, samples);
    return out.str();
}

constexpr std::string_view kHead =
    "OcutimeStamp,leftEyeDirection.x,leftEyeDirection.y,leftEyeDirection.z,"
    "rightEyeDirection.x,rightEyeDirection.y,rightEyeDirection.z,valL,valR\n";

TEST(GazeRecording, OurCsvReadsBackBitForBit) {
    const auto samples = simulated_samples();
    const GazeRecording recording = parse_gaze_recording(csv_of(samples), "own.csv");
    ASSERT_EQ(recording.samples.size(), samples.size());
    EXPECT_NEAR(recording.rate_hz, 120, 0.01);
    int with_pupil = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const GazeSample &a = samples[i], &b = recording.samples[i];
        EXPECT_EQ(a.sequence, b.sequence);
        EXPECT_EQ(a.device_time, b.device_time);
        EXPECT_EQ(a.host_time, b.host_time);
        EXPECT_EQ(a.arrival_time, b.arrival_time);
        EXPECT_EQ(a.status, b.status);
        EXPECT_EQ(a.direction, b.direction);
        if (!a.left->direction) continue;
        ++with_pupil;
        EXPECT_EQ(a.left->direction, b.left->direction);
        EXPECT_EQ(a.right->direction, b.right->direction);
        EXPECT_EQ(a.left->pupil_mm, b.left->pupil_mm);
        EXPECT_EQ(a.right->pupil_mm, b.right->pupil_mm);
    }
    EXPECT_GT(with_pupil, 1000);
    EXPECT_EQ(csv_of(recording.samples), csv_of(samples));
}

TEST(GazeRecording, AHeadMountedRowGivesTheAnglesOfItsUnitVectors) {
    const std::string text = std::string(kHead) +
                             "1000,0,0,1,0,0.5,0.8660254037844386,True,True\n"
                             "9333,0.5,0,0.8660254037844386,0,0,1,True,False\n"
                             "17666,0,0,0,0,0,0,False,False\n";
    const GazeRecording recording = parse_gaze_recording(text, "h.csv");
    ASSERT_EQ(recording.samples.size(), 3u);
    const auto& s = recording.samples;
    EXPECT_EQ(s[0].device_time.ns, 1'000'000);
    EXPECT_EQ(s[0].host_time.ns, 0);
    EXPECT_EQ(s[1].host_time.ns, 8'333'000);
    EXPECT_NEAR(s[0].right->direction->elevation_deg, 30, 1e-9);
    EXPECT_NEAR(s[0].direction->elevation_deg, 15, 1e-9);
    EXPECT_NEAR(s[1].direction->azimuth_deg, 30, 1e-9);
    EXPECT_FALSE(s[1].right->direction);
    EXPECT_EQ(s[2].status, GazeStatus::lost);
    EXPECT_FALSE(s[2].direction);
}

TEST(GazeRecording, AValidationRowGivesAnglesOnItsScreenAndItsTarget) {
    const std::string text =
        "timestamp\tleft_x\tleft_y\tright_x\tright_y\ttarget_id\ttar_x\ttar_y\n"
        "100.5\t100\t0\tnan\tnan\t3\t100\t100\n"
        "108.833\tnan\tnan\tnan\tnan\t-1\t-1\t-1\n";
    const RecordedScreen screen{200, 200, 200, 200, 100};
    const GazeRecording recording = parse_gaze_recording(text, "v.tsv", screen);
    ASSERT_EQ(recording.samples.size(), 2u);
    EXPECT_NEAR(recording.samples[0].direction->azimuth_deg, 45, 1e-12);
    EXPECT_NEAR(recording.targets[0]->direction.elevation_deg, deg_from_rad(std::atan(1 / std::sqrt(2.0))),
                1e-12);
    EXPECT_EQ(recording.targets[0]->id, 3);
    EXPECT_FALSE(recording.targets[1]);
    EXPECT_EQ(recording.samples[1].status, GazeStatus::lost);
    EXPECT_EQ(recording.samples[1].host_time.ns, 8'333'000);
}

TEST(GazeRecording, AMistakeIsNamedWithItsLine) {
    const std::string own = csv_of(simulated_samples(2));
    EXPECT_THAT(error_of(""), HasSubstr("file.csv"));
    EXPECT_THAT(error_of("a,b\n1,2\n"), HasSubstr("file.csv:1: the header"));
    EXPECT_THAT(error_of(own.substr(0, own.find('\n') + 1)), HasSubstr("no samples"));
    EXPECT_THAT(error_of(std::string(kHead) + "1000,0,0,1,0,0,1,True,True\n1,2\n"),
                HasSubstr("file.csv:3: expected 9 fields, found 2"));
    EXPECT_THAT(error_of(std::string(kHead) + "1000,0,0,one,0,0,1,True,True\n"),
                HasSubstr("file.csv:2: \"one\""));
    EXPECT_THAT(error_of(std::string(kHead) + "1.5,0,0,1,0,0,1,True,True\n"), HasSubstr("whole number"));
    EXPECT_THAT(error_of(std::string(kHead) + "2000,0,0,1,0,0,1,True,True\n1000,0,0,1,0,0,1,True,True\n"),
                HasSubstr("backwards"));
    std::string wrong_status = own;
    wrong_status.replace(wrong_status.find("tracked"), 7, "trucked");
    EXPECT_THAT(error_of(wrong_status), HasSubstr("trucked"));
}

TEST(GazeRecording, ATruncatedFileIsReadUpToALineOrRefusedButNeverCrashes) {
    const std::string own = csv_of(simulated_samples(3));
    for (std::size_t length = 0; length < own.size(); ++length) {
        try {
            EXPECT_LE(parse_gaze_recording(own.substr(0, length), "t").samples.size(), 3u);
        } catch (const std::runtime_error&) {
        }
    }
}

TEST(GazeRecording, AMissingFileIsSaidSo) {
    EXPECT_THROW(read_gaze_recording("/nonexistent/gaze.csv"), std::runtime_error);
}

TEST(GazeRecording, TheRealHeadMountedRecordingReads) {
    const auto path = kRecordings / "hmd_binocular_120hz_static2.csv";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
    const GazeRecording recording = read_gaze_recording(path);
    EXPECT_EQ(recording.samples.size(), 616u);
    EXPECT_NEAR(recording.rate_hz, 120, 0.5);
    for (const GazeSample& sample : recording.samples) {
        ASSERT_TRUE(sample.direction);
        EXPECT_LT(angle_between_deg(*sample.left->direction, *sample.right->direction), 15);
        EXPECT_LT(angle_between_deg(*sample.direction, {}), 45);
    }
}

TEST(GazeRecording, TheRealValidationRecordingLooksAtItsTargets) {
    const auto path = kRecordings / "tobii_spectrum_120hz.tsv";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "no " << path;
    const GazeRecording recording = read_gaze_recording(path);
    EXPECT_EQ(recording.samples.size(), 2510u);
    EXPECT_NEAR(recording.rate_hz, 120, 0.5);
    int on_target = 0;
    std::vector<double> errors;
    for (std::size_t i = 0; i < recording.samples.size(); ++i) {
        if (!recording.targets[i]) continue;
        ++on_target;
        errors.push_back(angle_between_deg(*recording.samples[i].direction, recording.targets[i]->direction));
    }
    EXPECT_EQ(on_target, 9 * 120);
    std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
    EXPECT_LT(errors[errors.size() / 2], 1.5);
}

TEST(ReplayGaze, SamplesKeepTheirSpacingAndArriveAsTheClockPasses) {
    GazeRecording recording = parse_gaze_recording(csv_of(simulated_samples()), "own.csv");
    const auto original = recording.samples;
    SimulatedClock clock;
    clock.wait_until({7'000'000'000});
    ReplayGaze replay(clock, recording);
    std::vector<GazeSample> samples;
    while (!replay.finished()) {
        clock.wait_until(clock.now() + Duration::from_ms(14));
        replay.drain(samples);
        ASSERT_TRUE(samples.empty() || samples.back().arrival_time <= clock.now());
    }
    ASSERT_EQ(samples.size(), original.size());
    EXPECT_EQ(samples[0].host_time.ns, 7'000'000'000);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_EQ(samples[i].host_time - samples[0].host_time, original[i].host_time - original[0].host_time);
        EXPECT_EQ(samples[i].arrival_time - samples[i].host_time,
                  original[i].arrival_time - original[i].host_time);
        EXPECT_EQ(samples[i].device_time, original[i].device_time);
        EXPECT_EQ(samples[i].direction, original[i].direction);
    }
}

TEST(ReplayGaze, RepeatingNeverEndsAndCountsOn) {
    const std::string text =
        std::string(kHead) +
        "1000,0,0,1,0,0,1,True,True\n11000,0,0,1,0,0,1,True,True\n21000,0,0,1,0,0,1,True,True\n";
    SimulatedClock clock;
    ReplayGaze replay(clock, parse_gaze_recording(text, "h.csv"), {.repeat = true});
    clock.wait_until({95'000'000});
    std::vector<GazeSample> samples;
    replay.drain(samples);
    ASSERT_EQ(samples.size(), 10u);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_EQ(samples[i].sequence, static_cast<std::int64_t>(i));
        EXPECT_EQ(samples[i].host_time.ns, static_cast<std::int64_t>(i) * 10'000'000);
        EXPECT_EQ(samples[i].device_time.ns, 1'000'000 + static_cast<std::int64_t>(i % 3) * 10'000'000);
    }
    EXPECT_FALSE(replay.finished());
}

}  // namespace
}  // namespace parafovea
