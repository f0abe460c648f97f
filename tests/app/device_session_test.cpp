// Whole sessions through the program with gaze from recordings, from FOVE's client library and from a
// Gazepoint server: what the devices deliver is what the file holds, and the validity rules act on it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "study/session_log_reader.h"
#include "tests/app/child_process.h"
#include "tests/app/short_study.h"
#include "tests/devices/fake_gazepoint.h"

namespace parafovea {
namespace {

namespace fs = std::filesystem;

class DeviceSession : public testing::Test {
  protected:
    std::vector<std::string> command(const std::string& protocol, const std::string& gaze) const {
        folder_.write("short.toml", protocol);
        return headless_run(folder_, "data", gaze);
    }
    fs::path file() const { return short_session(folder_, "data"); }

    TemporaryFolder folder_;
};

// The recording as the test reads it: when each sample was made, and whether an eye was seen.
struct RecordedSample {
    std::int64_t device_us = 0;
    bool seen = false;
};

std::vector<RecordedSample> read_csv(const fs::path& path) {
    std::vector<RecordedSample> samples;
    std::ifstream in(path);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
        RecordedSample sample;
        std::from_chars(line.data(), line.data() + line.size(), sample.device_us);
        sample.seen = line.find("False,False") == std::string::npos;
        samples.push_back(sample);
    }
    return samples;
}

// All gaze of a session, within trials and between them, in the order of arrival.
std::vector<GazeSample> all_gaze(const fs::path& path, const SessionRows& rows) {
    std::vector<GazeSample> all;
    for (const GazeBetween& between : read_gaze_between(path)) all.push_back(between.sample);
    for (const TrialRow& trial : rows.trials)
        for (const GazeSample& sample : read_gaze(path, trial.planned.number, trial.attempt))
            all.push_back(sample);
    std::ranges::stable_sort(all, {}, &GazeSample::sequence);
    return all;
}

bool has(const TrialRow& trial, const std::string& rule) {
    return std::ranges::find(trial.invalid, rule) != trial.invalid.end();
}

// Each trial that broke a rule at its first showing comes again after the first showings of its session.
void expect_shown_again(const SessionRows& rows) {
    for (const TrialRow& trial : rows.trials) {
        if (trial.attempt > 0 || trial.planned.kind == TrialKind::training) continue;
        const auto again = std::ranges::find_if(rows.trials, [&](const TrialRow& other) {
            return other.planned.number == trial.planned.number && other.attempt == 1;
        });
        EXPECT_EQ(again != rows.trials.end(), !trial.invalid.empty()) << trial.planned.number;
        if (again == rows.trials.end()) continue;
        for (const TrialRow& other : rows.trials)
            if (other.planned.session == trial.planned.session && other.attempt == 0) {
                EXPECT_LT(other.shown, again->shown);
            }
    }
}

class ReplayedRecording : public DeviceSession {
  protected:
    void SetUp() override {
        recording_ = fs::path(PARAFOVEA_SHARED_DIR) / "gaze_recordings/hmd_binocular_120hz_static2.csv";
        if (!fs::exists(recording_)) GTEST_SKIP() << "no " << recording_ << "; it is not part of the project";
    }

    SessionRows run(const fs::path& recording, const std::string& rules) {
        const std::string protocol = short_study_toml({.tables = "[validity]\n" + rules});
        EXPECT_EQ(Child(command(protocol, "replay:" + recording.string())).wait(), 0);
        return read_session(file());
    }

    fs::path recording_;
};

TEST_F(ReplayedRecording, EverySampleIsStoredOnceWithItsOwnDeviceTime) {
    const SessionRows rows = run(recording_, "repeats = 0\n");
    EXPECT_TRUE(rows.finished);
    const std::vector<RecordedSample> recorded = read_csv(recording_);
    const std::vector<GazeSample> stored = all_gaze(file(), rows);
    ASSERT_GT(stored.size(), recorded.size()) << "the recording repeats";
    const auto count = static_cast<std::int64_t>(recorded.size());
    for (std::size_t i = 0; i < stored.size(); ++i) {
        ASSERT_EQ(stored[i].sequence, stored[0].sequence + static_cast<std::int64_t>(i));
        const RecordedSample& original = recorded[static_cast<std::size_t>(stored[i].sequence % count)];
        ASSERT_EQ(stored[i].device_time.ns, original.device_us * 1000);
        ASSERT_EQ(stored[i].direction.has_value(), original.seen);
        ASSERT_TRUE(stored[i].left && stored[i].right) << "both eyes were recorded";
    }
}

TEST_F(ReplayedRecording, ATrialInWhichTheTrackerFellSilentIsFlaggedAndShownAgain) {
    // This recording was made with three stalls of a tenth of a second: twelve of some 190 samples.
    const SessionRows rows = run(recording_, "gaze_lost_share = 0.04\nrepeats = 1\n");
    EXPECT_TRUE(rows.finished);
    const std::vector<RecordedSample> recorded = read_csv(recording_);
    const auto count = static_cast<std::int64_t>(recorded.size());
    int flagged = 0, clean = 0;
    for (const TrialRow& trial : rows.trials) {
        bool whole = false, any = false;
        std::optional<GazeSample> last;
        for (const GazeSample& sample : all_gaze(file(), rows)) {
            const auto place = static_cast<std::size_t>(sample.sequence % count);
            const bool stall =
                last && place > 0 && recorded[place].device_us - recorded[place - 1].device_us > 100'000;
            for (const Phase phase : {Phase::first_interval, Phase::second_interval}) {
                const IntervalRecord& interval = trial.intervals[static_cast<std::size_t>(phase)];
                if (!stall) continue;
                whole |= last->host_time >= interval.first_display && sample.host_time < interval.end;
                any |= last->host_time < interval.end && sample.host_time > interval.first_display;
            }
            last = sample;
        }
        if (whole) {
            EXPECT_TRUE(has(trial, "gaze_lost")) << trial.planned.number;
        }
        if (!any) {
            EXPECT_FALSE(has(trial, "gaze_lost")) << trial.planned.number;
        }
        flagged += whole;
        clean += !any;
    }
    EXPECT_GT(flagged, 0);
    EXPECT_GT(clean, 0);
    expect_shown_again(rows);
}

TEST_F(ReplayedRecording, GazeFarFromTheCentreAndBlinksBreakTheirRules) {
    // The eyes close for a quarter of a second in every repetition.
    std::ifstream in(recording_);
    std::ofstream out(folder_ / "blinking.csv");
    std::string line;
    for (int number = 0; std::getline(in, line); ++number) {
        const std::size_t flags = line.find("True,True");
        if (number >= 300 && number < 330) line.replace(flags, 9, "False,False");
        out << line << '\n';
    }
    out.close();
    const SessionRows rows = run(folder_ / "blinking.csv",
                                 "gaze_off_center_deg = 15\ngaze_off_share = 0.3\ngaze_lost_share = 0.1\n");
    EXPECT_TRUE(rows.finished);
    const std::vector<RecordedSample> recorded = read_csv(folder_ / "blinking.csv");
    int far_off = 0, blinked = 0, clean = 0;
    for (const TrialRow& trial : rows.trials) {
        int all = 0, unseen = 0, away = 0;
        for (const GazeSample& sample : read_gaze(file(), trial.planned.number, trial.attempt)) {
            for (const Phase phase : {Phase::first_interval, Phase::second_interval}) {
                const IntervalRecord& interval = trial.intervals[static_cast<std::size_t>(phase)];
                if (sample.host_time < interval.first_display || sample.host_time >= interval.end) continue;
                ++all;
                const auto place = static_cast<std::size_t>(sample.sequence) % recorded.size();
                EXPECT_EQ(sample.direction.has_value(), recorded[place].seen);
                unseen += !recorded[place].seen;
                away += sample.direction && angle_between_deg(*sample.direction, {}) > 15;
            }
        }
        EXPECT_EQ(has(trial, "gaze_off_center"), away > 0.3 * (all - unseen)) << trial.planned.number;
        if (unseen > 0.1 * all + 2) {
            EXPECT_TRUE(has(trial, "gaze_lost")) << trial.planned.number;
        }
        // Three stalls of twelve samples each can come on top.
        if (unseen + 36 < 0.1 * all) {
            EXPECT_FALSE(has(trial, "gaze_lost")) << trial.planned.number;
        }
        far_off += has(trial, "gaze_off_center");
        blinked += unseen > 0.1 * all + 2;
        clean += trial.invalid.empty();
    }
    EXPECT_GT(far_off, 0);
    EXPECT_GT(blinked, 0);
    EXPECT_GT(clean, 0);
    expect_shown_again(rows);
}

// Two trials in real time, a calibration of five targets before them.
std::string live_study_toml(const std::string& rules) {
    return short_study_toml({.interval_s = 0.6,
                             .gap_s = 0.1,
                             .alphas = "1",
                             .training_trials = 0,
                             .sessions = 1,
                             .validation_share = 0,
                             .pages = false,
                             .tables = "[calibration]\ntargets = 5\neach_s = 0.7\n[validity]\n" + rules});
}

TEST_F(DeviceSession, FovesClientLibraryDrivesASessionWithItsOwnTimesAndStates) {
    Child program(command(live_study_toml("gaze_lost_share = 0.5\n"), "fove"),
                  {{"LD_LIBRARY_PATH", PARAFOVEA_FAKE_FOVE_FOLDER}});
    ASSERT_EQ(program.wait(), 0);
    const SessionRows rows = read_session(file());
    EXPECT_TRUE(rows.finished);
    EXPECT_EQ(rows.facts.gaze_source, "FOVE, client 1.4.0, service 1.4.2, firmware 30, raw gaze");
    ASSERT_EQ(rows.trials.size(), 2u);
    EXPECT_TRUE(rows.trials[0].answer && rows.trials[1].answer);

    const std::vector<GazeSample> gaze = all_gaze(file(), rows);
    ASSERT_GT(gaze.size(), 300u);
    for (const GazeSample& sample : gaze) {
        const auto frame = sample.sequence % 40;
        ASSERT_EQ((sample.device_time.ns / 1000 - 5'000'000) % 8333, 0) << "microseconds of FOVE's own clock";
        ASSERT_EQ(sample.status == GazeStatus::blink, frame >= 20 && frame < 25);
        ASSERT_EQ(sample.status == GazeStatus::lost, frame == 15);
        ASSERT_LT(sample.host_time, sample.arrival_time);
        if (sample.direction) {
            ASSERT_NEAR(sample.direction->azimuth_deg, 30, 1e-4);
        }
    }
    ASSERT_EQ(rows.calibrations.size(), 1u);
    EXPECT_EQ(rows.calibrations[0].points.size(), 5u);
    EXPECT_FALSE(rows.calibrations[0].accepted) << "this gaze stays at 30 degrees";
}

TEST_F(DeviceSession, AGazepointTrackerThatGoesAwayAndComesBackSpoilsATrialAndNothingElse) {
    FakeGazepoint tracker;
    Child program(command(live_study_toml("gaze_lost_share = 0.4\nrepeats = 5\n"),
                          "gazepoint:127.0.0.1:" + std::to_string(tracker.port())));
    const auto trials = [&]() -> std::vector<TrialRow> {
        try {
            if (!file().empty()) return read_session(file()).trials;
        } catch (const std::runtime_error&) {
            // The file has been made, but its tables have not.
        }
        return {};
    };
    const auto any_lost = [&] {
        return std::ranges::any_of(trials(), [](const TrialRow& trial) { return has(trial, "gaze_lost"); });
    };
    const auto wait_for = [&](const auto& condition) {
        for (int i = 0; i < 1500 && !condition() && program.runs(); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        return condition();
    };
    ASSERT_TRUE(wait_for([&] { return trials().size() == 1; }));
    tracker.set_away(true);
    ASSERT_TRUE(wait_for(any_lost));
    tracker.set_away(false);
    ASSERT_EQ(program.wait(), 0);

    const SessionRows rows = read_session(file());
    EXPECT_TRUE(rows.finished);
    EXPECT_EQ(tracker.connections(), 2);
    const std::set<std::int64_t> sent = tracker.times_ns();
    for (const GazeSample& sample : all_gaze(file(), rows)) {
        ASSERT_TRUE(sent.contains(sample.device_time.ns));
        ASSERT_EQ(sample.direction.has_value(), sample.sequence % 10 != 9);
    }
    EXPECT_FALSE(rows.trials.front().answer == std::nullopt);
    EXPECT_TRUE(rows.trials.front().invalid.empty()) << "the tracker was there";
    EXPECT_TRUE(has(rows.trials[1], "gaze_lost"));
    EXPECT_TRUE(rows.trials[1].answer.has_value()) << "the answer is kept all the same";
    EXPECT_GT(rows.trials.back().attempt, 0) << "shown again";
    EXPECT_TRUE(rows.trials.back().counts()) << "and well, since the tracker came back";
}

TEST_F(DeviceSession, AGazepointAddressThatIsNoneOrNobodysIsRefused) {
    EXPECT_EQ(Child(command(live_study_toml(""), "gazepoint:127.0.0.1")).wait(), 1);
    EXPECT_EQ(Child(command(live_study_toml(""), "gazepoint:127.0.0.1:1")).wait(), 1);
    EXPECT_TRUE(file().empty()) << "no session was begun";
}

}  // namespace
}  // namespace parafovea
