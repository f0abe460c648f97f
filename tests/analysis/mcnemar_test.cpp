// McNemar, Holm, paired differences and effect sizes against published values and their algebra.
#include "analysis/mcnemar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/effect_size.h"
#include "tests/analysis/reference_tables.h"

namespace parafovea {
namespace {

TEST(McNemar, agrees_with_reference_values_to_their_printed_digits) {
    struct Reference {
        std::int64_t b, c;
        double exact, exact_error, mid, mid_error, chi2;
    };
    const Reference references[] = {{1, 6, .1250000, 5e-8, .0703125, 5e-8, .0587817},
                                    {1, 7, .0703125, 5e-8, .0390625, 5e-8, -1},
                                    {0, 5, .0625000, 5e-8, .0312500, 5e-8, .0253473},
                                    {5, 5, 1, 0, .8769531, 5e-8, 1},
                                    {2, 8, .1093750, 5e-8, .0654297, 5e-8, .0577796},
                                    {3, 12, .0351563, 5.1e-8, .0212708, 5e-8, .0201368},
                                    {0, 1, 1, 0, .5, 0, .3173105},
                                    {59, 6, 4.96465e-12, 5e-18, 2.72580e-12, 5e-18, -1},
                                    {86, 150, 3.72e-5, 5e-8, 2.89e-5, 5e-8, 3.10e-5}};
    for (const Reference& r : references) {
        SCOPED_TRACE(std::to_string(r.b) + "," + std::to_string(r.c));
        for (const McNemar& test : {mcnemar(r.b, r.c), mcnemar(r.c, r.b)}) {
            EXPECT_NEAR(test.p_exact, r.exact, r.exact_error + 1e-15);
            EXPECT_NEAR(test.p_mid, r.mid, r.mid_error + 1e-15);
            if (r.chi2 >= 0.0) {
                EXPECT_NEAR(*test.p_chi2, r.chi2, 5.1e-8);
            }
        }
    }
    const McNemar none = mcnemar(0, 0);
    EXPECT_EQ(none.p_exact, 1.0);
    EXPECT_EQ(none.p_mid, 1.0);
    EXPECT_FALSE(none.chi2 || none.p_chi2);
}

TEST(McNemar, mid_p_never_exceeds_exact_p_and_the_exact_test_is_cochrans_with_two_columns) {
    for (std::int64_t b = 0; b < 12; ++b) {
        for (std::int64_t c = 0; c < 12; ++c) {
            const McNemar test = mcnemar(b, c);
            EXPECT_LE(test.p_mid, test.p_exact);
            BinaryTable table{2, {}};
            for (std::int64_t i = 0; i < b; ++i) table.values.insert(table.values.end(), {1, 0});
            for (std::int64_t i = 0; i < c; ++i) table.values.insert(table.values.end(), {0, 1});
            EXPECT_NEAR(*cochran_q(table).p_exact, test.p_exact, 1e-12);
        }
    }
    EXPECT_TRUE(std::isfinite(mcnemar(1'000'000, 3).p_exact));
}

TEST(Holm, agrees_with_r_s_p_adjust) {
    const std::vector<double> first{.01, .04, .03, .005}, first_adjusted{.03, .06, .06, .02};
    const std::vector<double> second{.0005, .02, .02, .6, .04, .01},
        second_adjusted{.003, .08, .08, .6, .08, .05};
    const auto a = holm_adjusted(first), b = holm_adjusted(second);
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], first_adjusted[i], 1e-12);
    for (std::size_t i = 0; i < b.size(); ++i) EXPECT_NEAR(b[i], second_adjusted[i], 1e-12);
    EXPECT_TRUE(holm_adjusted({}).empty());
}

TEST(PairwiseMcNemar, of_the_web_table_agrees_with_r) {
    const double exact[] = {1, .625, .03125, 1, .0390625, .0078125};
    const double holm_exact[] = {1, 1, .15625, 1, .15625, .046875};
    const double mid[] = {.6875, .375, .015625, .625, .0214844, .0039063};
    const double holm_mid[] = {1, 1, .078125, 1, .0859375, .0234375};
    const auto rows = pairwise_mcnemar(web_table());
    ASSERT_EQ(rows.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(rows[i].test.p_exact, exact[i], 1e-12);
        EXPECT_NEAR(rows[i].holm_exact, holm_exact[i], 1e-12);
        EXPECT_NEAR(rows[i].test.p_mid, mid[i], 5.1e-8);
        EXPECT_NEAR(rows[i].holm_mid, holm_mid[i], 5.1e-8);
    }
}

TEST(PairwiseMcNemar, of_the_sas_table_finds_no_pair_though_the_omnibus_test_does) {
    const auto rows = pairwise_mcnemar(sas_table());
    ASSERT_EQ(rows.size(), 3u);
    // The equal pair has 6 and 6; the other two 8 and 20 or 20 and 8 (their order is that of the columns).
    int equal = 0, unequal = 0;
    for (const PairwiseRow& row : rows) {
        if (row.counts.first_only == 6 && row.counts.second_only == 6) {
            ++equal;
            EXPECT_EQ(row.test.p_exact, 1.0);
            EXPECT_NEAR(row.test.p_mid, .8872, 5e-5);
        } else {
            ++unequal;
            EXPECT_EQ(row.counts.first_only + row.counts.second_only, 28);
            EXPECT_NEAR(row.test.p_exact, .035698, 5e-7);
            EXPECT_NEAR(row.test.p_mid, .024120, 5e-7);
            EXPECT_NEAR(row.holm_exact, .107094, 1e-6);
            EXPECT_NEAR(row.holm_mid, .072359, 1e-6);
        }
    }
    EXPECT_EQ(equal, 1);
    EXPECT_EQ(unequal, 2);
}

TEST(PairedDifference, agrees_with_newcombes_example_and_mirrors) {
    const auto result = paired_difference({36, 12, 2, 0});
    EXPECT_NEAR(result->difference, .200, 5e-7);
    EXPECT_NEAR(result->interval.low, .0569, 5e-5);
    EXPECT_NEAR(result->interval.high, .3404, 5e-5);
    const auto turned = paired_difference({36, 2, 12, 0});
    EXPECT_NEAR(turned->interval.low, -result->interval.high, 1e-12);
    EXPECT_FALSE(paired_difference({}));
    const auto all = paired_difference({5, 0, 0, 0});
    EXPECT_EQ(all->difference, 0.0);
    EXPECT_LE(all->interval.low, 0.0);
    EXPECT_GE(all->interval.high, 0.0);
}

TEST(EffectSize, agrees_with_reference_values_to_their_printed_digits) {
    struct Reference {
        BinaryTable table;
        double w, r;
    };
    for (const Reference& reference :
         {Reference{conover_table(), .116667, .0150943}, Reference{web_table(), .369048, .2325581},
          Reference{sas_table(), .092072, .0469684}, Reference{cvst1_table(), .155556, .0335570},
          Reference{cvst2_table(), .033816, -.0765550}, Reference{rva_table(), .544444, .3940887}}) {
        const EffectSize size = effect_size(reference.table);
        EXPECT_NEAR(*size.eta2_q, reference.w, 5.1e-7);
        EXPECT_NEAR(*size.berry_r, reference.r, 5.1e-8);
    }
}

TEST(EffectSize, is_1_for_perfect_agreement_and_absent_where_undefined) {
    const EffectSize perfect = effect_size(table_from("100 100 100"));
    EXPECT_NEAR(*perfect.eta2_q, 1.0, 1e-12);
    EXPECT_NEAR(*perfect.berry_r, 1.0, 1e-12);
    const EffectSize uniform = effect_size(table_from("111 111"));
    EXPECT_FALSE(uniform.eta2_q || uniform.berry_r);
    EXPECT_FALSE(effect_size(table_from("101")).berry_r);
}

}  // namespace
}  // namespace parafovea
