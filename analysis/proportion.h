// A share of answers, its standard errors and its confidence intervals.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace parafovea {

struct Interval {
    double low = 0.0;
    double high = 1.0;
};

// Nothing here is NaN: what is not defined (no trial at all) is absent.
struct Proportion {
    std::int64_t n = 0;
    std::int64_t successes = 0;
    std::optional<double> p;
    std::optional<double> standard_error;  // sqrt(p (1 - p) / n), as the paper's error bars; 0 at p = 0 and 1
    std::optional<Interval> wilson;        // Wilson 1927, without continuity correction
    std::optional<Interval> wilson_corrected;  // with it (Newcombe 1998, method 4)
    std::optional<Interval> clopper_pearson;   // Clopper and Pearson 1934, "exact"
    std::optional<Interval> jeffreys;          // equal-tailed posterior under Beta(1/2, 1/2)
};

// 0 <= successes <= n; confidence in (0, 1).
Proportion proportion(std::int64_t successes, std::int64_t n, double confidence = 0.95);

struct ClusterCount {
    std::int64_t n = 0;
    std::int64_t successes = 0;
};

// Standard error of the pooled proportion with whole clusters (participants) as the sampling units: the ratio
// estimator sqrt(P / (P - 1) sum (x_i - p n_i)^2) / sum n_i (Cochran 1977, Eq. 2.46), which is SD(x_i / n_i)
// / sqrt(P) when all clusters are of one size. Clusters without trials are skipped; absent with fewer than
// two others.
std::optional<double> clustered_standard_error(std::span<const ClusterCount> clusters);

}  // namespace parafovea
