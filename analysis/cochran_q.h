// Cochran's Q test: do k matched yes/no conditions have the same share of yes?
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace parafovea {

// A complete table of 0 and 1, row by row: one row a block (participant, or participant and session), one
// column a condition.
struct BinaryTable {
    std::size_t columns = 0;
    std::vector<std::uint8_t> values;

    std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
    std::span<const std::uint8_t> row(std::size_t i) const {
        return std::span(values).subspan(i * columns, columns);
    }
};

enum class ExactMethod {
    none,         // not asked for, or the table is too large for either way
    enumeration,  // every arrangement counted
    monte_carlo   // arrangements drawn; see draws and exact_standard_error
};

struct CochranQOptions {
    bool exact = true;
    std::int64_t work_limit = 30'000'000;  // steps of the enumeration before arrangements are drawn instead
    std::int64_t draws = 99'999;           // of the Monte Carlo; fewer for tables of very many rows
    std::uint64_t seed = 1;
};

struct CochranQ {
    std::int64_t rows = 0;
    std::int64_t informative_rows = 0;  // neither all 0 nor all 1; the others contribute nothing
    int columns = 0;
    std::vector<std::int64_t> column_totals;
    int df = 0;                     // columns - 1
    std::optional<double> q;        // absent when no row is informative: Q is then 0 / 0
    std::optional<double> p_chi2;   // P(chi-square with df >= q); absent with q
    std::optional<double> log10_p;  // log10 of p_chi2, finite where p_chi2 underflows to 0
    std::optional<double>
        p_exact;                  // P(Q >= q) over all arrangements within rows; 1 when no row is informative
    std::optional<double> p_mid;  // p_exact - P(Q = q) / 2
    ExactMethod exact_method = ExactMethod::none;
    std::int64_t draws = 0;                      // Monte Carlo only: p = (1 + hits) / (draws + 1)
    std::optional<double> exact_standard_error;  // Monte Carlo only
};

// Q = (k - 1) (k sum C_j^2 - N^2) / (k N - sum R_i^2) (Cochran 1950). The exact p enumerates the column
// totals reached when the R_i ones of every row may stand in any of its cells (Patil 1975), by dynamic
// programming over the sorted totals, and compares whole numbers. At least one column; no rows at all is an
// answer (q absent, p_exact 1).
CochranQ cochran_q(const BinaryTable& table, const CochranQOptions& options = {});

// Q of a table from its margins alone; absent when no row is informative. row_totals[i] in 0 ..
// column_totals.size().
std::optional<double> cochran_q_statistic(std::span<const std::int64_t> column_totals,
                                          std::span<const std::int64_t> row_totals);

struct ChiSquareTail {
    double p = 1.0;
    double log10_p = 0.0;
};

// P(chi-square with df degrees of freedom >= x), also as log10 where the number itself underflows. x >= 0, df
// >= 1.
ChiSquareTail chi_square_tail(double x, int df);

// The value that chi-square with df degrees of freedom exceeds with the given probability (7.81 for df 3 at
// 0.05).
double chi_square_critical_value(int df, double probability);

struct PermutationTest {
    std::int64_t participants = 0;  // in the test; those with equal sums in all conditions change nothing
    std::int64_t permutations = 0;
    std::optional<double> p;  // (1 + hits) / (permutations + 1); absent without participants
    std::optional<double> standard_error;
};

// Whole participants as units: condition labels are shuffled within each participant, whose answers within a
// condition stay together; the statistic is sum C_j^2. sums holds one row of `columns` counts of "identical"
// per participant. Unlike Q over single trials it keeps its level when participants differ in which condition
// they notice.
PermutationTest permute_within_participants(std::span<const std::int64_t> sums, std::size_t columns,
                                            std::int64_t permutations = 19'999, std::uint64_t seed = 1);

}  // namespace parafovea
