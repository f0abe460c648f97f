// Orders that balance position and carry-over, and reports on how well they do.
#pragma once

#include <vector>

namespace parafovea {

// A Williams square over n conditions (Williams 1949): row after row an order of 0 .. n-1 such that every
// condition comes once in every position and is followed by every other equally often. n rows where n is
// even, 2n where n is odd. n >= 1.
std::vector<std::vector<int>> williams_square(int n);

// What a set of orders balances. Counts are over all orders together.
struct Balance {
    std::vector<std::vector<int>> at_position;  // [condition][position]
    std::vector<std::vector<int>> followed_by;  // [condition][the next one]
    int position_low = 0, position_high = 0;    // smallest and largest count of a condition at a position
    int followed_low = 0, followed_high = 0;    // ... of one condition followed by another, itself excluded
};

// Orders of the conditions 0 .. n-1, each of the same length.
Balance balance_of(const std::vector<std::vector<int>>& orders, int n);

}  // namespace parafovea
