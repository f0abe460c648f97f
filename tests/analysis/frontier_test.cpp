// The frontier and what follows from it, on rows whose answers can be read off.
#include "analysis/frontier.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "analysis/frontier_report.h"
#include "analysis/tradeoff_table.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace parafovea {
namespace {

constexpr double kFullMs = 100;

// On a display of 100 x 100 pixels, so that samples are shares of 10,000.
TradeoffRow row_of(const std::string& family, const std::string& setting, double share, double jod,
                   double p_identical = 0.9, double ms = 50) {
    TradeoffRow row;
    row.scene = "hall";
    row.width = row.height = 100;
    row.gaze = "centre";
    row.motion = "still";
    row.method = family == "full resolution" ? "full" : "kfr";
    row.family = family;
    row.setting = setting;
    row.shaded_samples = static_cast<std::uint64_t>(std::lround(share * 10000));
    row.jod = row.jod_supersampled = jod;
    row.predicted_p_identical = p_identical;
    row.frame_ms = row.frame_ms_low = row.frame_ms_high = ms;
    row.full_frame_ms = kFullMs;
    return row;
}

std::vector<TradeoffRow> example() {
    return {row_of("full resolution", "", 1, 10, 0.93, 100),
            row_of("published", "sigma=1.2", 0.7, 9.9, 0.92, 80),
            row_of("published", "sigma=1.8", 0.3, 9.5, 0.82, 60),
            row_of("published", "sigma=2.4", 0.17, 9.0, 0.7, 55),
            row_of("rings", "k=1", 0.2, 9.7, 0.88, 70),
            row_of("rings", "k=2", 0.05, 9.3, 0.78, 65),
            row_of("blocks", "r=4", 0.1, 8.0, 0.4, 40)};
}

const Anchor kAnchor{"published", "sigma=1.8"};

const FamilyChoice& choice_of(const std::vector<FamilyChoice>& choices, const std::string& family) {
    return *std::ranges::find(choices, family, &FamilyChoice::family);
}

TEST(Frontier, HoldsWhatNothingElseBeats) {
    const auto rows = example();
    std::vector<std::string> settings;
    for (const std::size_t i : frontier(rows, Cost::samples, Quality::full_resolution))
        settings.push_back(rows[i].setting);
    EXPECT_EQ(settings, (std::vector<std::string>{"k=2", "k=1", "sigma=1.2", ""}));
}

TEST(Frontier, OfRandomRowsIsUndominatedAndDominatesTheRest) {
    std::mt19937 random(5);
    std::uniform_int_distribution<int> cost(1, 60), quality(800, 1000);
    std::vector<TradeoffRow> rows;
    for (int i = 0; i < 200; ++i)
        rows.push_back(row_of("any", std::to_string(i), cost(random) / 60.0, quality(random) / 100.0));
    const auto best = frontier(rows, Cost::samples, Quality::full_resolution);
    const auto beats = [](const TradeoffRow& a, const TradeoffRow& b) {
        return a.shaded_samples <= b.shaded_samples && a.jod >= b.jod &&
               (a.shaded_samples < b.shaded_samples || a.jod > b.jod);
    };
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const bool kept = std::ranges::find(best, i) != best.end();
        bool beaten = false, covered = false;
        for (const std::size_t b : best) {
            covered = covered || beats(rows[b], rows[i]) ||
                      (rows[b].shaded_samples == rows[i].shaded_samples && rows[b].jod == rows[i].jod);
        }
        for (const TradeoffRow& other : rows) beaten = beaten || beats(other, rows[i]);
        EXPECT_TRUE(covered) << i;
        EXPECT_FALSE(kept && beaten) << i;
    }
}

TEST(Frontier, AtEqualQualityTakesTheCheapestSettingThatIsGoodEnough) {
    const auto rows = example();
    const TradeoffRow* anchor = anchor_row(rows, kAnchor);
    ASSERT_NE(anchor, nullptr);
    const auto choices = at_equal_quality(rows, *anchor, Cost::samples, Quality::full_resolution);
    ASSERT_EQ(choices.size(), 3u);  // full resolution is no method to save with
    EXPECT_EQ(choice_of(choices, "published").row->setting, "sigma=1.8");
    EXPECT_DOUBLE_EQ(*choice_of(choices, "published").interpolated_cost, 0.3);
    EXPECT_EQ(choice_of(choices, "rings").row->setting, "k=1");
    EXPECT_FALSE(choice_of(choices, "blocks").row);
    EXPECT_FALSE(choice_of(choices, "blocks").interpolated_cost);
    // 9.5 lies halfway between 9.3 and 9.7, and the logarithm of the cost halfway between those of 0.05 and
    // 0.2.
    EXPECT_NEAR(*choice_of(choices, "rings").interpolated_cost, 0.1, 1e-12);
}

TEST(Frontier, AtEqualCostTakesTheBestSettingThatIsCheapEnough) {
    const auto rows = example();
    const TradeoffRow& anchor = *anchor_row(rows, kAnchor);
    const auto by_samples = at_equal_cost(rows, anchor, Cost::samples, Quality::full_resolution);
    EXPECT_EQ(choice_of(by_samples, "published").row->setting, "sigma=1.8");
    EXPECT_EQ(choice_of(by_samples, "rings").row->setting, "k=1");
    EXPECT_EQ(choice_of(by_samples, "blocks").row->setting, "r=4");
    const auto by_time = at_equal_cost(rows, anchor, Cost::time, Quality::full_resolution);
    EXPECT_FALSE(choice_of(by_time, "rings").row);
    EXPECT_EQ(choice_of(by_time, "blocks").row->setting, "r=4");
}

TEST(Frontier, TimeIsComparedWithFullResolutionOfTheSameRounds) {
    // Measured on another day, when everything took twice as long.
    TradeoffRow later = row_of("rings", "k=3", 0.1, 9.6, 0.9, 110);
    later.full_frame_ms = 2 * kFullMs;
    EXPECT_DOUBLE_EQ(cost_of(later, Cost::time), 0.55);
    EXPECT_DOUBLE_EQ(later.speedup(), 1 / 0.55);
}

TEST(Frontier, FindsTheJodAtTheCriterion) {
    const auto rows = example();
    const auto jod = jod_at_share_identical(rows, 0.8);
    ASSERT_TRUE(jod);
    EXPECT_NEAR(*jod, 9.4, 1e-12);  // between 0.78 at 9.3 and 0.82 at 9.5
    EXPECT_FALSE(jod_at_share_identical(rows, 0.99));
    EXPECT_FALSE(jod_at_share_identical(rows, 0.1));
}

TEST(Frontier, RecommendsOnlyWhatIsInvisibleEverywhere) {
    std::vector<TradeoffRow> rows = example();
    for (TradeoffRow row : example()) {
        row.gaze = "corner";
        if (row.setting == "sigma=1.8") row.predicted_p_identical = 0.79;
        rows.push_back(row);
    }
    for (TradeoffRow row : example()) {
        row.width = row.height = 200;
        rows.push_back(row);
    }
    const auto displays = recommend(rows, 0.8);
    ASSERT_EQ(displays.size(), 2u);
    EXPECT_EQ(displays[0].groups, 2);
    ASSERT_EQ(displays[0].without_visible_loss.size(), 2u);
    EXPECT_EQ(displays[0].without_visible_loss[0].setting, "k=1");  // the cheapest first
    EXPECT_EQ(displays[0].without_visible_loss[1].setting, "sigma=1.2");
    EXPECT_EQ(displays[0].others.size(), 4u);
    EXPECT_EQ(displays[0].others[0].setting, "sigma=1.8");  // the least loss first
    EXPECT_EQ(displays[0].others[0].least_in, "hall, gaze corner, camera still");
    EXPECT_EQ(displays[1].without_visible_loss.size(), 3u);
}

TEST(Frontier, DoesNotRecommendWhatWasNotMeasuredEverywhere) {
    std::vector<TradeoffRow> rows = example();
    TradeoffRow other = row_of("rings", "k=2", 0.05, 9.9, 0.92);
    other.gaze = "corner";
    rows.push_back(other);
    for (const SettingSummary& setting : recommend(rows, 0.8)[0].without_visible_loss)
        EXPECT_EQ(setting.groups, 2);
    EXPECT_TRUE(recommend(rows, 0.8)[0].without_visible_loss.empty());
}

TEST(TradeoffTable, BeginsWithTheColumnsThatScriptsRead) {
    EXPECT_TRUE(
        tradeoff_csv_header().starts_with("scene,width,height,gaze_x,gaze_y,motion,method,setting,shaded_"
                                          "samples,frame_ms,jod,psnr_0_5,psnr_5_15,"
                                          "psnr_15_30,psnr_30_up,flicker,predicted_p_identical,"))
        << tradeoff_csv_header();
}

TEST(TradeoffTable, ReadsBackToTheSameBits) {
    TradeoffRow row = row_of("a, \"quoted\" family", "alpha=4 sigma=1.8", 0.123, 9.1234567890123456);
    row.gaze_x = 0.1 + 0.2;
    row.psnr_db = {std::numeric_limits<double>::infinity(), 1.0 / 3, 40, 1e-300};
    row.passes_ms = "shadow=1.5 pass_1=30.25";
    row.memory_bytes = std::numeric_limits<std::uint64_t>::max();
    row.flip_zone = {0.1, 0.2, 0.3, 0.4};
    row.jod_zone = {9, 8, 7, 6};
    row.frames = 8;
    const std::string line = tradeoff_csv_line(row);
    EXPECT_EQ(parse_tradeoff_line(std::string_view(line).substr(0, line.size() - 1), "here"), row);
}

TEST(TradeoffTable, SaysWhatIsWrongWithALine) {
    const auto message = [](const std::string& line) {
        return message_of([&] { parse_tradeoff_line(line, "file:7"); });
    };
    std::string line = tradeoff_csv_line(row_of("rings", "k=1", 0.2, 9.7));
    line.pop_back();
    EXPECT_NE(message(line.substr(0, line.size() / 2)).find("file:7: "), std::string::npos);
    line.replace(line.find("100"), 3, "ten");
    EXPECT_EQ(message(line), "file:7: 'width' is 'ten'; expected a number");
}

TEST(FrontierReport, WritesTablesFigureAndRecommendation) {
    const TemporaryFolder folder;
    FrontierReport report{example(), kAnchor, 0.8, "a test", "parafovea tradeoff --out here"};
    for (TradeoffRow row : example()) {
        row.motion = "path";
        row.frames = 4;
        report.rows.push_back(row);
    }
    const auto files = write_frontier(report, folder.path());
    for (const char* name :
         {"tradeoff.csv", "equal_quality.csv", "equal_quality.md", "equal_cost.csv", "equal_cost.md",
          "recommendation.md", "frontier.svg", "frontier.png", "frontier.pdf", "frontier_moving.svg"})
        EXPECT_TRUE(std::ranges::find(files, folder.path() / name) != files.end() &&
                    std::filesystem::file_size(folder.path() / name) > 200)
            << name;
    const std::string advice = recommendation_markdown(report);
    EXPECT_NE(advice.find("at no visible loss (JOD no lower than 9.700"), std::string::npos) << advice;
    EXPECT_NE(advice.find("**rings** (k=1) with 20.0 % of the samples and 70.0 % of the time"),
              std::string::npos)
        << advice;
    EXPECT_NE(advice.find("predictions of a model"), std::string::npos);
    EXPECT_NE(equal_quality_markdown(report).find("| rings | k=1 | 9.700 | 9.700 | 88.0 % | 0.2000 | 0.67 |"),
              std::string::npos)
        << equal_quality_markdown(report);
}

TEST(FrontierReport, SaysSoWhenThereIsNothingToCompareWith) {
    FrontierReport report{example(), kAnchor, 0.8, "a test", "a command"};
    EXPECT_EQ(equal_quality_markdown(report).find("Nothing to compare with"), std::string::npos);
    report.anchor.setting = "sigma=3";
    for (const std::string& text : {equal_quality_markdown(report), equal_cost_markdown(report)})
        EXPECT_NE(
            text.find("Nothing to compare with: " + report.anchor.family + " (sigma=3) was not measured"),
            std::string::npos)
            << text;
}

TEST(FrontierReport, SaysSoWhenEverySettingLosesSomethingVisible) {
    FrontierReport report{example(), kAnchor, 0.95, "a test", "a command"};
    EXPECT_NE(
        recommendation_markdown(report).find("no measured setting saves time and loses nothing visible"),
        std::string::npos);
}

TEST(FrontierReport, DoesNotRecommendWhatTakesLongerThanFullResolution) {
    FrontierReport report{example(), kAnchor, 0.8, "a test", "a command"};
    for (TradeoffRow& row : report.rows)
        if (row.family == "rings") row.frame_ms = 1.1 * row.full_frame_ms;
    EXPECT_EQ(recommendation_markdown(report).find("**rings**"), std::string::npos);
}

}  // namespace
}  // namespace parafovea
