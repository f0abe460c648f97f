// What a sweep measures and judges: what must hold of any scene, and that a killed run loses nothing.
#include "app/tradeoff_measurement.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <thread>

#include "app/tradeoff_journal.h"
#include "tests/temporary_folder.h"

namespace parafovea {
namespace {

TradeoffPlan small_plan() {
    TradeoffPlan plan;
    plan.scenes = {"primitives"};
    plan.views = {{{96, 64}, 60}};
    plan.gazes = {"centre"};
    plan.motions = {"still"};
    plan.methods = {{"KFR", {"kfr", {{"sigma", 1.5}, {"alpha", 4}}, {}}},
                    {"KFR", {"kfr", {{"sigma", 4}, {"alpha", 4}}, {}}}};
    plan.rounds = 2;
    plan.frames = 3;
    plan.reference_samples = 4;
    return plan;
}

std::vector<TradeoffRow> measured(Gpu& gpu, const TradeoffPlan& plan) {
    TradeoffMeasurement measurement(gpu, plan);
    std::vector<TradeoffRow> rows;
    int work = 0, done = 0;
    for (const TradeoffGroup& group : groups_of(plan)) {
        work += work_of(plan, group, methods_of(plan).size());
        measurement.measure(group, methods_of(plan),
                            {[&](int more, const std::string&) { done += more; },
                             [&](const TradeoffRow& row) { rows.push_back(row); }});
    }
    EXPECT_EQ(done, work);
    return rows_in_order(plan, {}, rows, "the test");
}

TEST(TradeoffMeasurement, FullResolutionIsItsOwnEqualAndMoreReductionIsCheaperAndWorse) {
    Gpu gpu({.validation = true});
    const std::vector<TradeoffRow> rows = measured(gpu, small_plan());
    ASSERT_EQ(rows.size(), 3u);
    const TradeoffRow &full = rows[0], &little = rows[1], &much = rows[2];
    EXPECT_EQ(full.method, "full");
    EXPECT_EQ(full.shaded_samples, 96u * 64u);
    EXPECT_EQ(full.jod, 10);
    EXPECT_TRUE(std::isinf(full.psnr_whole_db));
    EXPECT_EQ(full.flip, 0);
    EXPECT_EQ(full.full_frame_ms, full.frame_ms);
    // Some call identical pictures different: the criterion and lapses.
    EXPECT_NEAR(full.predicted_p_identical, 0.935, 0.02);
    EXPECT_LT(full.jod_supersampled, 10);

    EXPECT_LT(little.shaded_samples, full.shaded_samples);
    EXPECT_LT(much.shaded_samples, little.shaded_samples);
    EXPECT_LT(little.jod, 10);
    EXPECT_LT(much.jod, little.jod);
    EXPECT_LT(much.psnr_whole_db, little.psnr_whole_db);
    EXPECT_GT(much.flip, little.flip);
    EXPECT_LT(much.predicted_p_identical, little.predicted_p_identical);
    for (const TradeoffRow& row : rows) {
        EXPECT_EQ(row.flicker, 0);
        EXPECT_EQ(row.frames, 1);
        EXPECT_GT(row.frame_ms, 0);
        EXPECT_LE(row.frame_ms_low, row.frame_ms);
        EXPECT_LE(row.frame_ms, row.frame_ms_high);
        EXPECT_NE(row.passes_ms.find("pass_1="), std::string::npos);
        EXPECT_EQ(row.gaze_x, 48);
    }
    EXPECT_GT(little.memory_bytes, full.memory_bytes);
    EXPECT_GT(full.memory_bytes, 96u * 64u * 4u);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(TradeoffMeasurement, WhatMovesFlickersAndIsJudgedAsAVideo) {
    Gpu gpu({.validation = true});
    TradeoffPlan plan = small_plan();
    plan.gazes = {"path"};
    plan.motions = {"still", "path"};
    const std::vector<TradeoffRow> rows = measured(gpu, plan);
    ASSERT_EQ(rows.size(), 6u);
    for (const TradeoffRow& row : rows) {
        const bool full = row.method == "full";
        EXPECT_EQ(row.frames, 3);
        EXPECT_EQ(row.flicker == 0, full) << key_of(row);
        EXPECT_EQ(row.jod == 10, full) << key_of(row);
        EXPECT_EQ(row.jod_transient == 10, full) << key_of(row);
        EXPECT_EQ(std::isinf(row.psnr_whole_db), full) << key_of(row);
        if (!full) {
            EXPECT_LT(row.predicted_p_identical, 0.93) << key_of(row);
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

// What a picture says does not depend on what was measured before or beside it.
TEST(TradeoffMeasurement, PicturesAreJudgedTheSameInAnyCompany) {
    Gpu gpu;
    TradeoffPlan plan = small_plan(), fewer = plan;
    fewer.methods.erase(fewer.methods.begin());
    fewer.rounds = 1;
    const TradeoffRow beside = measured(gpu, plan)[2], alone = measured(gpu, fewer)[1];
    EXPECT_EQ(beside.setting, alone.setting);
    EXPECT_EQ(beside.shaded_samples, alone.shaded_samples);
    EXPECT_EQ(beside.jod, alone.jod);
    EXPECT_EQ(beside.jod_supersampled, alone.jod_supersampled);
    EXPECT_EQ(beside.predicted_p_identical, alone.predicted_p_identical);
    EXPECT_EQ(beside.psnr_db, alone.psnr_db);
}

// What does not change from run to run.
std::vector<std::string> lasting(const std::filesystem::path& journal) {
    std::vector<std::string> texts;
    for (const TradeoffRow& row : read_tradeoff_journal(journal).rows)
        texts.push_back(key_of(row) + " " + std::to_string(row.jod) + " " +
                        std::to_string(row.shaded_samples) + " " + std::to_string(row.predicted_p_identical));
    std::ranges::sort(texts);
    return texts;
}

std::string command(const std::filesystem::path& out) {
    return "exec '" PARAFOVEA_PROGRAM
           "' tradeoff --scenes primitives --sizes 96x64 --methods kfr_as_published --gaze "
           "centre,corner,quarter "
           "--motion still --rounds 1 --reference-samples 2 --quiet --out '" +
           out.string() + "' >/dev/null";
}

std::size_t lines_of(const std::filesystem::path& path) {
    std::ifstream file(path);
    return static_cast<std::size_t>(
        std::count(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>(), '\n'));
}

TEST(TradeoffCommand, KilledAndStartedAgainEndsWithTheRowsOfAnUndisturbedRun) {
    const TemporaryFolder folder;
    const std::filesystem::path undisturbed = folder.path() / "undisturbed",
                                killed = folder.path() / "killed";
    ASSERT_EQ(std::system(command(undisturbed).c_str()), 0);

    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
        execl("/bin/sh", "sh", "-c", command(killed).c_str(), nullptr);
        _exit(127);
    }
    // Five lines are the journal's head.
    const std::filesystem::path journal = killed / kTradeoffJournalName;
    int status = 0;
    while (lines_of(journal) < 7 && waitpid(child, &status, WNOHANG) == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    kill(child, SIGKILL);
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "it ended before it could be killed";
    const std::size_t before = read_tradeoff_journal(journal).rows.size();
    EXPECT_GE(before, 2u);
    EXPECT_FALSE(std::filesystem::exists(killed / "tradeoff.csv"));

    ASSERT_EQ(std::system(command(killed).c_str()), 0);
    EXPECT_EQ(lasting(journal), lasting(undisturbed / kTradeoffJournalName));
    EXPECT_EQ(lines_of(killed / "tradeoff.csv"), lines_of(undisturbed / "tradeoff.csv"));
    EXPECT_TRUE(std::filesystem::exists(killed / "recommendation.md"));
}

}  // namespace
}  // namespace parafovea
