// Predicted display times: what is believed, what is not, and what is used instead.
#include <gtest/gtest.h>

#include <limits>

#include "devices/openxr/display_time_check.h"
#include "devices/random.h"

namespace parafovea {
namespace {

constexpr Duration kPeriod{10'000'000};

DeviceTime at(std::int64_t periods) {
    return {1'000'000'000 + periods * kPeriod.ns};
}

TEST(DisplayTimeCheck, BelievesASteadyDisplay) {
    DisplayTimeCheck check;
    for (int i = 0; i < 100; ++i) {
        const CheckedDisplayTime checked = check.check(at(i), kPeriod, at(i - 1));
        EXPECT_EQ(checked.time, at(i));
        EXPECT_EQ(checked.fault, DisplayTimeFault::none);
        EXPECT_EQ(checked.missed_refreshes, 0);
    }
}

TEST(DisplayTimeCheck, CountsTheRefreshesThatWereMissed) {
    DisplayTimeCheck check;
    check.check(at(0), kPeriod, at(0));
    EXPECT_EQ(check.check(at(4), kPeriod, at(3)).missed_refreshes, 3);
    // A display's own jitter of a third of a period is no miss.
    EXPECT_EQ(check.check({at(5).ns + 3'300'000}, kPeriod, at(4)).missed_refreshes, 0);
}

TEST(DisplayTimeCheck, NeverBelievesANegativeTimeHoweverLongItLasts) {
    DisplayTimeCheck check;
    check.check(at(0), kPeriod, at(0));
    for (int i = 1; i <= 1000; ++i) {
        const CheckedDisplayTime checked = check.check({-at(i).ns}, kPeriod, at(i));
        EXPECT_EQ(checked.fault, DisplayTimeFault::not_positive);
        EXPECT_EQ(checked.time, at(i)) << "one period after the last";
    }
    EXPECT_EQ(check.check(at(1001), kPeriod, at(1000)).fault, DisplayTimeFault::none);
    EXPECT_EQ(check.check({0}, kPeriod, at(1001)).fault, DisplayTimeFault::not_positive);
    EXPECT_EQ(check.check({std::numeric_limits<std::int64_t>::min()}, kPeriod, at(1001)).fault,
              DisplayTimeFault::not_positive);
}

TEST(DisplayTimeCheck, SaysWhenTimeRunsBackwardsOrStandsStill) {
    DisplayTimeCheck check;
    check.check(at(10), kPeriod, at(9));
    EXPECT_EQ(check.check(at(5), kPeriod, at(10)).fault, DisplayTimeFault::backwards);
    EXPECT_EQ(check.check(at(10), kPeriod, at(11)).fault, DisplayTimeFault::backwards);
    EXPECT_EQ(check.check(at(13), kPeriod, at(12)).fault, DisplayTimeFault::none);
}

TEST(DisplayTimeCheck, OneLeapFarAheadDoesNotSpoilAllThatFollow) {
    DisplayTimeCheck check;
    check.check(at(0), kPeriod, at(0));
    EXPECT_EQ(check.check(at(400'000), kPeriod, at(1)).fault, DisplayTimeFault::far_ahead);
    EXPECT_EQ(check.check(at(2), kPeriod, at(1)).fault, DisplayTimeFault::none);
}

TEST(DisplayTimeCheck, APeriodOfZeroCountsAsTheLastGoodOne) {
    DisplayTimeCheck check;
    check.check(at(0), kPeriod, at(0));
    EXPECT_EQ(check.check(at(3), {0}, at(2)).missed_refreshes, 2);
    EXPECT_EQ(check.check({-1}, {-5}, at(3)).time, at(4));
}

TEST(DisplayTimeCheck, WhateverTheRuntimeSaysTheUsedTimesNeverRunBackwards) {
    Random random(4);
    for (int round = 0; round < 200; ++round) {
        DisplayTimeCheck check;
        DeviceTime last{std::numeric_limits<std::int64_t>::min()};
        for (int i = 0; i < 200; ++i) {
            const auto said = static_cast<std::int64_t>(random.next());
            const DeviceTime predicted = random.chance(0.2) ? DeviceTime{said >> random.below(63)} : at(i);
            const CheckedDisplayTime checked = check.check(predicted, {said >> 40}, at(i));
            EXPECT_GT(checked.time.ns, 0);
            EXPECT_GE(checked.time, last);
            EXPECT_GE(checked.missed_refreshes, 0);
            last = checked.time;
        }
    }
}

}  // namespace
}  // namespace parafovea
