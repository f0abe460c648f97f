// `parafovea replay --verify` from outside: a recorded session is equal to itself, and one flipped bit is
// found.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "study/database.h"
#include "tests/app/child_process.h"
#include "tests/app/short_study.h"

namespace parafovea {
namespace {

namespace fs = std::filesystem;

class ReplayCommandTest : public testing::Test {
  protected:
    ProgramOutput run(const std::string& arguments) const {
        return run_program(folder_, arguments + " --quiet");
    }
    // Records a session and returns its file.
    fs::path record(const std::string& gaze_policy) const {
        folder_.write("short.toml", short_study_toml({.gaze = gaze_policy}));
        const ProgramOutput recorded =
            run("run short.toml --participant P03 --seed 3 --display headless --data data");
        EXPECT_EQ(recorded.exit_code, 0) << recorded.errors;
        return short_session(folder_, "data");
    }

    TemporaryFolder folder_;
};

TEST_F(ReplayCommandTest, ARecordedSessionIsEqualToItself) {
    const fs::path file = record("center");
    const ProgramOutput replayed = run("replay '" + file.string() + "' --verify --out pictures");
    EXPECT_EQ(replayed.exit_code, 0) << replayed.out;
    EXPECT_NE(replayed.out.find("every row and every picture is equal"), std::string::npos);
    // Full resolution and four conditions.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "pictures"), fs::directory_iterator()), 5);
}

TEST_F(ReplayCommandTest, ASessionWithTrackedFoveationIsEqualToItself) {
    const fs::path file = record("tracked");
    const ProgramOutput replayed = run("replay '" + file.string() + "' --verify");
    EXPECT_EQ(replayed.exit_code, 0) << replayed.out;
}

TEST_F(ReplayCommandTest, OneFlippedBitOfAGazeSampleAnImageHashOrAnAnswerIsFound) {
    const fs::path file = record("center");
    for (const char* change : {"UPDATE gaze SET arrival_host_ns = arrival_host_ns + 1 - 2 * (arrival_host_ns "
                               "& 1) WHERE trial_id = 5 AND n = 7",
                               "UPDATE frame SET image_hash = image_hash + 1 - 2 * (image_hash & 1) WHERE "
                               "trial_id = 5 AND frame = "
                               "(SELECT min(frame) FROM frame WHERE trial_id = 5 AND image_hash IS NOT NULL)",
                               "UPDATE response SET identical = 1 - identical WHERE trial_id = 5"}) {
        SCOPED_TRACE(change);
        const fs::path changed = folder_ / "changed.sqlite";
        fs::copy_file(file, changed, fs::copy_options::overwrite_existing);
        {
            Database database(changed, Database::Mode::write);
            database.execute(change);
        }
        const ProgramOutput replayed = run("replay changed.sqlite --verify");
        EXPECT_EQ(replayed.exit_code, 1);
        EXPECT_NE(replayed.out.find("trial 4"), std::string::npos) << replayed.out;
        EXPECT_NE(replayed.errors.find("differs"), std::string::npos);
    }
}

}  // namespace
}  // namespace parafovea
