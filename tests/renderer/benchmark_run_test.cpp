// Benchmarks: every method of every scene and size is measured, full resolution first; ratios follow from the
// medians.
#include "renderer/benchmark_run.h"

#include <gtest/gtest.h>

namespace parafovea {
namespace {

TEST(BenchmarkRun, MeasuresEveryMethodAtEverySizeAgainstFullResolution) {
    Gpu gpu({.validation = true});
    BenchmarkPlan plan;
    plan.scenes = {"primitives"};
    plan.sizes = {{96, 54}, {64, 64}};
    plan.methods = standard_benchmark_methods();
    plan.rounds = 3;
    plan.moving_gaze = true;
    double last_share = -1;
    const std::vector<BenchmarkRow> rows = run_benchmark(gpu, plan, [&](double share, const std::string&) {
        EXPECT_GE(share, last_share);
        last_share = share;
    });
    EXPECT_EQ(last_share, 1);
    ASSERT_EQ(rows.size(), 2 * (1 + plan.methods.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const BenchmarkRow& row = rows[i];
        const BenchmarkRow& full = rows[i < rows.size() / 2 ? 0 : rows.size() / 2];
        EXPECT_EQ(row.size, full.size);
        EXPECT_EQ(full.method.method.name, "full");
        EXPECT_GT(row.frame_ms, 0);
        EXPECT_LE(row.frame_ms_low, row.frame_ms);
        EXPECT_GE(row.frame_ms_high, row.frame_ms);
        EXPECT_GT(row.device_memory_bytes, 0u);
        EXPECT_GT(row.speedup, 0);
        if (&row == &full) {
            EXPECT_EQ(row.speedup, 1);
        } else {
            EXPECT_LT(row.shaded_samples, full.shaded_samples);
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

TEST(BenchmarkRun, MeasuresWhatLeavingOutSaves) {
    Gpu gpu({.validation = true});
    BenchmarkPlan plan;
    plan.scenes = {"primitives"};
    plan.sizes = {{64, 36}};
    plan.rounds = 2;
    const std::vector<NeedsRow> rows = measure_needs(gpu, plan, {});
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_GT(rows[0].forced_ms, 0);
    EXPECT_GT(rows[0].needed_ms, 0);
    EXPECT_GT(rows[0].still_ms, 0);
    EXPECT_FALSE(rows[0].left_out.empty());
    EXPECT_TRUE(gpu.validation_messages().empty());
}

}  // namespace
}  // namespace parafovea
