// Signal detection against published values, by simulation of its observers, and at its edges.
#include "analysis/signal_detection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/random_draw.h"
#include "analysis/summary_tables.h"

namespace parafovea {
namespace {

TEST(SignalDetection, agrees_with_reference_values_to_their_printed_digits) {
    struct Reference {
        double hit, false_alarm, independent, differencing, yes_no;
    };
    for (const Reference& r :
         {Reference{.7, .1, 2.5399, 3.0675, 1.8060}, Reference{.5, .2, 1.5820, 1.7933, .8416},
          Reference{.9, .05, 3.5673, 4.5842, 2.9264}, Reference{.3, .1, 1.4880, 1.5727, .7572},
          Reference{.15, .10, .8040, .7710, .2451}}) {
        EXPECT_NEAR(independent_observation_d_prime({r.hit, r.false_alarm}), r.independent, 5.1e-5);
        EXPECT_NEAR(differencing_d_prime({r.hit, r.false_alarm}), r.differencing, 5.1e-5);
        EXPECT_NEAR(yes_no_d_prime({r.hit, r.false_alarm}), r.yes_no, 5.1e-5);
    }
    EXPECT_NEAR(criterion({.7, .1}), .3786, 5e-5);
}

TEST(SignalDetection, of_each_participant_uses_their_own_false_alarms) {
    Tally tally;
    const auto answer = [&](const char* participant, bool validation, bool identical) {
        Response response;
        response.participant = participant;
        response.sigma = 1.8;
        response.alpha = validation ? 1.0 : 4.0;
        response.validation = validation;
        response.identical = identical;
        tally.add(response);
    };
    // (3 + .5) / (4 + 1) = .7 of the foveated and (0 + .5) / (4 + 1) = .1 of the identical pairs are called
    // different.
    for (int i = 0; i < 4; ++i) {
        answer("A", false, i == 0);
        answer("A", true, true);
        answer("B", false, false);  // no validation trial: no row
    }
    const auto rows = participant_sensitivity(tally);
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].participant, "A");
    EXPECT_EQ(rows[0].different_trials, 4);
    EXPECT_NEAR(rows[0].d_yes_no, 1.8060, 5.1e-5);
    EXPECT_NEAR(rows[0].d_differencing, 3.0675, 5.1e-5);
    EXPECT_NEAR(rows[0].criterion, .3786, 5.1e-5);
}

TEST(SignalDetection, recovers_the_sensitivity_of_a_simulated_differencing_observer) {
    std::mt19937_64 generator(31);
    const double d = 1.7, kappa = 1.9;
    int hits = 0, alarms = 0;
    constexpr int kTrials = 200'000;
    for (int i = 0; i < kTrials; ++i) {
        hits += std::abs(draw_normal(generator) + d - draw_normal(generator)) > kappa ? 1 : 0;
        alarms += std::abs(draw_normal(generator) - draw_normal(generator)) > kappa ? 1 : 0;
    }
    const auto rates = corrected_rates(hits, kTrials, alarms, kTrials);
    EXPECT_NEAR(differencing_d_prime(*rates), d, 0.02);
}

TEST(SignalDetection, without_sensitivity_is_zero_and_at_0_and_1_stays_finite) {
    EXPECT_EQ(differencing_d_prime({.2, .2}), 0.0);
    EXPECT_EQ(independent_observation_d_prime({.1, .3}), 0.0);
    EXPECT_LT(yes_no_d_prime({.1, .3}), 0.0);
    const auto perfect = corrected_rates(20, 20, 0, 20);
    EXPECT_NEAR(perfect->hit, 20.5 / 21.0, 1e-15);
    EXPECT_NEAR(perfect->false_alarm, 0.5 / 21.0, 1e-15);
    for (double value : {yes_no_d_prime(*perfect), criterion(*perfect),
                         independent_observation_d_prime(*perfect), differencing_d_prime(*perfect)})
        EXPECT_TRUE(std::isfinite(value));
    EXPECT_FALSE(corrected_rates(0, 0, 0, 5));
    EXPECT_FALSE(corrected_rates(1, 5, 0, 0));
}

}  // namespace
}  // namespace parafovea
