// The distribution of sum C_j^2 over all arrangements of a 0/1 table with given row totals, counted or drawn.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace parafovea {

struct ArrangementShares {
    double at_least = 0.0;  // share of arrangements with sum C_j^2 >= observed
    double equal = 0.0;     // with sum C_j^2 == observed
    double mean = 0.0;      // of sum C_j^2
};

// rows_with_total[r]: how many rows hold r ones, r = 0 .. k. Exact up to rounding of the shares (1e-15
// relative). Absent when more than work_limit steps would be needed.
std::optional<ArrangementShares> enumerate_column_totals(std::span<const std::int64_t> rows_with_total,
                                                         std::int64_t observed, std::int64_t work_limit);

struct ArrangementDraws {
    std::int64_t draws = 0;
    std::int64_t at_least = 0;
    std::int64_t equal = 0;
};

// The same by drawing. Absent when the table is so large that fewer than 999 draws would be affordable.
std::optional<ArrangementDraws> draw_column_totals(std::span<const std::int64_t> rows_with_total,
                                                   std::int64_t observed, std::int64_t draws,
                                                   std::uint64_t seed);

}  // namespace parafovea
