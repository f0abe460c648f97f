// `parafovea run` from outside: killed at any moment, it goes on and ends like a session that was not.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "app/session_file.h"
#include "devices/random.h"
#include "study/database.h"
#include "study/session_log_reader.h"
#include "tests/app/child_process.h"
#include "tests/app/short_study.h"

namespace parafovea {
namespace {

namespace fs = std::filesystem;
using Seconds = std::chrono::duration<double>;

class RunSession : public testing::Test {
  protected:
    void SetUp() override { folder_.write("short.toml", short_study_toml()); }

    std::vector<std::string> command(const std::string& data,
                                     const std::vector<std::string>& more = {}) const {
        std::vector<std::string> words = headless_run(folder_, data);
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    fs::path file(const std::string& data) const { return short_session(folder_, data); }

    TemporaryFolder folder_;
};

std::string integrity(const fs::path& path) {
    Database database(path, Database::Mode::read);
    Statement check = database.prepare("PRAGMA integrity_check");
    check.step();
    return check.text(0);
}

void expect_same_but_for_times(const fs::path& path_a, const fs::path& path_b) {
    const SessionRows a = read_session(path_a), b = read_session(path_b);
    EXPECT_EQ(a.plan, b.plan);
    EXPECT_EQ(a.finished, b.finished);
    ASSERT_EQ(a.trials.size(), b.trials.size());
    for (std::size_t i = 0; i < a.trials.size(); ++i) {
        SCOPED_TRACE("trial " + std::to_string(i));
        const TrialRow &x = a.trials[i], &y = b.trials[i];
        EXPECT_EQ(x.planned, y.planned);
        EXPECT_EQ(x.attempt, y.attempt);
        EXPECT_EQ(x.invalid, y.invalid);
        ASSERT_EQ(x.answer.has_value(), y.answer.has_value());
        if (x.answer) {
            EXPECT_EQ(x.answer->identical, y.answer->identical);
            // The hand is polled by the millisecond from the trial's start, which need not be the same one.
            EXPECT_NEAR(x.answer->reaction.ms(), y.answer->reaction.ms(), 5);
        }
        const std::vector<FrameRecord> frames_a = read_frames(path_a, x.planned.number, x.attempt);
        const std::vector<FrameRecord> frames_b = read_frames(path_b, x.planned.number, x.attempt);
        std::vector<std::uint64_t> hashes_a, hashes_b;
        for (const FrameRecord& frame : frames_a)
            if (frame.shown.image_hash) hashes_a.push_back(*frame.shown.image_hash);
        for (const FrameRecord& frame : frames_b)
            if (frame.shown.image_hash) hashes_b.push_back(*frame.shown.image_hash);
        EXPECT_EQ(hashes_a, hashes_b);
        EXPECT_EQ(hashes_a.size(), 2u);

        const std::vector<GazeSample> gaze_a = read_gaze(path_a, x.planned.number, x.attempt);
        const std::vector<GazeSample> gaze_b = read_gaze(path_b, x.planned.number, x.attempt);
        ASSERT_FALSE(gaze_a.empty());
        for (std::size_t k = 0; k < std::min(gaze_a.size(), gaze_b.size()); ++k) {
            ASSERT_EQ(gaze_a[k].status, gaze_b[k].status);
            ASSERT_EQ(gaze_a[k].direction.has_value(), gaze_b[k].direction.has_value());
            if (!gaze_a[k].direction) continue;
            ASSERT_NEAR(gaze_a[k].direction->azimuth_deg, gaze_b[k].direction->azimuth_deg, 1e-4);
            ASSERT_NEAR(gaze_a[k].direction->elevation_deg, gaze_b[k].direction->elevation_deg, 1e-4);
        }
    }
}

TEST_F(RunSession, KilledAtRandomMomentsKeepsEveryAnswerAndEndsLikeAnUninterruptedSession) {
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(Child(command("whole")).wait(), 0);
    const Seconds whole = std::chrono::steady_clock::now() - start;

    Random random(7);
    std::size_t answers = 0;
    int kills = 0;
    for (bool finished = false; !finished;) {
        const bool begun = !file("broken").empty();
        Child child(
            command("broken", begun ? std::vector<std::string>{"--resume"} : std::vector<std::string>{}));
        if (kills < 10) {
            ++kills;
            std::this_thread::sleep_for(random.uniform() * whole);
            child.kill_and_wait();
        } else {
            ASSERT_EQ(child.wait(), 0);
        }
        if (file("broken").empty()) continue;
        ASSERT_EQ(integrity(file("broken")), "ok");
        const SessionRows rows = read_session(file("broken"));
        EXPECT_GE(rows.trials.size(), answers) << "an answer was lost";
        answers = rows.trials.size();
        finished = rows.finished;
    }
    expect_same_but_for_times(file("whole"), file("broken"));
}

TEST_F(RunSession, InterruptedByCtrlCItStopsBetweenFramesAndCanBeResumed) {
    Child child(command("data"));
    while (file("data").empty() && child.runs()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    child.interrupt();
    const int code = child.wait();
    const SessionRows rows = read_session(file("data"));
    // On a very fast machine the session may have ended before the interrupt came.
    if (!rows.finished) {
        EXPECT_EQ(code, 1);
        ASSERT_FALSE(rows.events.empty());
        EXPECT_EQ(rows.events.back().kind, "stopped");
        EXPECT_EQ(Child(command("data", {"--resume"})).wait(), 0);
    }
    EXPECT_TRUE(read_session(file("data")).finished);
}

TEST_F(RunSession, NothingToResumeAndAFinishedSessionAreRefused) {
    EXPECT_EQ(Child(command("data", {"--resume"})).wait(), 1);
    ASSERT_EQ(Child(command("data")).wait(), 0);
    EXPECT_EQ(Child(command("data", {"--resume"})).wait(), 1);
}

TEST_F(RunSession, AChangedProtocolIsNotResumed) {
    ASSERT_EQ(Child(command("data")).wait(), 0);
    std::ofstream(folder_ / "short.toml", std::ios::app) << "# another comment\n";
    EXPECT_EQ(Child(command("data", {"--resume"})).wait(), 1);
}

TEST(SessionFile, TheLatestFileOfThisStudyAndParticipantIsFound) {
    const TemporaryFolder folder;
    EXPECT_EQ(latest_session_file(folder.path(), "a", "P01"), fs::path());
    EXPECT_EQ(new_session_file(folder / "new", "a", "P01", 0).filename(), "a_P01_19700101T000000Z.sqlite");
    for (const char* name : {"a_P01_20260101T000000Z.sqlite", "a_P01_20251231T235959Z.sqlite",
                             "a_P01_x_20270101T000000Z.sqlite", "a_P011_20270101T000000Z.sqlite",
                             "b_P01_20270101T000000Z.sqlite", "a_P01_20270101T000000Z.sqlite-wal"})
        folder.write(name, "");
    EXPECT_EQ(latest_session_file(folder.path(), "a", "P01").filename(), "a_P01_20260101T000000Z.sqlite");
}

}  // namespace
}  // namespace parafovea
