// The program from outside: exit codes, one clear line for each thing that cannot go on, and files that
// others read.
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/app/child_process.h"

namespace parafovea {
namespace {

namespace fs = std::filesystem;

class Cli : public testing::Test {
  protected:
    ProgramOutput run(const std::string& arguments, const std::string& environment = "") const {
        return run_program(folder_, arguments, environment);
    }
    void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }

    TemporaryFolder folder_;
};

// Exit 1 and exactly one line, holding every one of the parts.
void expect_one_line(const ProgramOutput& result, const std::vector<std::string>& parts) {
    EXPECT_EQ(result.exit_code, 1) << result.errors;
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    for (const std::string& part : parts)
        EXPECT_NE(result.errors.find(part), std::string::npos)
            << "missing \"" << part << "\" in: " << result.errors;
}

std::string protocol(const std::string& name) {
    return text_of(fs::path(PARAFOVEA_SOURCE_DIR) / "protocols" / name);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

TEST_F(Cli, WrongUsageExitsWithTwo) {
    EXPECT_EQ(run("").exit_code, 2);
    EXPECT_EQ(run("no-such-command").exit_code, 2);
    EXPECT_EQ(run("render --scene primitives --size 12by7 --out a.png").exit_code, 2);
}

TEST_F(Cli, EverySubcommandHasHelpWithAnExample) {
    for (const char* command : {"run", "replay", "simulate", "analyze", "export", "power", "plan", "check",
                                "render", "foveate", "devices", "bench", "tradeoff", "scenes", "withdraw"}) {
        const ProgramOutput result = run(std::string(command) + " --help");
        EXPECT_EQ(result.exit_code, 0) << command;
        EXPECT_NE(result.out.find("Example: parafovea " + std::string(command)), std::string::npos)
            << command;
    }
}

TEST_F(Cli, AMisspeltProtocolKeyIsOneLineWithFileAndLine) {
    write("study.toml", replaced(protocol("final.toml"), "interval_s", "intervall_s"));
    expect_one_line(run("check study.toml"), {"study.toml:", "intervall_s", "write interval_s"});
}

TEST_F(Cli, AMissingSceneIsOneLine) {
    expect_one_line(run("render --scene no_such_scene.glb --out a.png"), {"no_such_scene.glb"});
}

TEST_F(Cli, AnUnreadableCsvRowIsOneLineWithItsNumber) {
    write("answers.csv", "participant,session,sigma,alpha,identical\nP01,1,1.2,1,1\nP01,1,1.2,two,1\n");
    expect_one_line(run("analyze answers.csv --out results"), {"answers.csv:3", "two"});
}

TEST_F(Cli, NoVulkanDeviceIsOneLine) {
    expect_one_line(run("render --scene primitives --size 64x64 --out a.png",
                        "VK_ICD_FILENAMES=/nowhere.json VK_DRIVER_FILES=/nowhere.json"),
                    {"Vulkan"});
}

TEST_F(Cli, AnUnwritableFolderIsOneLine) {
    write("answers.csv", "participant,session,sigma,alpha,identical\nP01,1,1.2,1,1\nP01,1,1.2,2,0\n");
    write("blocked", "a file where a folder should be");
    expect_one_line(run("analyze answers.csv --out blocked/results"), {"blocked"});
}

TEST_F(Cli, AMissingInputIsOneLine) {
    expect_one_line(run("analyze nowhere.sqlite --out results"), {"nowhere.sqlite"});
}

TEST_F(Cli, AParticipantWithoutANumberIsOneLine) {
    write("study.toml", protocol("final.toml"));
    expect_one_line(run("plan study.toml --participant anna --seed 1"), {"anna", "P01"});
}

TEST_F(Cli, ThePlanIsTheSameForTheSameSeedAndAnotherForAnotherSeed) {
    write("study.toml", protocol("final.toml"));
    const std::string once = run("plan study.toml --participant P03 --seed 7").out;
    EXPECT_EQ(once, run("plan study.toml --participant P03 --seed 7").out);
    EXPECT_NE(once, run("plan study.toml --participant P03 --seed 8").out);
    EXPECT_EQ(std::count(once.begin(), once.end(), '\n'), 1 + 5 + 2 * 40);
}

TEST_F(Cli, RenderWritesItsStatistics) {
    const ProgramOutput result =
        run("render --scene primitives --method kfr --sigma 1.8 --alpha 4 --size 320x180 --out a.png --stats "
            "a.json");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_GT(fs::file_size(folder_ / "a.png"), 1000u);
    const auto stats = nlohmann::json::parse(text_of(folder_ / "a.json"));
    EXPECT_EQ(stats.at("width"), 320);
    EXPECT_EQ(stats.at("height"), 180);
    EXPECT_EQ(stats.at("buffer_width"), 178);
    EXPECT_EQ(stats.at("buffer_height"), 100);
    EXPECT_EQ(stats.at("screen_pixels"), 320 * 180);
    EXPECT_GT(stats.at("shaded_samples"), 0);
    EXPECT_LT(stats.at("shaded_samples"), 0.31 * 320 * 180);
    EXPECT_TRUE(stats.at("passes_ms").contains("total"));
    EXPECT_TRUE(stats.at("built").is_array());
    EXPECT_TRUE(stats.at("left_out").is_array());
    EXPECT_FALSE(stats.at("device").get<std::string>().empty());
    EXPECT_FALSE(stats.at("driver").get<std::string>().empty());
}

TEST_F(Cli, AnalyzeReproducesThePublishedTable) {
    const fs::path table = fs::path(PARAFOVEA_SHARED_DIR) / "data" / "table1_consistent_responses.csv";
    if (!fs::exists(table)) GTEST_SKIP() << table << " is not here";
    const ProgramOutput result = run("analyze '" + table.string() + "' --out results");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    for (const char* name : {"figure10.svg", "figure10.png", "figure10.pdf", "figure10.csv", "table1.csv",
                             "table1.md", "report.html"})
        EXPECT_TRUE(fs::exists(folder_ / "results" / name)) << name;
    for (const char* q : {"1.72", "5.79", "8.20", "8.25", "7.49", "14.27", "5.48"})
        EXPECT_NE(result.out.find(q), std::string::npos) << q << " in\n" << result.out;
}

// A study small enough for a test: the final design's trials on a small display with one scene.
std::string small_study() {
    std::string text = protocol("demo.toml");
    text = replaced(text, "scenes = [\"primitives\", \"atrium\"]", "scenes = [\"primitives\"]");
    text = replaced(text, "width_px = 1280", "width_px = 96");
    return replaced(text, "height_px = 1440", "height_px = 108");
}

TEST_F(Cli, ASimulatedStudyEndsWithItsFigureTableAndReport) {
    write("study.toml", small_study());
    const ProgramOutput result = run("simulate study.toml --participants 2 --seed 5 --out study --quiet");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    EXPECT_TRUE(fs::exists(folder_ / "study" / "figure10.svg"));
    EXPECT_TRUE(fs::exists(folder_ / "study" / "table1.csv"));
    EXPECT_NE(text_of(folder_ / "study" / "report.html").find("simulated"), std::string::npos);
    EXPECT_NE(result.out.find("Table 1"), std::string::npos);

    // What is there is not overwritten.
    expect_one_line(run("simulate study.toml --participants 2 --seed 5 --out study --quiet"), {"study"});
}

TEST_F(Cli, TheSameSeedGivesTheSameAnswers) {
    write("study.toml", small_study());
    ASSERT_EQ(run("simulate study.toml --participants 1 --seed 5 --out once --quiet").exit_code, 0);
    ASSERT_EQ(run("simulate study.toml --participants 1 --seed 5 --out again --quiet").exit_code, 0);
    ASSERT_EQ(run("export once --format csv --out once_csv").exit_code, 0);
    ASSERT_EQ(run("export again --format csv --out again_csv").exit_code, 0);
    EXPECT_EQ(text_of(folder_ / "once_csv" / "responses.csv"),
              text_of(folder_ / "again_csv" / "responses.csv"));
}

// Everything a killed study leaves behind is whole: the files open, pass SQLite's own check, and hold
// answers.
TEST_F(Cli, KillingASimulatedStudyLosesNoAnswer) {
    write("study.toml", small_study());
    Child child({PARAFOVEA_PROGRAM, "simulate", (folder_ / "study.toml").string(), "--participants", "8",
                 "--seed", "5", "--out", (folder_ / "study").string(), "--quiet"});

    // Kill as soon as some answers are on the disk, in the middle of a session.
    const auto answers = [&](const fs::path& file) {
        sqlite3* database = nullptr;
        int count = -1;
        if (sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READONLY, nullptr) == SQLITE_OK) {
            sqlite3_stmt* statement = nullptr;
            if (sqlite3_prepare_v2(database, "SELECT count(*) FROM response", -1, &statement, nullptr) ==
                    SQLITE_OK &&
                sqlite3_step(statement) == SQLITE_ROW)
                count = sqlite3_column_int(statement, 0);
            sqlite3_finalize(statement);
        }
        sqlite3_close(database);
        return count;
    };
    const fs::path first = folder_ / "study" / "sessions" / "demo_simulated-01.sqlite";
    int seen = -1;
    for (int waited = 0; seen < 20 && waited < 2400; ++waited) {
        usleep(50'000);
        if (fs::exists(first)) seen = answers(first);
    }
    child.kill_and_wait();
    ASSERT_GE(seen, 20);
    EXPECT_GE(answers(first), seen);

    for (const fs::directory_entry& entry : fs::directory_iterator(folder_ / "study" / "sessions")) {
        if (entry.path().extension() != ".sqlite") continue;
        sqlite3* database = nullptr;
        ASSERT_EQ(sqlite3_open(entry.path().c_str(), &database), SQLITE_OK);
        std::string verdict;
        EXPECT_EQ(sqlite3_exec(
                      database, "PRAGMA integrity_check",
                      [](void* text, int, char** values, char**) {
                          *static_cast<std::string*>(text) += values[0];
                          return 0;
                      },
                      &verdict, nullptr),
                  SQLITE_OK);
        EXPECT_EQ(verdict, "ok") << entry.path();
        sqlite3_close(database);
    }
}

TEST_F(Cli, ABidsExportOfASimulatedStudyBreaksNoCheckedRule) {
    write("study.toml", small_study());
    ASSERT_EQ(run("simulate study.toml --participants 1 --seed 5 --out study --quiet").exit_code, 0);
    const ProgramOutput result = run("export study --format bids --out bids");
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    EXPECT_NE(result.out.find(" 0 violations"), std::string::npos) << result.out;
    EXPECT_TRUE(fs::exists(folder_ / "bids" / "dataset_description.json"));
}

TEST_F(Cli, WithdrawingDeletesOnePersonsFilesAndNoOther) {
    write("study.toml", small_study());
    ASSERT_EQ(run("simulate study.toml --participants 2 --seed 5 --out study --quiet").exit_code, 0);
    ASSERT_EQ(run("withdraw simulated-01 --data study").exit_code, 0);
    EXPECT_FALSE(fs::exists(folder_ / "study" / "sessions" / "demo_simulated-01.sqlite"));
    EXPECT_TRUE(fs::exists(folder_ / "study" / "sessions" / "demo_simulated-02.sqlite"));
}

}  // namespace
}  // namespace parafovea
