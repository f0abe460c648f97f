// The generator against its published outputs, and the distributions against their moments.
#include "devices/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace parafovea {
namespace {

TEST(Random, SplitmixGivesThePublishedSequenceForSeed1234567) {
    std::uint64_t state = 1234567;
    for (const std::uint64_t expected : {6457827717110365317u, 3203168211198807973u, 9817491932198370423u,
                                         4593380528125082431u, 16408922859458223821u})
        EXPECT_EQ(splitmix64(state), expected);
}

TEST(Random, XoshiroGivesThePublishedSequenceForState1234) {
    Random random = Random::from_state({1, 2, 3, 4});
    for (const std::uint64_t expected :
         {std::uint64_t{11520}, std::uint64_t{0}, std::uint64_t{1509978240},
          std::uint64_t{1215971899390074240}, std::uint64_t{1216172134540287360},
          std::uint64_t{607988272756665600}, std::uint64_t{16172922978634559625u},
          std::uint64_t{8476171486693032832}, std::uint64_t{10595114339597558777u},
          std::uint64_t{2904607092377533576}})
        EXPECT_EQ(random.next(), expected);
}

TEST(Random, ASeedFillsTheStateWithSplitmix) {
    std::uint64_t state = 42;
    std::array<std::uint64_t, 4> words;
    for (auto& word : words) word = splitmix64(state);
    Random from_words = Random::from_state(words), from_seed(42);
    for (int i = 0; i < 10; ++i) EXPECT_EQ(from_seed.next(), from_words.next());
}

TEST(Random, StreamsOfOneSeedDifferByNameAndRepeatBySeed) {
    std::set<std::uint64_t> firsts;
    for (const char* name : {"", "a", "b", "ab", "ba", "blinks", "blinkt"})
        firsts.insert(Random::stream(7, name).next());
    firsts.insert(Random::stream(8, "a").next());
    EXPECT_EQ(firsts.size(), 8u);
    EXPECT_EQ(Random::stream(7, "a").next(), Random::stream(7, "a").next());
}

TEST(Random, StreamsAreUncorrelated) {
    Random a = Random::stream(7, "drift"), b = Random::stream(7, "noise");
    const int n = 20000;
    double product = 0;
    for (int i = 0; i < n; ++i) product += a.normal() * b.normal();
    EXPECT_LT(std::abs(product / n), 4 / std::sqrt(n));
}

TEST(Random, BelowIsUniformAndNeverReachesN) {
    Random random(1);
    std::vector<int> counts(7);
    const int n = 70000;
    for (int i = 0; i < n; ++i) ++counts.at(random.below(7));
    double chi_squared = 0;
    for (const int count : counts) chi_squared += (count - n / 7.0) * (count - n / 7.0) / (n / 7.0);
    EXPECT_LT(chi_squared, 22.5);  // 6 degrees of freedom, p = 0.001
    for (int i = 0; i < 100; ++i) EXPECT_EQ(random.below(1), 0u);
}

TEST(Random, BelowRejectsTheUnevenRemainder) {
    // With n = 2^63 + 1 nearly half of all values must be rejected, and a bare modulus would favour small
    // results.
    Random random(3);
    const std::uint64_t n = (std::uint64_t{1} << 63) + 1;
    int upper = 0;
    for (int i = 0; i < 4000; ++i) {
        const std::uint64_t x = random.below(n);
        ASSERT_LT(x, n);
        upper += x >= n / 2;
    }
    EXPECT_NEAR(upper, 2000, 130);
}

TEST(Random, UniformStaysInItsHalfOpenIntervalWithTheRightMoments) {
    Random random(2);
    double sum = 0, squares = 0;
    const int n = 100000;
    for (int i = 0; i < n; ++i) {
        const double x = random.uniform();
        ASSERT_GE(x, 0);
        ASSERT_LT(x, 1);
        sum += x;
        squares += x * x;
    }
    EXPECT_NEAR(sum / n, 0.5, 0.004);
    EXPECT_NEAR(squares / n, 1.0 / 3, 0.004);
}

TEST(Random, NormalHasTheMomentsAndTailsOfANormal) {
    Random random(5);
    const int n = 200000;
    double sum = 0, squares = 0, fourths = 0;
    int beyond_196 = 0;
    for (int i = 0; i < n; ++i) {
        const double x = random.normal();
        sum += x;
        squares += x * x;
        fourths += x * x * x * x;
        beyond_196 += std::abs(x) > 1.959964;
    }
    EXPECT_NEAR(sum / n, 0, 0.01);
    EXPECT_NEAR(squares / n, 1, 0.015);
    EXPECT_NEAR(fourths / n, 3, 0.1);
    EXPECT_NEAR(beyond_196 / double(n), 0.05, 0.002);
}

TEST(Random, LognormalHasItsMedianAndExponentialItsMean) {
    Random random(6);
    const int n = 50000;
    int below_median = 0;
    double sum = 0, sum_log_squares = 0;
    for (int i = 0; i < n; ++i) {
        const double x = random.lognormal(0.3, 0.5);
        below_median += x < 0.3;
        sum_log_squares += std::log(x / 0.3) * std::log(x / 0.3);
        sum += random.exponential(4);
    }
    EXPECT_NEAR(below_median / double(n), 0.5, 0.01);
    EXPECT_NEAR(std::sqrt(sum_log_squares / n), 0.5, 0.01);
    EXPECT_NEAR(sum / n, 0.25, 0.005);
}

TEST(Random, ShuffleReachesEveryOrderEquallyOften) {
    Random random(9);
    std::vector<int> counts(24);
    const int n = 24000;
    for (int i = 0; i < n; ++i) {
        std::array<int, 4> items{0, 1, 2, 3};
        random.shuffle(items);
        int rank = 0;
        for (int a = 0; a < 4; ++a) {
            int smaller = 0;
            for (int b = a + 1; b < 4; ++b) smaller += items[b] < items[a];
            rank = rank * (4 - a) + smaller;
        }
        ++counts.at(rank);
    }
    double chi_squared = 0;
    for (const int count : counts) chi_squared += (count - 1000.0) * (count - 1000.0) / 1000.0;
    EXPECT_LT(chi_squared, 49.7);  // 23 degrees of freedom, p = 0.001
}

TEST(Random, ShuffleOfNothingOrOneItemDrawsNothing) {
    Random shuffled(11), untouched(11);
    std::vector<int> none, one{5};
    shuffled.shuffle(none);
    shuffled.shuffle(one);
    EXPECT_EQ(one[0], 5);
    EXPECT_EQ(shuffled.next(), untouched.next());
}

}  // namespace
}  // namespace parafovea
