// The interval of a group's threshold over people.
#include "analysis/psychometric_people.h"

#include <gtest/gtest.h>

#include "analysis/expanded_percentile.h"
#include "analysis/random_draw.h"

namespace parafovea {
namespace {

struct Group {
    std::vector<std::vector<PsychometricLevel>> people;
    std::vector<PsychometricLevel> all;
};

// People whose thresholds spread by `sd` about 3.5, `each` answers at each of 7 levels.
Group group_of(int people, int each, double sd) {
    std::mt19937_64 generator(77);
    Group group;
    for (int i = 0; i < people; ++i) {
        const PsychometricParameters person{3.5 + sd * draw_normal(generator), 3.0, 0.02, 0.04, 0.0};
        auto& levels = group.people.emplace_back();
        for (int j = 0; j < 7; ++j) {
            const double sigma = 1.2 + 0.2 * j;
            PsychometricLevel level{sigma * sigma, each, 0};
            const double p = psychometric_value({}, person, level.x);
            for (int k = 0; k < each; ++k) level.different += draw_unit(generator) < p ? 1 : 0;
            levels.push_back(level);
            group.all.push_back(level);
        }
    }
    return group;
}

PsychometricFitOptions binomial() {
    PsychometricFitOptions options;
    options.model.dispersion = Dispersion::binomial;
    options.draws = 4000;
    return options;
}

double width_of(const CriterionThreshold& threshold) {
    return threshold.high.value() - threshold.low.value();
}

TEST(ExpandedPercentile, is_that_of_student_and_tends_to_the_plain_one) {
    EXPECT_NEAR(expanded_percentile_tail(18), 0.014966254, 1e-8);  // R: pnorm(qt(.025, 17) * sqrt(18 / 17))
    EXPECT_NEAR(expanded_percentile_tail(100'000'000), 0.025, 1e-6);
    EXPECT_GT(expanded_percentile_tail(2), 0.0);
    EXPECT_LT(expanded_percentile_tail(2), expanded_percentile_tail(3));
}

TEST(ThresholdOverPeople, is_as_wide_as_the_credible_one_when_people_are_alike_and_wider_when_they_differ) {
    for (const auto& [sd, low, high] : {std::tuple{0.0, 0.6, 1.7}, std::tuple{2.0, 1.5, 5.0}}) {
        const Group group = group_of(24, 6, sd);
        const auto fit = fit_psychometric(group.all, binomial());
        const auto over_people = threshold_over_people(group.people, *fit, binomial(), 200);
        ASSERT_TRUE(over_people);
        EXPECT_EQ(over_people->value, fit->at_criterion.value);
        EXPECT_LE(*over_people->low, *over_people->value);
        EXPECT_GE(*over_people->high, *over_people->value);
        const double ratio = width_of(*over_people) / width_of(fit->at_criterion);
        EXPECT_GT(ratio, low) << sd;
        EXPECT_LT(ratio, high) << sd;
    }
}

TEST(ThresholdOverPeople, search_from_the_groups_own_parameters_finds_the_same_optimum) {
    const Group group = group_of(12, 4, 0.5);
    PsychometricFitOptions options = binomial();
    options.draws = 0;
    const auto from_anywhere = fit_psychometric(group.all, options);
    options.start = PsychometricParameters{2.5, 2.0, 0.1, 0.1, 0.0};
    const auto from_there = fit_psychometric(group.all, options);
    EXPECT_NEAR(from_there->negative_log_posterior, from_anywhere->negative_log_posterior, 1e-4);
    EXPECT_NEAR(from_there->best.threshold, from_anywhere->best.threshold, 0.01);
}

TEST(ThresholdOverPeople, of_one_person_or_of_a_group_that_never_says_different_is_said_plainly) {
    const Group one = group_of(1, 10, 0.0);
    const auto fit = fit_psychometric(one.all, binomial());
    EXPECT_FALSE(threshold_over_people(one.people, *fit, binomial(), 50));

    Group never = group_of(5, 2, 0.0);
    for (auto* levels : {&never.all, &never.people[0], &never.people[1], &never.people[2], &never.people[3],
                         &never.people[4]})
        for (PsychometricLevel& level : *levels) level.different = 0;
    const auto none = fit_psychometric(never.all, binomial());
    const auto over_people = threshold_over_people(never.people, *none, binomial(), 50);
    ASSERT_TRUE(over_people);
    EXPECT_GT(over_people->low.value_or(100.0), 5.0) << "beyond nearly all that was shown";
}

}  // namespace
}  // namespace parafovea
