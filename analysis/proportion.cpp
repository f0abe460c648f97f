// A share of answers, its standard errors and its confidence intervals.
#include "analysis/proportion.h"

#include <algorithm>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cassert>
#include <cmath>

namespace parafovea {
namespace {

double beta_quantile(double probability, double a, double b) {
    return boost::math::quantile(boost::math::beta_distribution<double>(a, b), probability);
}

Interval wilson_interval(double x, double n, double z) {
    const double p = x / n;
    const double centre = p + z * z / (2.0 * n);
    const double half = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
    const double scale = 1.0 + z * z / n;
    return {x == 0.0 ? 0.0 : (centre - half) / scale, x == n ? 1.0 : (centre + half) / scale};
}

Interval corrected_wilson_interval(double x, double n, double z) {
    const double p = x / n;
    const double scale = 2.0 * (n + z * z);
    const auto root = [&](double sign) {
        return z * std::sqrt(z * z - sign * 2.0 - 1.0 / n + 4.0 * p * (n * (1.0 - p) + sign));
    };
    const double low = (2.0 * x + z * z - 1.0 - root(1.0)) / scale;
    const double high = (2.0 * x + z * z + 1.0 + root(-1.0)) / scale;
    return {x == 0.0 ? 0.0 : std::max(0.0, low), x == n ? 1.0 : std::min(1.0, high)};
}

}  // namespace

Proportion proportion(std::int64_t successes, std::int64_t n, double confidence) {
    assert(0 <= successes && successes <= n && confidence > 0.0 && confidence < 1.0);
    Proportion result;
    result.n = n;
    result.successes = successes;
    if (n == 0) return result;
    const double x = static_cast<double>(successes), size = static_cast<double>(n);
    const double tail = (1.0 - confidence) / 2.0;
    const double z =
        boost::math::quantile(boost::math::complement(boost::math::normal_distribution<double>(), tail));
    result.p = x / size;
    result.standard_error = std::sqrt(*result.p * (1.0 - *result.p) / size);
    result.wilson = wilson_interval(x, size, z);
    result.wilson_corrected = corrected_wilson_interval(x, size, z);
    result.clopper_pearson = Interval{successes == 0 ? 0.0 : beta_quantile(tail, x, size - x + 1.0),
                                      successes == n ? 1.0 : beta_quantile(1.0 - tail, x + 1.0, size - x)};
    result.jeffreys = Interval{beta_quantile(tail, x + 0.5, size - x + 0.5),
                               beta_quantile(1.0 - tail, x + 0.5, size - x + 0.5)};
    return result;
}

std::optional<double> clustered_standard_error(std::span<const ClusterCount> clusters) {
    double n = 0.0, successes = 0.0, used = 0.0;
    for (const ClusterCount& cluster : clusters) {
        n += static_cast<double>(cluster.n);
        successes += static_cast<double>(cluster.successes);
        used += cluster.n > 0 ? 1.0 : 0.0;
    }
    if (used < 2.0) return std::nullopt;
    const double p = successes / n;
    double squares = 0.0;
    for (const ClusterCount& cluster : clusters) {
        const double residual = static_cast<double>(cluster.successes) - p * static_cast<double>(cluster.n);
        squares += residual * residual;
    }
    return std::sqrt(used / (used - 1.0) * squares) / n;
}

}  // namespace parafovea
