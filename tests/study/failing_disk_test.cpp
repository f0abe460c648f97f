// A disk that fails at any write: the session stops with a clear message, and nothing that was confirmed is
// lost.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "study/database.h"
#include "study/session_log_reader.h"
#include "tests/study/failing_vfs.h"
#include "tests/study/lab.h"

namespace parafovea {
namespace {

using test::FailingVfs;
using test::ProgramRun;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

// Short, so that every single write can be tried.
Protocol short_protocol() {
    std::string text = test::small_protocol_text();
    const auto replace = [&](const std::string& from, const std::string& to) {
        text.replace(text.find(from), from.size(), to);
    };
    replace("lead_in_s = 0.05", "lead_in_s = 0");
    replace("interval_s = 0.2", "interval_s = 0.01");
    replace("gap_s = 0.1", "gap_s = 0");
    replace("sessions = 2", "sessions = 1");
    return parse_protocol(text, "short.toml");
}

struct Outcome {
    bool created = false;
    bool finished = false;
    std::string message;
    std::vector<std::pair<int, bool>>
        confirmed;  // trials whose answers the log said were on the disk, and the answers
};

Outcome run_on(const std::filesystem::path& path, const char* vfs) {
    Outcome outcome;
    try {
        SessionLog log = test::start(path, short_protocol(), vfs);
        outcome.created = true;
        ProgramRun run;
        run.gaze.to_come.clear();
        run.gaze.look(0, 1, DirectionDeg{});
        SessionHooks hooks;
        std::vector<std::pair<int, bool>> answers;
        hooks.on_trial = [&](const TrialRecord& record) {
            answers.emplace_back(record.planned.number, record.answer->identical);
        };
        hooks.on_progress = [&](const SessionProgress&) {
            log.wait_until_durable();
            outcome.confirmed = answers;
        };
        run.go(log, hooks);
        outcome.confirmed = answers;
        outcome.finished = true;
    } catch (const std::exception& error) {
        outcome.message = error.what();
    }
    return outcome;
}

class FailingDisk : public testing::TestWithParam<std::pair<int, bool>> {};

TEST_P(FailingDisk,
       at_every_single_write_stops_the_session_with_a_clear_message_and_loses_no_confirmed_answer) {
    const auto [code, once] = GetParam();
    FailingVfs disk;
    TemporaryFolder folder;
    disk.fail_at(0, 0);
    ASSERT_TRUE(run_on(folder / "whole.sqlite", FailingVfs::kName).finished);
    const long writes = disk.writes();
    ASSERT_GT(writes, 50);
    int stopped = 0;
    for (long n = 1; n <= writes; ++n) {
        const auto path = folder / ("s" + std::to_string(n) + ".sqlite");
        disk.fail_at(n, code, once);
        const Outcome outcome = run_on(path, FailingVfs::kName);
        const bool failed = disk.failed();
        disk.fail_at(0, 0);
        ASSERT_TRUE(failed || outcome.finished);
        if (!outcome.finished) {
            ++stopped;
            EXPECT_THAT(outcome.message,
                        AllOf(HasSubstr(path.string()), HasSubstr("expected to"),
                              AnyOf(HasSubstr("check the disk"), HasSubstr("free some space"))))
                << n;
        }
        if (!outcome.created) {
            EXPECT_FALSE(std::filesystem::exists(path)) << "write " << n << ": half a file was left behind";
            continue;
        }
        const SessionRows rows = read_session(path);
        std::vector<std::pair<int, bool>> stored;
        for (const TrialRow& trial : rows.trials)
            stored.emplace_back(trial.planned.number, trial.answer->identical);
        ASSERT_GE(stored.size(), outcome.confirmed.size()) << n;
        stored.resize(outcome.confirmed.size());
        EXPECT_EQ(stored, outcome.confirmed) << n;
        Database database(path, Database::Mode::read);
        Statement integrity = database.prepare("PRAGMA integrity_check");
        ASSERT_TRUE(integrity.step());
        EXPECT_EQ(integrity.text(0), "ok") << n;
        // With the disk repaired the session goes on.
        if (n % 7 == 0 && !outcome.finished) {
            SessionLog log = test::resume(path);
            EXPECT_EQ(ProgramRun().go(log), SessionEnd::finished);
        }
    }
    EXPECT_GT(stopped, writes / 2);
}

INSTANTIATE_TEST_SUITE_P(Of, FailingDisk,
                         testing::Values(std::pair(SQLITE_IOERR_WRITE, false), std::pair(SQLITE_FULL, false),
                                         std::pair(SQLITE_IOERR_WRITE, true)));

}  // namespace
}  // namespace parafovea
