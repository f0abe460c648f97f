// McNemar's test of two matched yes/no conditions, the paired difference of shares, and Holm's adjustment of
// many p values.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/cochran_q.h"
#include "analysis/proportion.h"

namespace parafovea {

// The four ways a matched pair of answers can fall.
struct PairedCounts {
    std::int64_t both = 0;
    std::int64_t first_only = 0;   // b
    std::int64_t second_only = 0;  // c
    std::int64_t neither = 0;
};

struct McNemar {
    double p_exact = 1.0;  // min(1, 2 P(Bin(b + c, 1/2) <= min(b, c))); 1 without discordant pairs
    double p_mid =
        1.0;  // p_exact - P(Bin = min(b, c)); 1 - P / 2 when b = c (Fagerland, Lydersen and Laake 2013)
    std::optional<double>
        chi2;  // (b - c)^2 / (b + c), without continuity correction; absent without discordant pairs
    std::optional<double> p_chi2;
};

McNemar mcnemar(std::int64_t first_only, std::int64_t second_only);

struct PairedDifference {
    double difference = 0.0;  // share of the first minus share of the second
    Interval interval;        // Newcombe 1998, method 10 (square-and-add of Wilson limits)
};

// Absent without pairs.
std::optional<PairedDifference> paired_difference(const PairedCounts& counts, double confidence = 0.95);

// Holm 1979: adjusted p values in the order given, each at most 1.
std::vector<double> holm_adjusted(std::span<const double> p);

struct PairwiseRow {
    std::size_t first = 0, second = 0;  // columns of the table
    PairedCounts counts;
    McNemar test;
    double holm_exact = 1.0;
    double holm_mid = 1.0;
    std::optional<PairedDifference> difference;  // of first minus second
};

// Every pair of columns, adjusted over all pairs. Never gated on an omnibus test.
std::vector<PairwiseRow> pairwise_mcnemar(const BinaryTable& table);

}  // namespace parafovea
