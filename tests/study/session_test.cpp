// Whole sessions: order, rests, log, resumption.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <csignal>
#include <thread>

#include "devices/random.h"
#include "study/database.h"
#include "study/session_log.h"
#include "study/session_log_reader.h"
#include "study/session_runner.h"
#include "study/session_survey.h"
#include "tests/study/lab.h"

namespace parafovea {
namespace {

using test::facts;
using test::ProgramRun;
using test::resume;
using test::start;
using testing::HasSubstr;

std::vector<std::string> what_happened(const SessionRows& rows) {
    std::vector<std::string> lines;
    for (const TrialRow& trial : rows.trials) {
        if (trial.interrupted) continue;
        std::string line = std::to_string(trial.planned.number) + (trial.superseded ? " superseded" : "");
        line += trial.answer ? (trial.answer->identical ? " same" : " different") : " none";
        for (const std::string& rule : trial.invalid) line += " " + rule;
        for (const IntervalRecord& interval : trial.intervals)
            line += " " + std::to_string(interval.presented_frames);
        lines.push_back(line);
    }
    return lines;
}

std::vector<std::string> pages(const SessionRows& rows) {
    std::vector<std::string> names;
    for (const EventRow& event : rows.events)
        if (event.kind == "page") names.push_back(event.detail);
    return names;
}

TEST(Session, runs_the_whole_plan_in_order_and_logs_every_answer) {
    TemporaryFolder folder;
    {
        SessionLog log = start(folder / "s.sqlite");
        ProgramRun run;
        std::vector<int> told;
        SessionHooks hooks;
        hooks.on_progress = [&](const SessionProgress& progress) {
            if (progress.next) told.push_back(progress.done);
            EXPECT_EQ(progress.total, 13);
        };
        EXPECT_EQ(run.go(log, hooks), SessionEnd::finished);
        EXPECT_THAT(told, testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    const Protocol protocol = test::small_protocol();
    EXPECT_TRUE(rows.finished);
    EXPECT_EQ(rows.plan, make_plan(protocol, 2, 42));
    EXPECT_EQ(rows.protocol_text, protocol.source);
    EXPECT_EQ(rows.protocol_hash, protocol_hash(protocol));
    EXPECT_EQ(rows.facts.other, facts().other);
    EXPECT_EQ(rows.facts.participant, "p07");
    ASSERT_EQ(rows.trials.size(), 13u);
    for (std::size_t i = 0; i < 13; ++i) {
        EXPECT_EQ(rows.trials[i].planned, rows.plan.trials[i]);
        ASSERT_TRUE(rows.trials[i].answer);
        EXPECT_EQ(rows.trials[i].answer->identical, rows.trials[i].planned.kind == TrialKind::validation);
        EXPECT_TRUE(rows.trials[i].counts());
        EXPECT_EQ(rows.trials[i].intervals.size(), 5u);
    }
    EXPECT_THAT(pages(rows), testing::ElementsAre("introduction", "session 1",
                                                  testing::StartsWith("rest after trial 6"), "session 2"));
}

TEST(Session, the_log_gives_back_every_field_of_a_trial) {
    TemporaryFolder folder;
    TrialRecord kept;
    Protocol protocol = test::small_protocol();
    protocol.foveation_gaze = GazePolicy::tracked;
    {
        SessionLog log = start(folder / "s.sqlite", protocol);
        ProgramRun run;
        run.gaze.to_come.clear();
        run.gaze.look(0, 0.2, DirectionDeg{1.25, -3.5});
        run.gaze.look(0.2, 0.3, std::nullopt);
        run.gaze.look(0.3, 9, DirectionDeg{0.1, 0.2});
        run.gaze.to_come[3].right = EyeSample{std::nullopt, std::nullopt};
        run.gaze.to_come[4].status = GazeStatus::low_accuracy;
        SessionHooks hooks;
        std::stop_source stop;
        hooks.stop = stop.get_token();
        hooks.on_trial = [&](const TrialRecord& record) {
            kept = record;
            stop.request_stop();
        };
        EXPECT_EQ(run.go(log, hooks), SessionEnd::stopped);
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    ASSERT_EQ(rows.trials.size(), 1u);
    EXPECT_FALSE(rows.finished);
    const TrialRow& trial = rows.trials[0];
    EXPECT_EQ(trial.started, kept.started);
    EXPECT_EQ(trial.answer->time, kept.answer->time);
    EXPECT_EQ(trial.answer->reaction, kept.answer->reaction);
    EXPECT_EQ(trial.answer->button, kept.answer->button);
    for (std::size_t i = 0; i < 5; ++i) {
        const IntervalRecord &a = trial.intervals[i], &b = kept.intervals[i];
        EXPECT_EQ(std::tie(a.phase, a.intended_frames, a.presented_frames, a.first_display, a.last_display,
                           a.end, a.time_source, a.missed_vsyncs, a.longest_frame),
                  std::tie(b.phase, b.intended_frames, b.presented_frames, b.first_display, b.last_display,
                           b.end, b.time_source, b.missed_vsyncs, b.longest_frame));
    }
    const std::vector<FrameRecord> frames = read_frames(folder / "s.sqlite", 0);
    ASSERT_EQ(frames.size(), kept.frames.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const FrameRecord &a = frames[i], &b = kept.frames[i];
        EXPECT_EQ(std::tie(a.phase, a.fovea, a.fallback, a.gaze_sequence, a.gaze_age, a.shown.index,
                           a.shown.display_time, a.shown.time_source, a.shown.missed_vsyncs, a.shown.gpu_time,
                           a.shown.image_hash),
                  std::tie(b.phase, b.fovea, b.fallback, b.gaze_sequence, b.gaze_age, b.shown.index,
                           b.shown.display_time, b.shown.time_source, b.shown.missed_vsyncs, b.shown.gpu_time,
                           b.shown.image_hash));
    }
    const std::vector<GazeSample> gaze = read_gaze(folder / "s.sqlite", 0);
    ASSERT_EQ(gaze.size(), kept.gaze.size());
    ASSERT_GT(gaze.size(), 40u);
    for (std::size_t i = 0; i < gaze.size(); ++i) {
        const GazeSample &a = gaze[i], &b = kept.gaze[i];
        EXPECT_EQ(std::tie(a.sequence, a.device_time, a.host_time, a.host_time_error, a.arrival_time,
                           a.status, a.direction),
                  std::tie(b.sequence, b.device_time, b.host_time, b.host_time_error, b.arrival_time,
                           b.status, b.direction));
        ASSERT_EQ(a.left.has_value(), b.left.has_value());
        ASSERT_EQ(a.right.has_value(), b.right.has_value());
        if (a.left) {
            EXPECT_EQ(std::tie(a.left->direction, a.left->pupil_mm),
                      std::tie(b.left->direction, b.left->pupil_mm));
        }
    }
    const std::vector<ControllerEvent> events = read_controller_events(folder / "s.sqlite", 0);
    ASSERT_EQ(events.size(), kept.events.size());
    for (std::size_t i = 0; i < events.size(); ++i)
        EXPECT_EQ(std::tie(events[i].kind, events[i].button, events[i].time, events[i].time_error),
                  std::tie(kept.events[i].kind, kept.events[i].button, kept.events[i].time,
                           kept.events[i].time_error));
}

TEST(Session, the_participant_rests_after_every_failed_validation_trial) {
    TemporaryFolder folder;
    {
        SessionLog log = start(folder / "s.sqlite");
        ProgramRun run;
        run.participant.answers_same = [](const auto&) { return false; };
        run.go(log);
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    std::vector<std::string> expected;
    for (const PlannedTrial& trial : rows.plan.trials) {
        const bool last_of_session_1 = trial.number == 6;
        if ((trial.kind == TrialKind::validation || last_of_session_1) && trial.number != 12)
            expected.push_back("rest after trial " + std::to_string(trial.number) + " attempt 0");
    }
    std::vector<std::string> rests;
    for (const std::string& page : pages(rows))
        if (page.starts_with("rest")) rests.push_back(page);
    EXPECT_EQ(rests, expected);
    EXPECT_GE(rests.size(), 4u);
}

TEST(Session, a_rest_lasts_at_least_as_long_as_the_protocol_says) {
    TemporaryFolder folder;
    Protocol protocol = test::small_protocol();
    protocol.rests.at_least_s = 3;
    std::map<std::string, double> at_s;
    {
        SessionLog log = start(folder / "s.sqlite", protocol);
        ProgramRun run;
        // Presses proceed on every other frame of a rest.
        const auto before_show = run.stage.before_show;
        run.stage.before_show = [&, n = 0](const Picture& picture) mutable {
            before_show(picture);
            if (picture.kind == PictureKind::text && picture.text == "Rest" && n++ % 2 == 0)
                run.participant.press(Button::a);
        };
        SessionHooks hooks;
        hooks.on_progress = [&](const SessionProgress& progress) {
            at_s[progress.state] = HostTime(run.clock.now()).ns * 1e-9;
        };
        run.go(log, hooks);
    }
    for (const auto& [state, time] : at_s)
        if (state.starts_with("rest")) {
            EXPECT_NEAR(at_s["session 2"] - time, 3, 0.05);
        }
}

TEST(Session, pages_fill_in_their_numbers) {
    TemporaryFolder folder;
    SessionLog log = start(folder / "s.sqlite");
    ProgramRun run;
    std::set<std::string> texts;
    const auto before_show = run.stage.before_show;
    run.stage.before_show = [&](const Picture& picture) {
        before_show(picture);
        if (picture.kind == PictureKind::text) texts.insert(picture.text);
    };
    run.go(log);
    EXPECT_THAT(texts, testing::ElementsAre("Hello", "Rest", "Session 1 of 2", "Session 2 of 2"));
}

TEST(Session, an_invalid_trial_is_kept_and_shown_again_at_the_end_of_its_session) {
    TemporaryFolder folder;
    Protocol protocol = test::small_protocol();
    protocol.timing.response_window_s = 0.2;
    {
        SessionLog log = start(folder / "s.sqlite", protocol);
        ProgramRun run;
        SessionHooks hooks;
        int trials = 0;
        // Trials 2 and 4 stay unanswered the first time, 4 the second time too.
        hooks.on_progress = [&](const SessionProgress& progress) {
            if (!progress.next) return;
            ++trials;
            const int number = progress.next->number;
            run.participant.answers = !(number == 2 && trials == 3) && number != 4;
        };
        run.go(log, hooks);
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    std::vector<int> numbers;
    for (const TrialRow& trial : rows.trials) numbers.push_back(trial.planned.number);
    EXPECT_THAT(numbers, testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 2, 4, 7, 8, 9, 10, 11, 12));
    EXPECT_THAT(rows.trials[2].invalid, testing::ElementsAre("unanswered"));
    EXPECT_TRUE(rows.trials[7].counts());
    EXPECT_EQ(rows.trials[7].attempt, 1);
    EXPECT_FALSE(rows.trials[8].counts());
    EXPECT_TRUE(rows.finished);
}

TEST(NextTrial, settles_every_trial_whatever_happens) {
    const TrialPlan plan = make_plan(test::small_protocol(), 0, 1);
    ValidityRules rules;
    rules.repeats = 2;
    Random random(5);
    for (int run = 0; run < 200; ++run) {
        std::vector<ShownTrial> shown;
        std::map<int, int> showings;
        while (const auto next = next_trial(plan, shown, rules)) {
            ASSERT_LT(shown.size(), 300u);
            ShownTrial trial;
            trial.number = next->planned->number;
            trial.attempt = next->attempt;
            trial.interrupted = random.chance(0.2);
            trial.valid = random.chance(0.6);
            trial.superseded = random.chance(0.05);
            showings[trial.number] += !trial.interrupted && !trial.superseded;
            // Each session is settled before the next one begins.
            if (!shown.empty()) {
                EXPECT_GE(next->planned->session,
                          plan.trials[static_cast<std::size_t>(shown.back().number)].session);
            }
            shown.push_back(trial);
        }
        EXPECT_EQ(showings.size(), plan.trials.size());
        for (const auto& [number, count] : showings) EXPECT_TRUE(count >= 1 && count <= 3) << count;
    }
}

TEST(SessionLog, a_file_is_readable_by_its_owner_alone) {
    TemporaryFolder folder;
    SessionLog log = start(folder / "s.sqlite");
    for (const char* name : {"s.sqlite", "s.sqlite-wal"}) {
        struct stat status = {};
        ASSERT_EQ(::stat((folder / name).c_str(), &status), 0) << name;
        EXPECT_EQ(status.st_mode & 0777, 0600u) << name;
    }
}

TEST(SessionLog, a_second_process_is_refused_and_a_reader_is_not) {
    TemporaryFolder folder;
    SessionLog log = start(folder / "s.sqlite");
    try {
        resume(folder / "s.sqlite");
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("in use by another process"));
    }
    EXPECT_EQ(read_session(folder / "s.sqlite").plan.trials.size(), 13u);
}

TEST(SessionLog, refuses_to_overwrite_and_unwritable_folders_and_other_files) {
    TemporaryFolder folder;
    { start(folder / "s.sqlite"); }
    EXPECT_THROW(start(folder / "s.sqlite"), std::runtime_error);
    EXPECT_THROW(start(folder / "none" / "s.sqlite"), std::runtime_error);
    EXPECT_THROW(resume(folder / "missing.sqlite"), std::runtime_error);
    EXPECT_THROW(read_session(folder / "missing.sqlite"), std::runtime_error);
    std::FILE* file = std::fopen((folder / "text.sqlite").c_str(), "w");
    std::fputs("certainly not a database, but long enough to look like a header of one", file);
    std::fclose(file);
    EXPECT_THROW(read_session(folder / "text.sqlite"), std::runtime_error);
    EXPECT_THROW(resume(folder / "text.sqlite"), std::runtime_error);
}

TEST(SessionSurvey, a_file_that_is_cut_off_while_it_is_read_is_refused) {
    TemporaryFolder folder;
    const auto path = folder / "s.sqlite";
    {
        SessionLog log = start(path);
        ProgramRun().go(log);
    }
    SessionSurvey survey(path);
    ASSERT_FALSE(survey.frame_times(0).empty());
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 4);
    const auto read_on = [&] {
        for (int shown = 1; shown < 13; ++shown) survey.frame_times(shown);
    };
    EXPECT_THAT(read_on,
                testing::ThrowsMessage<std::runtime_error>(testing::HasSubstr("s.sqlite: expected to read")));
}

TEST(Session, resumes_at_the_first_unanswered_trial_and_ends_like_an_uninterrupted_one) {
    TemporaryFolder folder;
    {
        SessionLog log = start(folder / "whole.sqlite");
        ProgramRun().go(log);
    }
    const SessionRows whole = read_session(folder / "whole.sqlite");
    for (int stop_after = 1; stop_after < 13; ++stop_after) {
        const auto path = folder / ("cut" + std::to_string(stop_after) + ".sqlite");
        {
            SessionLog log = start(path);
            ProgramRun run;
            std::stop_source stop;
            SessionHooks hooks;
            hooks.stop = stop.get_token();
            hooks.on_trial = [&, n = 0](const TrialRecord&) mutable {
                if (++n == stop_after) stop.request_stop();
            };
            EXPECT_EQ(run.go(log, hooks), SessionEnd::stopped);
        }
        SessionLog log = resume(path);
        EXPECT_EQ(ProgramRun().go(log), SessionEnd::finished);
        const SessionRows rows = read_session(path);
        EXPECT_EQ(what_happened(rows), what_happened(whole)) << stop_after;
        EXPECT_EQ(pages(rows), pages(whole)) << stop_after;
        EXPECT_EQ(rows.anchors.size(), 2u);
    }
}

TEST(Session, a_session_left_for_long_restarts_its_block_and_one_left_for_longer_is_refused) {
    TemporaryFolder folder;
    const auto stop_in_session_1 = [&](const std::filesystem::path& path) {
        SessionLog log = start(path);
        ProgramRun run;
        std::stop_source stop;
        SessionHooks hooks;
        hooks.stop = stop.get_token();
        hooks.on_trial = [&, n = 0](const TrialRecord&) mutable {
            if (++n == 4) stop.request_stop();
        };
        run.go(log, hooks);
    };
    stop_in_session_1(folder / "a.sqlite");
    {
        SessionLog log = resume(folder / "a.sqlite", 3);
        EXPECT_NEAR(log.age_h(), 3, 0.01);
        EXPECT_EQ(ProgramRun().go(log), SessionEnd::finished);
    }
    const SessionRows rows = read_session(folder / "a.sqlite");
    std::vector<int> numbers;
    for (const TrialRow& trial : rows.trials) numbers.push_back(trial.planned.number);
    EXPECT_THAT(numbers, testing::ElementsAre(0, 1, 2, 3, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12));
    EXPECT_FALSE(rows.trials[0].superseded);
    for (int i = 1; i <= 3; ++i) EXPECT_TRUE(rows.trials[static_cast<std::size_t>(i)].superseded);
    EXPECT_TRUE(rows.trials[4].counts());

    stop_in_session_1(folder / "b.sqlite");
    SessionLog log = resume(folder / "b.sqlite", 30);
    EXPECT_THROW(ProgramRun().go(log), std::runtime_error);
    EXPECT_EQ(read_session(folder / "b.sqlite").trials.size(), 4u);
}

TEST(Session, the_operators_requests_are_served_and_logged) {
    TemporaryFolder folder;
    {
        SessionLog log = start(folder / "s.sqlite");
        ProgramRun run;
        SessionHooks hooks;
        int calls = 0, calibrations = 0;
        hooks.operator_request = [&] {
            switch (++calls) {
                case 4:
                    return OperatorRequest::pause;
                case 50:
                    return OperatorRequest::proceed;
                case 60:
                    return OperatorRequest::repeat_last;
                case 62:
                    return OperatorRequest::recalibrate;
                default:
                    return OperatorRequest::none;
            }
        };
        hooks.calibrate = [&]() -> std::optional<CalibrationRecord> {
            ++calibrations;
            CalibrationRecord record;
            record.method = "test";
            record.accepted = true;
            record.mean_accuracy_deg = 0.75;
            record.points.push_back({{5, -5}, DirectionDeg{5.5, -5}, 60, 58, 0.5, 0.1, 0.2});
            record.points.push_back({{0, 0}, std::nullopt, 60, 0, std::nullopt, std::nullopt, std::nullopt});
            return record;
        };
        EXPECT_EQ(run.go(log, hooks), SessionEnd::finished);
        EXPECT_EQ(calibrations, 2);
        log.append_note(run.clock.now(), "it's fine");
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    std::vector<std::string> kinds;
    for (const EventRow& event : rows.events)
        if (event.kind != "page") kinds.push_back(event.kind);
    EXPECT_THAT(kinds, testing::ElementsAre("paused", "pause ended", "repeat", "recalibration"));
    ASSERT_EQ(rows.calibrations.size(), 2u);
    EXPECT_EQ(rows.calibrations[0].points[0].measured, (DirectionDeg{5.5, -5}));
    EXPECT_FALSE(rows.calibrations[0].points[1].measured);
    EXPECT_EQ(rows.calibrations[0].mean_accuracy_deg, 0.75);
    ASSERT_EQ(rows.notes.size(), 1u);
    EXPECT_EQ(rows.notes[0].detail, "it's fine");
    EXPECT_EQ(rows.trials.size(), 14u);
}

// Runs a session in a process of its own, which tells through a pipe each answer that the log has
// acknowledged.
pid_t run_in_child(const std::filesystem::path& path, bool again, int pipe_end) {
    const pid_t child = ::fork();
    if (child != 0) return child;
    try {
        SessionLog log = again ? resume(path) : start(path);
        ProgramRun run;
        SessionHooks hooks;
        int written = 0;
        hooks.on_progress = [&](const SessionProgress&) {
            log.wait_until_durable();
            for (; written < static_cast<int>(log.shown().size()); ++written) {
                const char byte = 1;
                if (::write(pipe_end, &byte, 1) != 1) ::_exit(4);
            }
        };
        written = static_cast<int>(log.shown().size());
        run.go(log, hooks);
        ::_exit(0);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        ::_exit(3);
    }
}

TEST(KillNine,
     at_any_moment_loses_no_acknowledged_answer_and_the_session_goes_on_as_if_nothing_had_happened) {
    TemporaryFolder folder;
    // How long a session takes on this machine, so that kills fall on all that lies between answers.
    const auto began = std::chrono::steady_clock::now();
    {
        SessionLog log = start(folder / "whole.sqlite");
        ProgramRun().go(log);
    }
    const auto session_time = std::chrono::steady_clock::now() - began;
    const SessionRows whole = read_session(folder / "whole.sqlite");
    const std::size_t trials = whole.trials.size();
    Random random(2026);
    int killed = 0;
    constexpr int kKills = 200;
    for (int round = 0; killed < kKills; ++round) {
        ASSERT_LT(round, 10 * kKills) << "sessions end before they are killed";
        const auto path = folder / ("k" + std::to_string(round) + ".sqlite");
        int acknowledged = 0;
        bool exists = false;
        std::size_t logged = 0;
        for (int tries = 0; tries < 200; ++tries) {
            int ends[2];
            ASSERT_EQ(::pipe(ends), 0);
            const pid_t child = run_in_child(path, exists, ends[1]);
            ::close(ends[1]);
            char byte = 0;
            for (std::uint64_t wanted = random.below(trials - logged + 1); wanted > 0; --wanted)
                acknowledged += ::read(ends[0], &byte, 1) == 1;
            std::this_thread::sleep_for(random.uniform(0, 0.4) * session_time);
            ::kill(child, SIGKILL);
            int status = 0;
            ::waitpid(child, &status, 0);
            while (::read(ends[0], &byte, 1) == 1) ++acknowledged;
            ::close(ends[0]);
            killed += WIFSIGNALED(status);
            if (!WIFSIGNALED(status)) {
                ASSERT_EQ(WEXITSTATUS(status), 0);
                break;
            }
            // A kill before the file is complete leaves nothing to go on with.
            exists = false;
            if (std::filesystem::exists(path)) {
                Database database(path, Database::Mode::write);
                Statement integrity = database.prepare("PRAGMA integrity_check");
                ASSERT_TRUE(integrity.step());
                ASSERT_EQ(integrity.text(0), "ok");
                exists = database.user_version() != 0;
            }
            if (!exists) {
                ASSERT_EQ(acknowledged, 0);
                for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(path.string() + end);
                continue;
            }
            logged = read_session(path).trials.size();
            EXPECT_GE(static_cast<int>(logged), acknowledged);
        }
        const SessionRows rows = read_session(path);
        EXPECT_TRUE(rows.finished);
        EXPECT_EQ(what_happened(rows), what_happened(whole));
        EXPECT_EQ(pages(rows), pages(whole));
    }
    RecordProperty("kills", killed);
    EXPECT_GE(killed, kKills);
}

}  // namespace
}  // namespace parafovea
