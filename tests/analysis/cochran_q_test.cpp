// Cochran's Q against published tables, an independent enumeration, its algebra and its extremes.
#include "analysis/cochran_q.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

#include "analysis/cochran_exact.h"
#include "analysis/random_draw.h"
#include "tests/analysis/reference_tables.h"

namespace parafovea {
namespace {

struct Reference {
    const char* name;
    BinaryTable table;
    std::int64_t informative;
    double q;
    int df;
    double p_chi2, p_exact, p_mid;
};

TEST(CochranQ, agrees_with_published_tables_to_their_printed_digits) {
    const std::vector<Reference> references{
        {"Conover", conover_table(), 5, 2.8, 2, 0.24659696, 0.3950617, 0.2592593},
        {"web", web_table(), 10, 13.2857143, 3, 0.00405776, 0.0027443, 0.0021264},
        {"SAS", sas_table(), 34, 8.4705882, 2, 0.01447555, 0.0175006, 0.0164685},
        {"CVST 1", cvst1_table(), 8, 4.2, 3, 0.24066189, 0.3112793, 0.2434082},
        {"CVST 2", cvst2_table(), 8, 1.2173913, 4, 0.87522704, 0.9596680, 0.8780335},
        {"RVAideMemoire", rva_table(), 9, 10.8888889, 2, 0.00432024, 0.0039628, 0.0027435}};
    for (const Reference& reference : references) {
        SCOPED_TRACE(reference.name);
        const CochranQ result = cochran_q(reference.table);
        EXPECT_EQ(result.informative_rows, reference.informative);
        EXPECT_EQ(result.df, reference.df);
        EXPECT_NEAR(*result.q, reference.q, 5e-8);
        EXPECT_NEAR(*result.p_chi2, reference.p_chi2, 5e-9);
        EXPECT_NEAR(*result.p_exact, reference.p_exact, 5e-8);
        EXPECT_NEAR(*result.p_mid, reference.p_mid, 5e-8);
        EXPECT_EQ(result.exact_method, ExactMethod::enumeration);
    }
}

TEST(CochranQ, gives_the_exact_fractions_of_small_tables) {
    EXPECT_NEAR(*cochran_q(conover_table()).p_exact, 32.0 / 81.0, 1e-14);
    EXPECT_NEAR(*cochran_q(web_table()).p_exact, 607.0 / 221184.0, 1e-15);
    EXPECT_NEAR(*cochran_q(cvst1_table()).p_exact, 1275.0 / 4096.0, 1e-14);
    EXPECT_NEAR(*cochran_q(rva_table()).p_exact, 26.0 / 6561.0, 1e-15);
    EXPECT_NEAR(*cochran_q(web_table()).q, 93.0 / 7.0, 1e-13);
    EXPECT_NEAR(*cochran_q(sas_table()).q, 144.0 / 17.0, 1e-13);
}

BinaryTable random_table(std::mt19937_64& generator, std::size_t rows, std::size_t columns) {
    BinaryTable table{columns, {}};
    for (std::size_t i = 0; i < rows * columns; ++i)
        table.values.push_back(static_cast<std::uint8_t>(draw_below(generator, 2)));
    return table;
}

// Every arrangement of every row, one by one, with nothing clever about it.
double brute_force_p(const BinaryTable& table, double* mean_q) {
    const std::size_t k = table.columns;
    std::vector<std::vector<std::vector<int>>> choices;
    std::vector<std::int64_t> observed(k, 0), row_totals;
    for (std::size_t i = 0; i < table.rows(); ++i) {
        std::vector<int> row(table.row(i).begin(), table.row(i).end());
        for (std::size_t j = 0; j < k; ++j) observed[j] += row[j];
        row_totals.push_back(std::accumulate(row.begin(), row.end(), 0));
        std::sort(row.begin(), row.end());
        choices.emplace_back();
        do choices.back().push_back(row);
        while (std::next_permutation(row.begin(), row.end()));
    }
    const auto squares = [](const std::vector<std::int64_t>& c) {
        return std::inner_product(c.begin(), c.end(), c.begin(), std::int64_t{0});
    };
    std::int64_t at_least = 0, all = 0;
    double sum_q = 0.0;
    std::vector<std::int64_t> totals(k, 0);
    const std::function<void(std::size_t)> visit = [&](std::size_t row) {
        if (row == choices.size()) {
            ++all;
            at_least += squares(totals) >= squares(observed) ? 1 : 0;
            sum_q += cochran_q_statistic(totals, row_totals).value_or(0.0);
            return;
        }
        for (const auto& choice : choices[row]) {
            for (std::size_t j = 0; j < k; ++j) totals[j] += choice[j];
            visit(row + 1);
            for (std::size_t j = 0; j < k; ++j) totals[j] -= choice[j];
        }
    };
    visit(0);
    *mean_q = sum_q / static_cast<double>(all);
    return static_cast<double>(at_least) / static_cast<double>(all);
}

TEST(CochranQ, exact_p_equals_brute_force_and_q_averages_to_its_degrees_of_freedom) {
    std::mt19937_64 generator(11);
    for (int repeat = 0; repeat < 40; ++repeat) {
        const std::size_t columns = 2 + draw_below(generator, 4), rows = 1 + draw_below(generator, 5);
        const BinaryTable table = random_table(generator, rows, columns);
        const CochranQ result = cochran_q(table);
        double mean_q = 0.0;
        const double p = brute_force_p(table, &mean_q);
        EXPECT_NEAR(*result.p_exact, p, 1e-12);
        if (result.q) {
            EXPECT_NEAR(mean_q, static_cast<double>(columns) - 1.0, 1e-9);
        }
    }
}

// All column totals kept apart and to the end: no sorting, no ranks, no state settled early.
std::map<std::vector<std::int64_t>, double> plain_distribution(
    std::span<const std::int64_t> rows_with_total) {
    const std::size_t k = rows_with_total.size() - 1;
    std::map<std::vector<std::int64_t>, double> states{{std::vector<std::int64_t>(k, 0), 1.0}};
    for (std::size_t ones = 0; ones <= k; ++ones) {
        std::vector<int> first(k, 0);
        std::fill(first.end() - static_cast<std::ptrdiff_t>(ones), first.end(), 1);
        std::vector<std::vector<int>> rows;
        do rows.push_back(first);
        while (std::next_permutation(first.begin(), first.end()));
        for (std::int64_t repeat = 0; repeat < rows_with_total[ones]; ++repeat) {
            std::map<std::vector<std::int64_t>, double> next;
            for (const auto& [totals, share] : states)
                for (const auto& row : rows) {
                    auto to = totals;
                    for (std::size_t j = 0; j < k; ++j) to[j] += row[j];
                    next[to] += share / static_cast<double>(rows.size());
                }
            states = std::move(next);
        }
    }
    return states;
}

TEST(EnumerateColumnTotals, equals_keeping_every_total_for_every_statistic_that_can_be_observed) {
    for (const std::vector<std::int64_t>& rows :
         {std::vector<std::int64_t>{2, 5, 4, 3, 1}, std::vector<std::int64_t>{0, 9, 0, 5},
          std::vector<std::int64_t>{3, 12, 2}, std::vector<std::int64_t>{0, 2, 3, 0, 2, 1}}) {
        const auto states = plain_distribution(rows);
        std::map<std::int64_t, double> share_of;
        double mean = 0.0;
        for (const auto& [totals, share] : states) {
            const auto squares =
                std::inner_product(totals.begin(), totals.end(), totals.begin(), std::int64_t{0});
            share_of[squares] += share;
            mean += share * static_cast<double>(squares);
        }
        double at_least = 1.0;
        for (const auto& [squares, share] : share_of) {
            SCOPED_TRACE(squares);
            const auto counted = enumerate_column_totals(rows, squares, 30'000'000);
            ASSERT_TRUE(counted);
            EXPECT_NEAR(counted->at_least, at_least, 1e-12);
            EXPECT_NEAR(counted->equal, share, 1e-12);
            EXPECT_NEAR(counted->mean, mean, 1e-9 * mean);
            at_least -= share;
        }
    }
}

TEST(CochranQ, is_unchanged_by_uniform_rows_complement_and_order) {
    std::mt19937_64 generator(12);
    for (int repeat = 0; repeat < 30; ++repeat) {
        const std::size_t columns = 2 + draw_below(generator, 4);
        const BinaryTable table = random_table(generator, 9, columns);
        const CochranQ base = cochran_q(table);
        ASSERT_TRUE(base.q);
        const auto expect_same = [&](const BinaryTable& other) {
            const CochranQ result = cochran_q(other);
            EXPECT_NEAR(*result.q, *base.q, 1e-11);
            EXPECT_NEAR(*result.p_exact, *base.p_exact, 1e-12);
            EXPECT_NEAR(*result.p_mid, *base.p_mid, 1e-12);
        };
        BinaryTable padded = table;
        padded.values.insert(padded.values.end(), 3 * columns, std::uint8_t{1});
        padded.values.insert(padded.values.begin(), 2 * columns, std::uint8_t{0});
        expect_same(padded);
        BinaryTable complement = table;
        for (std::uint8_t& value : complement.values) value = value ? 0 : 1;
        expect_same(complement);
        BinaryTable turned = table;  // rows reversed and columns reversed at once
        std::reverse(turned.values.begin(), turned.values.end());
        expect_same(turned);
    }
}

TEST(CochranQ, with_two_columns_is_mcnemar_without_correction_and_the_binomial_test) {
    // b = 1, c = 6, and rows that do not count: (b - c)^2 / (b + c) and twice P(Bin(7, 1/2) <= 1).
    const CochranQ result = cochran_q(table_from("10 01 01 01 01 01 01 11 11 11 00 00"));
    EXPECT_NEAR(*result.q, 25.0 / 7.0, 1e-13);
    EXPECT_NEAR(*result.p_chi2, 0.0587817, 5e-8);
    EXPECT_NEAR(*result.p_exact, 0.125, 1e-14);
    EXPECT_NEAR(*result.p_mid, 0.0703125, 1e-14);
}

TEST(CochranQ, mid_p_lies_below_exact_p_and_drawn_arrangements_agree_with_counted_ones) {
    std::mt19937_64 generator(13);
    for (int repeat = 0; repeat < 6; ++repeat) {
        const BinaryTable table = random_table(generator, 14, 3 + draw_below(generator, 3));
        const CochranQ counted = cochran_q(table);
        EXPECT_LT(*counted.p_mid, *counted.p_exact);
        CochranQOptions options;
        options.work_limit = 0;
        options.seed = 5;
        const CochranQ drawn = cochran_q(table, options);
        ASSERT_EQ(drawn.exact_method, ExactMethod::monte_carlo);
        EXPECT_EQ(drawn.draws, 99'999);
        EXPECT_NEAR(*drawn.p_exact, *counted.p_exact, 5.0 * *drawn.exact_standard_error + 2e-5);
        const double mid_error = std::sqrt(*counted.p_mid * (1.0 - *counted.p_mid) / 99'999.0);
        EXPECT_NEAR(*drawn.p_mid, *counted.p_mid, 5.0 * mid_error + 2e-5);
        EXPECT_EQ(*drawn.p_exact, *cochran_q(table, options).p_exact) << "the same seed must give the same p";
    }
}

TEST(CochranQ, of_uniform_rows_is_undefined_and_says_p_exact_1) {
    for (const char* text : {"1111 1111 0000", "1111", "000"}) {
        const CochranQ result = cochran_q(table_from(text));
        EXPECT_FALSE(result.q);
        EXPECT_FALSE(result.p_chi2);
        EXPECT_FALSE(result.log10_p);
        EXPECT_EQ(result.informative_rows, 0);
        EXPECT_EQ(*result.p_exact, 1.0);
    }
    const CochranQ empty = cochran_q(BinaryTable{4, {}});
    EXPECT_EQ(empty.rows, 0);
    EXPECT_FALSE(empty.q);
    EXPECT_EQ(*empty.p_exact, 1.0);
    const CochranQ one_column = cochran_q(table_from("1 0 1"));
    EXPECT_FALSE(one_column.q);
}

TEST(CochranQ, of_one_informative_row_is_certain_to_be_reached) {
    const CochranQ result = cochran_q(table_from("1000"));
    EXPECT_NEAR(*result.q, 3.0, 1e-14);
    EXPECT_NEAR(*result.p_exact, 1.0, 1e-14);
    EXPECT_NEAR(*result.p_mid, 0.5, 1e-14);
}

TEST(CochranQ, of_twenty_columns_has_an_exact_or_a_drawn_p) {
    std::mt19937_64 generator(14);
    const CochranQ result = cochran_q(random_table(generator, 30, 20));
    ASSERT_TRUE(result.q);
    EXPECT_EQ(result.exact_method, ExactMethod::monte_carlo);
    EXPECT_GT(*result.p_exact, 0.0);
    EXPECT_LE(*result.p_exact, 1.0);
    EXPECT_NEAR(*result.p_exact, *result.p_chi2, 0.08);
    const CochranQ few = cochran_q(table_from("10000000000000000000 01000000000000000000"));
    EXPECT_EQ(few.exact_method, ExactMethod::enumeration);
    EXPECT_NEAR(*few.p_exact, 1.0,
                1e-12);  // both ones in one column is the only greater arrangement; this is the rest
}

TEST(CochranQ, of_a_million_rows_and_of_q_ten_thousand_stays_finite) {
    BinaryTable table{4, {}};
    table.values.reserve(4'000'000);
    for (int i = 0; i < 1'000'000; ++i) {
        const bool good = i % 100 < 51;
        table.values.insert(table.values.end(),
                            {static_cast<std::uint8_t>(good), 0, 1, static_cast<std::uint8_t>(!good)});
    }
    const CochranQ result = cochran_q(table);
    EXPECT_EQ(result.informative_rows, 1'000'000);
    ASSERT_TRUE(result.q && result.p_chi2 && result.log10_p);
    EXPECT_GT(*result.q, 1e4);
    EXPECT_EQ(*result.p_chi2, 0.0);
    EXPECT_TRUE(std::isfinite(*result.log10_p));
    EXPECT_LT(*result.log10_p, -1e4);
}

TEST(ChiSquareTail, agrees_with_closed_forms_near_and_far) {
    // df 2: exp(-x / 2); df 4: exp(-x / 2) (1 + x / 2). Both known to any size.
    for (double x : {0.5, 5.0, 90.0, 150.0, 700.0, 1e4, 1e6}) {
        SCOPED_TRACE(x);
        const double log10_e = std::log10(std::exp(1.0));
        EXPECT_NEAR(chi_square_tail(x, 2).log10_p, -x / 2.0 * log10_e, 1e-9 * (1.0 + x));
        EXPECT_NEAR(chi_square_tail(x, 4).log10_p, (-x / 2.0 + std::log1p(x / 2.0)) * log10_e,
                    1e-9 * (1.0 + x));
    }
    EXPECT_NEAR(chi_square_tail(1e4, 3).log10_p, -2169.3750, 0.5);
    EXPECT_EQ(chi_square_tail(0.0, 3).p, 1.0);
    // erfc gives df 1 independently: P(chi2_1 >= x) = erfc(sqrt(x / 2)).
    for (double x : {0.1, 1.0, 3.84, 50.0, 120.0, 400.0})
        EXPECT_NEAR(chi_square_tail(x, 1).p / std::erfc(std::sqrt(x / 2.0)), 1.0, 1e-10);
}

TEST(ChiSquareTail, of_published_q_whose_tables_are_not_printed_agrees_to_the_printed_digits) {
    EXPECT_NEAR(chi_square_tail(5.565217, 4).p, .234056, 5e-7);    // WaveMetrics, wave1
    EXPECT_NEAR(chi_square_tail(10.363636, 4).p, .0347281, 5e-8);  // WaveMetrics, wave2
    EXPECT_NEAR(chi_square_tail(4.222222, 2).p, .1211033, 5e-8);   // NCSS
}

TEST(ChiSquareTail, has_the_critical_values_the_paper_prints) {
    EXPECT_NEAR(chi_square_critical_value(3, 0.05), 7.81, 0.005);
    EXPECT_NEAR(chi_square_critical_value(1, 0.05), 3.84, 0.005);
    EXPECT_NEAR(chi_square_tail(chi_square_critical_value(3, 0.05), 3).p, 0.05, 1e-12);
}

TEST(PermuteWithinParticipants, equals_counting_all_orders_of_two_participants) {
    // Sums (3,1,0) and (2,2,0): of the 6 x 6 orders count those with sum C_j^2 at least the observed 25 + 9 +
    // 0.
    const std::vector<std::int64_t> sums{3, 1, 0, 2, 2, 0};
    std::vector<std::int64_t> a{0, 1, 3}, b{0, 2, 2};
    int hits = 0, all = 0;
    do {
        std::vector<int> order{0, 1, 2};
        do {
            std::int64_t squares = 0;
            for (int j = 0; j < 3; ++j) {
                const auto total = a[static_cast<std::size_t>(j)] +
                                   b[static_cast<std::size_t>(order[static_cast<std::size_t>(j)])];
                squares += total * total;
            }
            hits += squares >= 34 ? 1 : 0;
            ++all;
        } while (std::next_permutation(order.begin(), order.end()));
    } while (std::next_permutation(a.begin(), a.end()));
    const PermutationTest test = permute_within_participants(sums, 3, 50'000, 3);
    EXPECT_NEAR(*test.p, static_cast<double>(hits) / all, 5.0 * *test.standard_error);
    EXPECT_EQ(test.participants, 2);
}

TEST(PermuteWithinParticipants, answers_for_no_participant_one_and_equal_sums) {
    EXPECT_FALSE(permute_within_participants({}, 4).p);
    const std::vector<std::int64_t> equal{2, 2, 2, 2};
    EXPECT_EQ(*permute_within_participants(equal, 4).p, 1.0);
    const std::vector<std::int64_t> one{0, 1, 2, 2};
    EXPECT_EQ(*permute_within_participants(one, 4).p, 1.0);
}

}  // namespace
}  // namespace parafovea
