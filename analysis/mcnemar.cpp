// McNemar's test of two matched yes/no conditions, the paired difference of shares, and Holm's adjustment of
// many p values.
#include "analysis/mcnemar.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cassert>
#include <cmath>
#include <numeric>

namespace parafovea {

McNemar mcnemar(std::int64_t first_only, std::int64_t second_only) {
    assert(first_only >= 0 && second_only >= 0);
    McNemar result;
    const std::int64_t discordant = first_only + second_only;
    if (discordant == 0) return result;
    const double smaller = static_cast<double>(std::min(first_only, second_only));
    const boost::math::binomial_distribution<double> coin(static_cast<double>(discordant), 0.5);
    const double at = boost::math::pdf(coin, smaller);
    if (first_only == second_only) {
        result.p_mid = 1.0 - 0.5 * at;
    } else {
        result.p_exact = std::min(1.0, 2.0 * boost::math::cdf(coin, smaller));
        result.p_mid = 2.0 * boost::math::cdf(coin, smaller) - at;
    }
    const double difference = static_cast<double>(first_only - second_only);
    result.chi2 = difference * difference / static_cast<double>(discordant);
    result.p_chi2 = chi_square_tail(*result.chi2, 1).p;
    return result;
}

std::optional<PairedDifference> paired_difference(const PairedCounts& counts, double confidence) {
    const double a = static_cast<double>(counts.both), b = static_cast<double>(counts.first_only);
    const double c = static_cast<double>(counts.second_only), d = static_cast<double>(counts.neither);
    const std::int64_t n = counts.both + counts.first_only + counts.second_only + counts.neither;
    if (n == 0) return std::nullopt;
    const Proportion first = proportion(counts.both + counts.first_only, n, confidence);
    const Proportion second = proportion(counts.both + counts.second_only, n, confidence);
    // The correlation of the two answers; taken as 0 when a margin is empty, and shrunk by n / 2 when
    // positive.
    const double margins = (a + b) * (c + d) * (a + c) * (b + d);
    double phi = 0.0;
    if (margins > 0.0) {
        const double product = a * d - b * c;
        phi = (product > 0.0 ? std::max(product - static_cast<double>(n) / 2.0, 0.0) : product) /
              std::sqrt(margins);
    }
    const double below_first = *first.p - first.wilson->low, above_first = first.wilson->high - *first.p;
    const double below_second = *second.p - second.wilson->low,
                 above_second = second.wilson->high - *second.p;
    PairedDifference result;
    result.difference = *first.p - *second.p;
    const auto reach = [&](double one, double other) {
        return std::sqrt(std::max(0.0, one * one - 2.0 * phi * one * other + other * other));
    };
    result.interval.low = std::max(-1.0, result.difference - reach(below_first, above_second));
    result.interval.high = std::min(1.0, result.difference + reach(above_first, below_second));
    return result;
}

std::vector<double> holm_adjusted(std::span<const double> p) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
    std::vector<double> adjusted(p.size());
    double so_far = 0.0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        so_far = std::max(so_far, std::min(1.0, static_cast<double>(p.size() - i) * p[order[i]]));
        adjusted[order[i]] = so_far;
    }
    return adjusted;
}

std::vector<PairwiseRow> pairwise_mcnemar(const BinaryTable& table) {
    std::vector<PairwiseRow> rows;
    std::vector<double> exact, mid;
    for (std::size_t i = 0; i < table.columns; ++i) {
        for (std::size_t j = i + 1; j < table.columns; ++j) {
            PairwiseRow row{i, j, {}, {}, 1.0, 1.0, {}};
            for (std::size_t r = 0; r < table.rows(); ++r) {
                const bool first = table.row(r)[i] != 0, second = table.row(r)[j] != 0;
                ++(first ? (second ? row.counts.both : row.counts.first_only)
                         : (second ? row.counts.second_only : row.counts.neither));
            }
            row.test = mcnemar(row.counts.first_only, row.counts.second_only);
            row.difference = paired_difference(row.counts);
            exact.push_back(row.test.p_exact);
            mid.push_back(row.test.p_mid);
            rows.push_back(row);
        }
    }
    exact = holm_adjusted(exact);
    mid = holm_adjusted(mid);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].holm_exact = exact[i];
        rows[i].holm_mid = mid[i];
    }
    return rows;
}

}  // namespace parafovea
