// Proportions and their intervals against published values.
#include "analysis/proportion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace parafovea {
namespace {

struct Reference {
    std::int64_t x, n;
    double se, cp_low, cp_high, wilson_low, wilson_high, wilson_cc_low, wilson_cc_high, jeffreys_low,
        jeffreys_high;
};

TEST(Proportion, agrees_with_published_intervals_to_their_printed_digits) {
    // The first four: Newcombe 1998. All: R's binom.test, prop.test and qbeta.
    const std::vector<Reference> references{
        {81, 263, .028467, .252737, .367622, .255289, .366210, .253509, .368176, .254522, .365647},
        {15, 148, .024807, .057844, .161650, .062386, .160487, .059778, .164450, .060449, .157643},
        {0, 20, 0, 0, .168433, 0, .161125, 0, .200453, .000024, .116639},
        {1, 29, .033883, .000873, .177644, .006113, .171755, .001803, .196282, .003746, .150078},
        {20, 24, .076073, .626158, .952646, .641469, .933213, .618125, .945211, .650912, .941006},
        {24, 24, 0, .857526, 1, .862024, 1, .828285, 1, .901612, .99998},
        {27, 30, .054772, .734712, .978883, .743789, .965400, .723237, .973812, .756598, .971019},
        {30, 30, 0, .884297, 1, .886487, 1, .858680, 1, .920322, .99998},
        {95, 100, .021794, .887165, .983568, .888250, .978456, .881701, .981447, .893900, .980668},
        {1, 1, 0, .025, 1, .206549, 1, .054621, 1, .146746, .999614}};
    for (const Reference& r : references) {
        SCOPED_TRACE(std::to_string(r.x) + "/" + std::to_string(r.n));
        const Proportion p = proportion(r.x, r.n);
        EXPECT_NEAR(*p.standard_error, r.se, 5.1e-7);
        EXPECT_NEAR(p.clopper_pearson->low, r.cp_low, 5.1e-7);
        EXPECT_NEAR(p.clopper_pearson->high, r.cp_high, 5.1e-7);
        EXPECT_NEAR(p.wilson->low, r.wilson_low, 5.1e-7);
        EXPECT_NEAR(p.wilson->high, r.wilson_high, 5.1e-7);
        EXPECT_NEAR(p.wilson_corrected->low, r.wilson_cc_low, 5.1e-7);
        EXPECT_NEAR(p.wilson_corrected->high, r.wilson_cc_high, 5.1e-7);
        EXPECT_NEAR(p.jeffreys->low, r.jeffreys_low, 5.1e-7);
        EXPECT_NEAR(p.jeffreys->high, r.jeffreys_high, 5.1e-6);
    }
}

TEST(Proportion, of_no_trial_is_absent) {
    const Proportion p = proportion(0, 0);
    EXPECT_FALSE(p.p || p.standard_error || p.wilson || p.wilson_corrected || p.clopper_pearson ||
                 p.jeffreys);
}

TEST(Proportion, intervals_hold_the_estimate_stay_inside_0_to_1_and_mirror) {
    for (std::int64_t n : {1, 2, 7, 36, 1000}) {
        for (std::int64_t x = 0; x <= n; x += std::max<std::int64_t>(1, n / 9)) {
            const Proportion p = proportion(x, n), mirror = proportion(n - x, n);
            for (auto member :
                 {&Proportion::wilson, &Proportion::wilson_corrected, &Proportion::clopper_pearson}) {
                EXPECT_LE(0.0, (p.*member)->low);
                EXPECT_LE((p.*member)->low, *p.p);
                EXPECT_LE(*p.p, (p.*member)->high);
                EXPECT_LE((p.*member)->high, 1.0);
                EXPECT_NEAR((p.*member)->low, 1.0 - (mirror.*member)->high, 1e-12);
            }
        }
    }
    EXPECT_TRUE(std::isfinite(proportion(1'000'000, 1'000'000).clopper_pearson->low));
}

TEST(Proportion, a_lower_bound_of_90_percent_needs_36_identical_answers) {
    EXPECT_GE(proportion(36, 36).clopper_pearson->low, 0.90);
    EXPECT_LT(proportion(35, 35).clopper_pearson->low, 0.90);
    EXPECT_GE(proportion(72, 72).clopper_pearson->low, 0.95);
    EXPECT_LT(proportion(71, 71).clopper_pearson->low, 0.95);
}

TEST(ClusteredStandardError, of_four_people_with_ten_trials_is_0_1080) {
    const std::vector<ClusterCount> people{{10, 10}, {10, 9}, {10, 5}, {10, 8}};
    EXPECT_NEAR(*clustered_standard_error(people), 0.1080, 5e-5);
    EXPECT_NEAR(*proportion(32, 40).standard_error, 0.0632, 5e-5);
}

TEST(ClusteredStandardError, ignores_people_without_trials_and_needs_two_with_some) {
    const std::vector<ClusterCount> people{{10, 10}, {0, 0}, {10, 9}, {10, 5}, {10, 8}, {0, 0}};
    EXPECT_NEAR(*clustered_standard_error(people), 0.1080, 5e-5);
    EXPECT_FALSE(clustered_standard_error({}));
    const std::vector<ClusterCount> one{{10, 4}, {0, 0}};
    EXPECT_FALSE(clustered_standard_error(one));
    const std::vector<ClusterCount> same{{4, 4}, {4, 4}};
    EXPECT_EQ(*clustered_standard_error(same), 0.0);
}

}  // namespace
}  // namespace parafovea
