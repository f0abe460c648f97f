// Cochran's Q test: do k matched yes/no conditions have the same share of yes?
#include "analysis/cochran_q.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cassert>
#include <cmath>

#include "analysis/cochran_exact.h"
#include "analysis/random_draw.h"

namespace parafovea {
namespace {

// log of the upper regularised incomplete gamma function by Legendre's continued fraction (Abramowitz and
// Stegun 6.5.31, evaluated after Lentz), for x well above a.
double log_gamma_q(double a, double x) {
    constexpr double kTiny = 1e-300;
    double b = x + 1.0 - a, c = 1.0 / kTiny, d = 1.0 / b, fraction = d;
    for (int i = 1; i < 1000; ++i) {
        const double an = -i * (i - a);
        b += 2.0;
        d = an * d + b;
        if (std::abs(d) < kTiny) d = kTiny;
        c = b + an / c;
        if (std::abs(c) < kTiny) c = kTiny;
        d = 1.0 / d;
        fraction *= d * c;
        if (std::abs(d * c - 1.0) < 1e-15) break;
    }
    return a * std::log(x) - x - std::lgamma(a) + std::log(fraction);
}

std::int64_t sum_of_squares(std::span<const std::int64_t> totals) {
    std::int64_t sum = 0;
    for (std::int64_t total : totals) sum += total * total;
    return sum;
}

}  // namespace

ChiSquareTail chi_square_tail(double x, int df) {
    assert(x >= 0.0 && df >= 1);
    if (x == 0.0) return {};
    // Far in the tail the probability is taken from its logarithm, so that both stay consistent.
    if (x > df + 100.0) {
        const double log_p = log_gamma_q(df / 2.0, x / 2.0);
        return {std::exp(log_p), log_p / std::log(10.0)};
    }
    const boost::math::chi_squared_distribution<double> distribution(df);
    const double p = boost::math::cdf(boost::math::complement(distribution, x));
    return {p, std::log10(p)};
}

double chi_square_critical_value(int df, double probability) {
    assert(df >= 1 && probability > 0.0 && probability < 1.0);
    const boost::math::chi_squared_distribution<double> distribution(df);
    return boost::math::quantile(boost::math::complement(distribution, probability));
}

std::optional<double> cochran_q_statistic(std::span<const std::int64_t> column_totals,
                                          std::span<const std::int64_t> row_totals) {
    const double k = static_cast<double>(column_totals.size());
    double total = 0.0;
    for (std::int64_t c : column_totals) total += static_cast<double>(c);
    double spread = 0.0;  // k sum (C_j - N/k)^2, free of the cancellation in k sum C_j^2 - N^2
    for (std::int64_t c : column_totals) {
        const double difference = static_cast<double>(c) - total / k;
        spread += k * difference * difference;
    }
    double within = 0.0;  // k N - sum R_i^2
    for (std::int64_t r : row_totals) within += static_cast<double>(r) * (k - static_cast<double>(r));
    if (within == 0.0) return std::nullopt;
    return (k - 1.0) * spread / within;
}

CochranQ cochran_q(const BinaryTable& table, const CochranQOptions& options) {
    assert(table.columns >= 1 && table.values.size() % table.columns == 0);
    CochranQ result;
    result.rows = static_cast<std::int64_t>(table.rows());
    result.columns = static_cast<int>(table.columns);
    result.df = result.columns - 1;

    // Count the margins.
    const std::size_t k = table.columns;
    result.column_totals.assign(k, 0);
    std::vector<std::int64_t> row_totals(table.rows()), informative_totals(k, 0);
    std::vector<std::int64_t> rows_with_total(k + 1, 0);
    for (std::size_t i = 0; i < table.rows(); ++i) {
        const auto row = table.row(i);
        std::int64_t ones = 0;
        for (std::uint8_t value : row) ones += value != 0 ? 1 : 0;
        const bool informative = ones > 0 && ones < static_cast<std::int64_t>(k);
        for (std::size_t j = 0; j < k; ++j) {
            result.column_totals[j] += row[j] != 0 ? 1 : 0;
            if (informative) informative_totals[j] += row[j] != 0 ? 1 : 0;
        }
        row_totals[i] = ones;
        ++rows_with_total[static_cast<std::size_t>(ones)];
        result.informative_rows += informative ? 1 : 0;
    }

    // Without an informative row there is one arrangement only.
    result.q = cochran_q_statistic(result.column_totals, row_totals);
    if (!result.q) {
        if (options.exact) {
            result.p_exact = 1.0;
            result.p_mid = 0.5;
            result.exact_method = ExactMethod::enumeration;
        }
        return result;
    }
    const ChiSquareTail tail = chi_square_tail(*result.q, result.df);
    result.p_chi2 = tail.p;
    result.log10_p = tail.log10_p;
    if (!options.exact) return result;

    // Count or draw the arrangements of the informative rows.
    rows_with_total.front() = rows_with_total.back() = 0;
    const std::int64_t observed = sum_of_squares(informative_totals);
    if (const auto exact = enumerate_column_totals(rows_with_total, observed, options.work_limit)) {
        result.p_exact = std::min(1.0, exact->at_least);
        result.p_mid = *result.p_exact - exact->equal / 2.0;
        result.exact_method = ExactMethod::enumeration;
    } else if (const auto drawn =
                   draw_column_totals(rows_with_total, observed, options.draws, options.seed)) {
        const double draws = static_cast<double>(drawn->draws);
        result.p_exact = (1.0 + static_cast<double>(drawn->at_least)) / (draws + 1.0);
        result.p_mid =
            (0.5 + static_cast<double>(drawn->at_least) - static_cast<double>(drawn->equal) / 2.0) /
            (draws + 1.0);
        result.exact_method = ExactMethod::monte_carlo;
        result.draws = drawn->draws;
        result.exact_standard_error = std::sqrt(*result.p_exact * (1.0 - *result.p_exact) / draws);
    }
    return result;
}

PermutationTest permute_within_participants(std::span<const std::int64_t> sums, std::size_t columns,
                                            std::int64_t permutations, std::uint64_t seed) {
    assert(columns >= 1 && sums.size() % columns == 0 && permutations >= 1);
    PermutationTest result;
    std::vector<std::int64_t> observed(columns, 0), constant(columns, 0), movable;
    for (std::size_t start = 0; start < sums.size(); start += columns) {
        const auto row = sums.subspan(start, columns);
        const bool moves = std::any_of(row.begin(), row.end(), [&](std::int64_t v) { return v != row[0]; });
        for (std::size_t j = 0; j < columns; ++j) {
            observed[j] += row[j];
            if (!moves) constant[j] += row[j];
        }
        if (moves) movable.insert(movable.end(), row.begin(), row.end());
    }
    result.participants = static_cast<std::int64_t>(sums.size() / columns);
    if (result.participants == 0) return result;
    result.permutations = permutations;
    if (movable.empty()) {
        result.p = 1.0;
        result.standard_error = 0.0;
        return result;
    }
    const std::int64_t statistic = sum_of_squares(observed);
    std::mt19937_64 generator(seed);
    std::int64_t hits = 0;
    std::vector<std::int64_t> totals(columns);
    for (std::int64_t i = 0; i < permutations; ++i) {
        totals = constant;
        for (std::size_t start = 0; start < movable.size(); start += columns) {
            // Shuffling on from the last order is as good as from the first.
            shuffle(std::span(movable).subspan(start, columns), generator);
            for (std::size_t j = 0; j < columns; ++j) totals[j] += movable[start + j];
        }
        hits += sum_of_squares(totals) >= statistic ? 1 : 0;
    }
    result.p = (1.0 + static_cast<double>(hits)) / (static_cast<double>(permutations) + 1.0);
    result.standard_error = std::sqrt(*result.p * (1.0 - *result.p) / static_cast<double>(permutations));
    return result;
}

}  // namespace parafovea
