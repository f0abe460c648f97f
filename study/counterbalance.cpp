// Williams squares and the balance of orders.
#include "study/counterbalance.h"

#include <algorithm>
#include <cassert>

namespace parafovea {

std::vector<std::vector<int>> williams_square(int n) {
    assert(n >= 1);
    // The first row zigzags 0, 1, n-1, 2, n-2, ...: its successive differences are all different (modulo n).
    std::vector<int> zigzag(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i)
        zigzag[static_cast<std::size_t>(i)] = i % 2 == 1 ? (i + 1) / 2 : (n - i / 2) % n;
    std::vector<std::vector<int>> square;
    for (int row = 0; row < n; ++row) {
        square.push_back(zigzag);
        for (int& condition : square.back()) condition = (condition + row) % n;
    }
    // With odd n each difference occurs twice or never in a row; the reversed rows make up for it.
    if (n % 2 == 1 && n > 1)
        for (int row = 0; row < n; ++row)
            square.emplace_back(square[static_cast<std::size_t>(row)].rbegin(),
                                square[static_cast<std::size_t>(row)].rend());
    return square;
}

Balance balance_of(const std::vector<std::vector<int>>& orders, int n) {
    const std::size_t count = static_cast<std::size_t>(n);
    const std::size_t length = orders.empty() ? 0 : orders.front().size();
    Balance balance;
    balance.at_position.assign(count, std::vector<int>(length));
    balance.followed_by.assign(count, std::vector<int>(count));
    for (const std::vector<int>& order : orders) {
        assert(order.size() == length);
        for (std::size_t i = 0; i < length; ++i) {
            const std::size_t condition = static_cast<std::size_t>(order[i]);
            ++balance.at_position[condition][i];
            if (i + 1 < length) ++balance.followed_by[condition][static_cast<std::size_t>(order[i + 1])];
        }
    }
    bool first = true;
    for (const auto& row : balance.at_position)
        for (const int times : row) {
            balance.position_low = first ? times : std::min(balance.position_low, times);
            balance.position_high = first ? times : std::max(balance.position_high, times);
            first = false;
        }
    first = true;
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < count; ++b) {
            if (a == b) continue;
            const int times = balance.followed_by[a][b];
            balance.followed_low = first ? times : std::min(balance.followed_low, times);
            balance.followed_high = first ? times : std::max(balance.followed_high, times);
            first = false;
        }
    return balance;
}

}  // namespace parafovea
