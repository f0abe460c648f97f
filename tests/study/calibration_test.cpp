// What happens to the gaze between trials: calibration, drift checks between blocks, gaze that is nobody's.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/session_log_reader.h"
#include "study/session_runner.h"
#include "study/trial_validity.h"
#include "tests/study/lab.h"

namespace parafovea {
namespace {

using test::ProgramRun;
using test::start;
using testing::ElementsAre;

Protocol protocol_with(const std::string& more, const std::string& texts = "") {
    std::string text = test::small_protocol_text() + texts;
    text.insert(text.find("[texts.en]"), more);
    return parse_protocol(text, "small.toml");
}

CalibrationRecord measured(const char* kind, double accuracy_deg, bool accepted) {
    CalibrationRecord record;
    record.kind = kind;
    record.method = "test";
    record.accepted = accepted;
    record.mean_accuracy_deg = accuracy_deg;
    record.points.push_back({{0, 0}, DirectionDeg{accuracy_deg, 0}, 60, 60, accuracy_deg, 0.1, 0.2});
    return record;
}

std::vector<std::string> happened(const SessionRows& rows) {
    std::vector<std::string> lines;
    for (const EventRow& event : rows.events)
        if (event.kind != "page") lines.push_back(event.kind + ": " + event.detail);
    return lines;
}

TEST(DriftCheck, is_made_after_each_rest_and_at_each_sessions_start_and_stored_beside_calibrations) {
    TemporaryFolder folder;
    {
        SessionLog log = start(folder / "s.sqlite", protocol_with("[calibration]\ndrift_check_deg = 1\n"));
        ProgramRun run;
        SessionHooks hooks;
        std::vector<std::string> order;
        hooks.on_progress = [&](const SessionProgress& progress) { order.push_back(progress.state); };
        hooks.calibrate = [] { return measured("calibration", 0.5, true); };
        int checks = 0;
        hooks.check_drift = [&] {
            const bool good = ++checks != 2;
            return measured("drift check", good ? 0.25 : 1.5, good);
        };
        EXPECT_EQ(run.go(log, hooks), SessionEnd::finished);
        std::erase(order, "trial");
        EXPECT_THAT(order,
                    ElementsAre("introduction", "calibration", "session 1", "drift check",
                                "rest after trial 6 attempt 0", "session 2", "drift check", "finished"));
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    ASSERT_EQ(rows.calibrations.size(), 3u);
    EXPECT_EQ(rows.calibrations[1].kind, "drift check");
    EXPECT_EQ(rows.calibrations[1].points[0].accuracy_deg, 0.25);
    EXPECT_EQ(rows.calibrations[2].mean_accuracy_deg, 1.5);
    EXPECT_FALSE(rows.calibrations[2].accepted);
    EXPECT_EQ(rows.last_calibration()->mean_accuracy_deg, 0.5);
    EXPECT_THAT(happened(rows), ElementsAre("drift check not good enough: 1.50 degrees"));
}

TEST(Calibration, is_what_the_operator_is_told_while_its_page_is_shown) {
    TemporaryFolder folder;
    SessionLog log = start(folder / "s.sqlite", protocol_with("", "calibration = \"Look at each cross.\"\n"));
    ProgramRun run;
    SessionHooks hooks;
    std::string told;
    hooks.on_progress = [&](const SessionProgress& progress) { told = progress.state; };
    hooks.calibrate = [] { return measured("calibration", 0.5, true); };
    int shown = 0;
    const auto before_show = run.stage.before_show;
    run.stage.before_show = [&](const Picture& picture) {
        if (picture.text == "Look at each cross.") {
            ++shown;
            EXPECT_EQ(told, "calibration");
        }
        before_show(picture);
    };
    EXPECT_EQ(run.go(log, hooks), SessionEnd::finished);
    EXPECT_GT(shown, 0);
}

TEST(DriftCheck, without_a_threshold_there_is_none) {
    TemporaryFolder folder;
    SessionLog log = start(folder / "s.sqlite");
    ProgramRun run;
    SessionHooks hooks;
    hooks.check_drift = []() -> std::optional<CalibrationRecord> {
        ADD_FAILURE();
        return std::nullopt;
    };
    EXPECT_EQ(run.go(log, hooks), SessionEnd::finished);
}

TEST(Recalibration, is_offered_to_the_participant_where_the_gaze_is_off) {
    const auto run_with = [](Button chosen) {
        TemporaryFolder folder;
        int calibrations = 0;
        {
            SessionLog log = start(folder / "s.sqlite",
                                   protocol_with("[calibration]\ndrift_check_deg = 1\n",
                                                 "recalibrate = \"A: calibrate again. B: go on.\"\n"));
            ProgramRun run;
            const auto before_show = run.stage.before_show;
            run.stage.before_show = [&](const Picture& picture) {
                if (picture.text.starts_with("A: calibrate"))
                    run.participant.press(chosen);
                else
                    before_show(picture);
            };
            SessionHooks hooks;
            hooks.calibrate = [&] { return measured("calibration", 0.5, ++calibrations != 1); };
            hooks.check_drift = [] { return measured("drift check", 3, false); };
            EXPECT_EQ(run.go(log, hooks), SessionEnd::finished);
        }
        return std::pair(calibrations, happened(read_session(folder / "s.sqlite")));
    };
    const auto [again, events] = run_with(Button::a);
    EXPECT_EQ(again, 4) << "one that was not good, another; one after each of two drift checks";
    EXPECT_THAT(
        events,
        ElementsAre("calibration not good enough: 0.50 degrees", "recalibration: by the participant",
                    "drift check not good enough: 3.00 degrees", "recalibration: by the participant",
                    "drift check not good enough: 3.00 degrees", "recalibration: by the participant"));
    const auto [once, refused] = run_with(Button::b);
    EXPECT_EQ(once, 1);
    EXPECT_THAT(
        refused,
        ElementsAre("calibration not good enough: 0.50 degrees", "no recalibration: by the participant",
                    "drift check not good enough: 3.00 degrees", "no recalibration: by the participant",
                    "drift check not good enough: 3.00 degrees", "no recalibration: by the participant"));
}

TEST(Recalibration, that_never_succeeds_ends_after_three) {
    TemporaryFolder folder;
    SessionLog log = start(folder / "s.sqlite", protocol_with("", "recalibrate = \"Again?\"\n"));
    ProgramRun run;
    SessionHooks hooks;
    int calibrations = 0;
    hooks.calibrate = [&] {
        ++calibrations;
        return measured("calibration", 9, false);
    };
    EXPECT_EQ(run.go(log, hooks), SessionEnd::finished);
    EXPECT_EQ(calibrations, 3);
}

TEST(GazeBetweenTrials, every_sample_is_stored_once_and_says_where_it_belongs) {
    TemporaryFolder folder;
    std::size_t delivered = 0;
    {
        SessionLog log = start(folder / "s.sqlite");
        ProgramRun run;
        EXPECT_EQ(run.go(log), SessionEnd::finished);
        while (delivered < run.gaze.to_come.size() &&
               run.gaze.to_come[delivered].arrival_time <= run.clock.now())
            ++delivered;
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    std::vector<std::int64_t> sequences;
    std::set<std::string> phases;
    for (const GazeBetween& between : read_gaze_between(folder / "s.sqlite")) {
        sequences.push_back(between.sample.sequence);
        phases.insert(between.phase);
    }
    EXPECT_THAT(phases, testing::IsSupersetOf({"introduction", "session 1", "rest after trial 6 attempt 0"}));
    for (const TrialRow& trial : rows.trials) {
        const std::vector<GazeSample> own = read_gaze(folder / "s.sqlite", trial.planned.number);
        ASSERT_FALSE(own.empty());
        // What had arrived before the trial began is not of the trial.
        EXPECT_GT(own.front().arrival_time, trial.started - Duration::from_ms(1));
        for (const GazeSample& sample : own) sequences.push_back(sample.sequence);
    }
    std::ranges::sort(sequences);
    EXPECT_EQ(std::ranges::adjacent_find(sequences), sequences.end()) << "a sample was stored twice";
    // Those of the last page are nobody's, since the session is over.
    ASSERT_FALSE(sequences.empty());
    EXPECT_EQ(sequences.back() - sequences.front() + 1, static_cast<std::int64_t>(sequences.size()));
    EXPECT_LE(sequences.size(), delivered);
    EXPECT_GT(sequences.size() + 20, delivered);
}

TEST(SessionProgress, tells_how_often_a_trial_was_shown_before) {
    TemporaryFolder folder;
    Protocol protocol = test::small_protocol();
    protocol.timing.response_window_s = 0.2;
    SessionLog log = start(folder / "s.sqlite", protocol);
    ProgramRun run;
    SessionHooks hooks;
    std::vector<std::pair<int, int>> again;
    hooks.on_progress = [&](const SessionProgress& progress) {
        if (!progress.next) return;
        run.participant.answers = progress.next->number != 2;
        if (progress.attempt > 0) again.emplace_back(progress.next->number, progress.attempt);
    };
    run.go(log, hooks);
    EXPECT_THAT(again, ElementsAre(std::pair(2, 1)));
}

// A trial of two intervals of one second, a second apart, with gaze at 100 Hz.
TrialRecord trial_with_gaze_from_to(std::vector<std::pair<double, double>> spans_s) {
    TrialRecord record;
    for (const Phase phase : {Phase::first_interval, Phase::second_interval}) {
        IntervalRecord& interval = record.intervals[static_cast<std::size_t>(phase)];
        const double begin_s = phase == Phase::first_interval ? 1 : 3;
        interval.presented_frames = 100;
        interval.first_display = {Duration::from_seconds(begin_s).ns};
        interval.end = {Duration::from_seconds(begin_s + 1).ns};
    }
    for (const auto& [from_s, to_s] : spans_s)
        for (double t = from_s; t < to_s; t += 0.01) {
            GazeSample sample;
            sample.host_time = {Duration::from_seconds(t).ns};
            sample.direction = DirectionDeg{0, 0};
            sample.status = GazeStatus::tracked;
            record.gaze.push_back(sample);
        }
    return record;
}

TEST(GazeLost, a_silent_tracker_counts_as_the_samples_it_did_not_deliver) {
    const auto lost_beyond = [](const TrialRecord& record, double share) {
        Protocol protocol = test::small_protocol();
        protocol.validity.gaze_lost_share = share;
        protocol.validity.unanswered = false;
        return !broken_rules(record, protocol).empty();
    };
    EXPECT_FALSE(lost_beyond(trial_with_gaze_from_to({{0, 5}}), 0));
    // From the middle of the second interval on: a quarter of both.
    const TrialRecord quarter = trial_with_gaze_from_to({{0, 3.5}});
    EXPECT_TRUE(lost_beyond(quarter, 0.23));
    EXPECT_FALSE(lost_beyond(quarter, 0.27));
    // A whole interval, and the gap between them, in which nothing need be seen.
    EXPECT_TRUE(lost_beyond(trial_with_gaze_from_to({{0, 3}}), 0.48));
    EXPECT_FALSE(lost_beyond(trial_with_gaze_from_to({{0, 2}, {3, 5}}), 0.01));
    // In the middle of an interval.
    EXPECT_TRUE(lost_beyond(trial_with_gaze_from_to({{0, 1.2}, {1.6, 5}}), 0.18));
    EXPECT_FALSE(lost_beyond(trial_with_gaze_from_to({{0, 1.2}, {1.6, 5}}), 0.22));
    // A few samples late are a tracker's jitter.
    EXPECT_FALSE(lost_beyond(trial_with_gaze_from_to({{0, 1.2}, {1.23, 5}}), 0));
    EXPECT_TRUE(lost_beyond(trial_with_gaze_from_to({}), 0.9));
}

TEST(CalibrationRules, are_read_from_the_protocol_and_wrong_ones_are_mistakes) {
    const CalibrationRules rules =
        protocol_with("[calibration]\ntargets = 13\neach_s = 2\ndrift_check_deg = 1.5\n").calibration;
    EXPECT_EQ(rules.targets, 13);
    EXPECT_EQ(rules.each_s, 2);
    EXPECT_EQ(rules.drift_check_deg, 1.5);
    EXPECT_FALSE(test::small_protocol().calibration.drift_check_deg);
    try {
        protocol_with("[calibration]\ntargets = 7\neach_s = 0.2\n");
        FAIL();
    } catch (const ProtocolError& error) {
        EXPECT_EQ(error.mistakes().size(), 2u);
    }
}

}  // namespace
}  // namespace parafovea
