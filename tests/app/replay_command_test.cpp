// `parafovea replay --verify` from outside: a recorded session is equal to itself, and one flipped bit is
// found.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "app/session_file.h"
#include "study/database.h"
#include "tests/app/short_study.h"

namespace parafovea {
namespace {

namespace fs = std::filesystem;

class ReplayCommandTest : public testing::Test {
  protected:
    void SetUp() override {
        std::string pattern = (fs::temp_directory_path() / "parafovea_replay_XXXXXX").string();
        ASSERT_NE(mkdtemp(pattern.data()), nullptr);
        folder_ = pattern;
    }
    void TearDown() override { fs::remove_all(folder_); }

    int program(const std::string& arguments) const {
        const std::string command = "cd '" + folder_.string() + "' && " + PARAFOVEA_PROGRAM + " " +
                                    arguments + " --quiet >out.txt 2>errors.txt";
        const int status = std::system(command.c_str());
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    std::string text_of(const char* file) const {
        std::ifstream stream(folder_ / file);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    // Records a session and returns its file.
    fs::path record(const std::string& gaze_policy) const {
        std::ofstream(folder_ / "short.toml") << short_study_toml(gaze_policy);
        EXPECT_EQ(program("run short.toml --participant P02 --seed 3 --display headless --data data"), 0)
            << text_of("errors.txt");
        return latest_session_file(folder_ / "data", "short", "P02");
    }

    fs::path folder_;
};

TEST_F(ReplayCommandTest, ARecordedSessionIsEqualToItself) {
    const fs::path file = record("center");
    EXPECT_EQ(program("replay '" + file.string() + "' --verify --out pictures"), 0) << text_of("out.txt");
    EXPECT_NE(text_of("out.txt").find("every row and every picture is equal"), std::string::npos);
    // Full resolution and four conditions.
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "pictures"), fs::directory_iterator()), 5);
}

TEST_F(ReplayCommandTest, ASessionWithTrackedFoveationIsEqualToItself) {
    const fs::path file = record("tracked");
    EXPECT_EQ(program("replay '" + file.string() + "' --verify"), 0) << text_of("out.txt");
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
        EXPECT_EQ(program("replay changed.sqlite --verify"), 1);
        EXPECT_NE(text_of("out.txt").find("trial 4"), std::string::npos) << text_of("out.txt");
        EXPECT_NE(text_of("errors.txt").find("differs"), std::string::npos);
    }
}

}  // namespace
}  // namespace parafovea
