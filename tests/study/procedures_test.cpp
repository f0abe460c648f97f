// Staircases and QUEST+ against published tracks and convergence points, and with simulated observers.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "devices/random.h"
#include "study/quest_plus.h"
#include "study/staircase.h"

namespace parafovea {
namespace {

std::vector<double> ladder(double from, double to, double step) {
    std::vector<double> levels;
    for (int i = 0; from + i * step <= to + 1e-9; ++i) levels.push_back(from + i * step);
    return levels;
}

std::vector<bool> answers(const char* signs) {
    std::vector<bool> positive;
    for (; *signs; ++signs) positive.push_back(*signs == '+');
    return positive;
}

// Levitt 1971, Table I: 1 up, n down converges on p^n = 1/2. Garcia-Perez 1998 (abstract): with the ratio of
// step down to step up of .2845, .5488, .7393 and .8415, n = 1 to 4 converge on 77.85, 80.35, 83.15 and 85.84
// %. Kaernbach 1991: step up : step down = 3 : 1 converges on 75 %.
TEST(Staircase, converges_where_the_literature_says) {
    const auto target = [](int n, int up, int down) { return staircase_target({{0, 1}, 0, n, up, down}); };
    EXPECT_NEAR(target(1, 1, 1), 0.5, 1e-12);
    EXPECT_NEAR(target(2, 1, 1), 0.7071, 5e-5);
    EXPECT_NEAR(target(3, 1, 1), 0.7937, 5e-5);
    EXPECT_NEAR(target(4, 1, 1), 0.8409, 5e-5);
    EXPECT_NEAR(target(1, 3, 1), 0.75, 1e-12);
    EXPECT_NEAR(target(1, 10000, 2845), 0.7785, 5e-5);
    EXPECT_NEAR(target(2, 10000, 5488), 0.8035, 5e-5);
    EXPECT_NEAR(target(3, 10000, 7393), 0.8315, 5e-5);
    EXPECT_NEAR(target(4, 10000, 8415), 0.8584, 5e-5);
}

// Worked by hand from the rule.
TEST(Staircase, one_up_two_down_moves_as_worked_by_hand) {
    const Staircase staircase{ladder(0, 10, 1), 6, 2, 1, 1};
    EXPECT_EQ(staircase_track(staircase, answers("+++-++-+-+++++")),
              (std::vector<int>{6, 6, 5, 5, 6, 6, 5, 6, 6, 7, 7, 6, 6, 5, 5}));
    // Down after trial 1, up after 3, down after 5, up after 6, down after 10.
    EXPECT_EQ(staircase_reversals(staircase, answers("+++-++-+-+++++")), (std::vector<int>{3, 5, 6, 10}));
    EXPECT_DOUBLE_EQ(staircase_threshold(staircase, answers("+++-++-+-+++++"), 0), (5 + 6 + 5 + 7) / 4.0);
    EXPECT_DOUBLE_EQ(staircase_threshold(staircase, answers("+++-++-+-+++++"), 2), 6);
    EXPECT_TRUE(std::isnan(staircase_threshold(staircase, answers("++"), 0)));
}

TEST(Staircase, weighted_steps_and_the_ends_of_the_ladder) {
    const Staircase staircase{ladder(0, 5, 1), 1, 1, 3, 1};
    EXPECT_EQ(staircase_track(staircase, answers("++---+")), (std::vector<int>{1, 0, 0, 3, 5, 5, 4}));
    // Staying at an end is no reversal.
    EXPECT_EQ(staircase_reversals(staircase, answers("++---+")), (std::vector<int>{2, 5}));
}

class StaircaseOf : public testing::TestWithParam<std::tuple<int, int, int>> {};

TEST_P(StaircaseOf, rests_at_its_target_with_a_simulated_observer) {
    const auto [n, up, down] = GetParam();
    const Staircase staircase{ladder(-6, 6, 0.05), 200, n, up, down};
    // A logistic observer; the proportion of positive answers after it has settled is the target.
    Random random(11);
    std::vector<bool> positive;
    int level = staircase.start, in_a_row = 0;
    double sum = 0;
    const int trials = 200000, settled = 2000;
    for (int i = 0; i < trials; ++i) {
        const double p = 1 / (1 + std::exp(-staircase.levels[static_cast<std::size_t>(level)] * 1.5));
        if (i >= settled) sum += p;
        const bool answer = random.chance(p);
        if (i < 500) positive.push_back(answer);
        in_a_row = answer ? in_a_row + 1 : 0;
        if (!answer) level = std::min(240, level + up);
        if (in_a_row == n) level = std::max(0, level - down), in_a_row = 0;
        if (i < 500) {
            EXPECT_EQ(staircase_track(staircase, positive).back(), level);
        }
    }
    EXPECT_NEAR(sum / (trials - settled), staircase_target(staircase), 0.012);
}

INSTANTIATE_TEST_SUITE_P(Rules, StaircaseOf,
                         testing::Values(std::tuple(1, 1, 1), std::tuple(2, 1, 1), std::tuple(3, 1, 1),
                                         std::tuple(1, 3, 1), std::tuple(2, 4, 2)));

// The tracks of Watson 2017, "QUEST+", as the published test suite of the Python package questplus gives
// them.
struct Track {
    std::vector<int> levels;
    const char* positive;
};

const Track kExample1 = {{-18, -22, -25, -28, -30, -22, -13, -15, -16, -18, -19, -20, -21, -22, -23, -19,
                          -20, -20, -18, -18, -19, -17, -17, -18, -18, -18, -19, -19, -19, -19, -19, -19},
                         "++++--++++++++-++-++-+++++++++++"};

const Track kImplementation = {
    {-18, -22, -12, -13, -15, -16, -17, -18, -19, -21, -24, -25, -26, -27, -21, -22,
     -23, -20, -20, -20, -21, -19, -19, -20, -20, -20, -19, -19, -19, -19, -19, -20,
     -20, -20, -20, -20, -21, -21, -20, -20, -20, -19, -18, -18, -19, -19, -19, -18,
     -18, -17, -18, -18, -18, -17, -17, -17, -17, -17, -17, -17, -18, -18, -18, -18},
    "+-+++++++++++-++-+++-++++-+++++++++++-++--++++-+-+++-+++++++++++"};

const Track kExample2 = {
    {-18, -22, -25, -28, -30, -21, -12, -14, -15, -16, -18, -19, -20, -22, -23, -18, -19, -16, -17,
     -17, -18, -18, -18, -19, -19, -17, -17, -18, -18, -18, -18, -19, -19, -20, -18, -18, -18, -18,
     -18, -19, -19, -19, -19, -20, -18, -18, -18, -18, -18, -18, -18, -18, -18, -19, -19, -19, -20,
     -18, -18, -18, -18, -19, -19, -19, -18, -18, -18, -18, -19, -19, -19, -19, -19, -19, -19, -19,
     -20, -21, -19, -19, -19, -19, -19, -19, -19, -18, -19, -19, -16, -16, -16, -16, -16, -16, 0,
     0,   -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -21, -21, -19, -19,
     -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19, -19},
    "++++--++++++++-+-+++++++-++++++++-+++++++++-+++-++++++++-++++++-+++++++++++++-+-++++-++-+++++++-++++++++"
    "+++++++-+++-+--++++-++++"};

const Track kExample3 = {
    {0,  -1, 2,  -2, 2,  3,  3,  -5, 3,  3,  3,  3,  -7, -7, -7, -7, 4,  -7, 4,  4,  4, -8, -8, -8, 4,  -8,
     4,  -8, -7, 4,  -7, -7, 4,  -7, 4,  -7, -6, 3,  -4, -5, 3,  3,  -7, 2,  2,  1,  0, -7, -6, -6, -6, 2,
     -5, 2,  -6, -5, 3,  -5, -5, 3,  4,  -5, -5, 4,  -4, -4, -4, -4, 4,  3,  3,  4,  5, 5,  -5, 5,  -5, -5,
     4,  5,  5,  -5, -4, -4, -4, -4, 5,  -4, -4, -3, 4,  4,  5,  5,  -4, 5,  -4, -4, 5, 4,  5,  5,  -5, 5,
     -4, -4, -4, -4, 5,  -4, 5,  4,  -4, 4,  -4, -4, -4, 4,  -4, -4, -4, 4,  4,  -4, 4, 4,  4,  -4},
    "+--+++++++-+----++-++---+-+--+--+-+--+-+++-+++-----+----+---+--+---+++--++-+---++-----+--++-++-+-++-++-+"
    "----++++-+---+----+++++-"};

// Plays the answers, checks every level on the way.
std::vector<QuestPlusTrial> play(const QuestPlus& quest, const Track& track) {
    std::vector<QuestPlusTrial> trials;
    for (std::size_t i = 0; i < track.levels.size(); ++i) {
        const int next = quest_plus_next(quest, trials);
        EXPECT_EQ(quest.levels[static_cast<std::size_t>(next)], track.levels[i]) << "trial " << i;
        trials.push_back({next, track.positive[i] == '+'});
        if (testing::Test::HasFailure()) break;
    }
    return trials;
}

TEST(QuestPlus, example_1_threshold) {
    const QuestPlus quest{
        PsychometricShape::weibull_db, ladder(-40, 0, 1), ladder(-40, 0, 1), {3.5}, {0.5}, {0.02}};
    EXPECT_EQ(quest_plus_mode(quest, play(quest, kExample1)).threshold, -20);
}

TEST(QuestPlus, implementation_threshold_and_slope) {
    const QuestPlus quest{
        PsychometricShape::weibull_db, ladder(-40, 0, 1), ladder(-40, 0, 1), {2, 3, 4, 5}, {0.5}, {0.02}};
    const QuestPlusEstimate mode = quest_plus_mode(quest, play(quest, kImplementation));
    EXPECT_EQ(mode.threshold, -20);
    EXPECT_EQ(mode.slope, 3);
}

TEST(QuestPlus, example_2_threshold_slope_and_lapse) {
    const QuestPlus quest{
        PsychometricShape::weibull_db, ladder(-40, 0, 1), ladder(-40, 0, 1), {2, 3, 4, 5}, {0.5},
        {0, 0.01, 0.02, 0.03, 0.04}};
    const QuestPlusEstimate mode = quest_plus_mode(quest, play(quest, kExample2));
    EXPECT_EQ(mode.threshold, -20);
    EXPECT_EQ(mode.slope, 5);
    EXPECT_EQ(mode.lapse, 0.04);
}

TEST(QuestPlus, example_3_mean_standard_deviation_and_lapse) {
    const QuestPlus quest{PsychometricShape::normal,
                          ladder(-10, 10, 1),
                          ladder(-5, 5, 1),
                          ladder(1, 10, 1),
                          {},
                          {0, 0.01, 0.02, 0.03, 0.04},
                          true};
    const QuestPlusEstimate mode = quest_plus_mode(quest, play(quest, kExample3));
    EXPECT_EQ(mode.threshold, 0);
    EXPECT_EQ(mode.slope, 4);
    EXPECT_EQ(mode.lapse, 0.01);
}

TEST(QuestPlus, finds_a_simulated_observers_threshold) {
    const QuestPlus quest{PsychometricShape::normal, ladder(1, 3.6, 0.1), ladder(1, 3.6, 0.1),
                          {0.2, 0.4, 0.8},           {0.02, 0.1},         {0.02}};
    double squares = 0;
    const int observers = 20;
    for (int observer = 0; observer < observers; ++observer) {
        Random random(static_cast<std::uint64_t>(observer));
        const double threshold = random.uniform(1.5, 3);
        std::vector<QuestPlusTrial> trials;
        for (int i = 0; i < 60; ++i) {
            const int next = quest_plus_next(quest, trials);
            const double p = psychometric_probability(
                quest.shape, quest.levels[static_cast<std::size_t>(next)], {threshold, 0.4, 0.05, 0.02});
            trials.push_back({next, random.chance(p)});
        }
        const double error = quest_plus_mean(quest, trials).threshold - threshold;
        squares += error * error;
    }
    EXPECT_LT(std::sqrt(squares / observers), 0.2);
}

}  // namespace
}  // namespace parafovea
