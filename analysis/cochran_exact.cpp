// The distribution of sum C_j^2 over all arrangements of a 0/1 table with given row totals, counted or drawn.
#include "analysis/cochran_exact.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

#include "analysis/random_draw.h"

namespace parafovea {
namespace {

constexpr std::size_t kMostColumns = 20;
constexpr std::int64_t kMostStates = 4'000'000;
constexpr double kSettledMargin = 1e-6;  // of a deviation, well above rounding
constexpr std::int64_t kMostDrawnCells = 16'000'000;

// Distance of k totals from their mean, given the sum of their squares and their sum.
double deviation(std::int64_t squares, double sum, std::size_t k) {
    return std::sqrt(std::max(0.0, static_cast<double>(squares) - sum * sum / static_cast<double>(k)));
}

// By how much at most a row moves it.
double deviation_of_row(std::size_t ones, std::size_t k) {
    return std::sqrt(static_cast<double>(ones * (k - ones)) / static_cast<double>(k));
}

// One way to add a row of ones to sorted totals: which positions grow, and how many arrangements of the row
// do just that.
struct Move {
    std::uint32_t positions;
    double share;
};

// Within a run of equal totals only the number of ones matters, so they go to the run's first positions; ties
// says which totals equal their predecessor.
std::vector<Move> moves_for(std::uint32_t ties, int ones, int columns) {
    std::vector<Move> moves;
    std::vector<int> run_start, run_length;
    for (int j = 0; j < columns; ++j) {
        if (j > 0 && (ties >> j & 1u)) {
            ++run_length.back();
        } else {
            run_start.push_back(j);
            run_length.push_back(1);
        }
    }
    const auto choose = [](int n, int r) {
        double value = 1.0;
        for (int i = 1; i <= r; ++i) value = value * (n - r + i) / i;
        return value;
    };
    const double all = choose(columns, ones);
    const auto place = [&](auto&& self, std::size_t run, int left, std::uint32_t positions,
                           double ways) -> void {
        if (run == run_start.size()) {
            if (left == 0) moves.push_back({positions, ways / all});
            return;
        }
        for (int take = 0; take <= std::min(left, run_length[run]); ++take)
            self(self, run + 1, left - take, positions | ((1u << take) - 1u) << run_start[run],
                 ways * choose(run_length[run], take));
    };
    place(place, 0, ones, 0, 1.0);
    return moves;
}

// Column totals in falling order are numbered without gaps by the combinatorial number system, so that a
// plain array holds their shares: rank(c_0 >= c_1 >= ...) = sum_i C(c_i + k - 2 - i, k - 1 - i) over the
// first k - 1; the last is implied.
class Ranks {
  public:
    Ranks(int columns, int most) : columns_(columns), most_(most) {
        step_.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(most + 1));
        for (int i = 0; i + 1 < columns; ++i)
            for (int c = 0; c <= most; ++c) step_[index(i, c)] = choose(c + columns - 2 - i, columns - 2 - i);
    }
    // How the rank grows when the total at position i grows from c to c + 1.
    std::int64_t step(int i, int c) const { return i + 1 < columns_ ? step_[index(i, c)] : 0; }

    static std::int64_t choose(int n, int r) {
        double value = 1.0;
        for (int i = 1; i <= r; ++i) value = value * (n - r + i) / i;
        return value > 9e15 ? std::int64_t{1} << 53 : static_cast<std::int64_t>(value + 0.5);
    }

  private:
    std::size_t index(int i, int c) const {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(most_ + 1) +
               static_cast<std::size_t>(c);
    }
    int columns_;
    int most_;
    std::vector<std::int64_t> step_;
};

// What the rows not yet placed can still do to a state's totals.
class RowsAhead {
  public:
    // In the order they will be placed: how many ones they hold, of k cells.
    RowsAhead(std::span<const std::int64_t> rows_with_total, std::span<const std::size_t> order)
        : k_(rows_with_total.size() - 1) {
        for (std::size_t ones : order)
            for (std::int64_t repeat = 0; repeat < rows_with_total[ones]; ++repeat) {
                reach_ += deviation_of_row(ones, k_);
                growth_ += growth_by(ones);
                placed_ += static_cast<double>(ones);
            }
        all_ones_ = placed_;
        placed_ = 0.0;
    }
    void place(std::size_t ones) {
        reach_ -= deviation_of_row(ones, k_);
        growth_ -= growth_by(ones);
        placed_ += static_cast<double>(ones);
    }
    double reach() const { return reach_; }    // by how much they may move the deviation, either way
    double growth() const { return growth_; }  // of sum C_j^2, on average
    double placed() const { return placed_; }  // ones in the rows before
    double all_ones() const { return all_ones_; }

  private:
    // (C + x)^2 - C^2 = 2 C x + x, x being 1 in a share ones / k of the cells.
    double growth_by(std::size_t ones) const {
        const double r = static_cast<double>(ones);
        return 2.0 * r / static_cast<double>(k_) * placed_ + r;
    }
    std::size_t k_;
    double reach_ = 0.0, growth_ = 0.0, placed_ = 0.0, all_ones_ = 0.0;
};

// Sorted totals (k numbers each, in `totals`) and the place of their share in an array by rank.
struct States {
    std::vector<std::uint16_t> totals;
    std::vector<std::size_t> rank;

    void clear() {
        totals.clear();
        rank.clear();
    }
};

std::int64_t sum_of_squares(const std::uint16_t* totals, std::size_t k) {
    std::int64_t squares = 0;
    for (std::size_t j = 0; j < k; ++j) squares += std::int64_t{totals[j]} * totals[j];
    return squares;
}

}  // namespace

std::optional<ArrangementShares> enumerate_column_totals(std::span<const std::int64_t> rows_with_total,
                                                         std::int64_t observed, std::int64_t work_limit) {
    assert(rows_with_total.size() >= 2);
    const std::size_t k = rows_with_total.size() - 1;
    const std::int64_t rows =
        std::accumulate(rows_with_total.begin(), rows_with_total.end(), std::int64_t{0});
    if (k > kMostColumns || rows > 10'000) return std::nullopt;
    const int columns = static_cast<int>(k), most = static_cast<int>(rows);
    const std::int64_t states = Ranks::choose(most + columns - 1, columns - 1);
    if (states > kMostStates) return std::nullopt;
    const Ranks ranks(columns, most);

    std::vector<double> share(static_cast<std::size_t>(states), 0.0), next_share(share.size(), 0.0);
    States now{std::vector<std::uint16_t>(k, 0), {0}}, next;
    share[0] = 1.0;

    // Rows with few or many ones spread the states least, so they come first.
    std::vector<std::size_t> order(k + 1);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return std::min(a, k - a) < std::min(b, k - b); });
    RowsAhead ahead(rows_with_total, order);
    const double wanted = deviation(observed, ahead.all_ones(), k);

    ArrangementShares result;
    std::int64_t work = 0;
    for (std::size_t ones : order) {
        if (rows_with_total[ones] == 0 || ones == 0) continue;
        std::vector<std::vector<Move>> moves(std::size_t{1} << k);
        for (std::int64_t repeat = 0; repeat < rows_with_total[ones]; ++repeat) {
            next.clear();
            for (std::size_t state = 0; state < now.rank.size(); ++state) {
                const std::uint16_t* c = &now.totals[state * k];
                const std::size_t rank = now.rank[state];
                const double weight = share[rank];
                share[rank] = 0.0;
                // By the triangle inequality a state too far out, or too far in, for the rows left to matter
                // is settled at once.
                const std::int64_t squares = sum_of_squares(c, k);
                const double away = deviation(squares, ahead.placed(), k);
                const bool above = away - ahead.reach() > wanted + kSettledMargin;
                if (above || away + ahead.reach() < wanted - kSettledMargin) {
                    result.mean += weight * (static_cast<double>(squares) + ahead.growth());
                    if (above) result.at_least += weight;
                    continue;
                }
                std::int64_t step[kMostColumns];
                std::uint32_t ties = 0;
                for (int j = 0; j < columns; ++j) {
                    step[j] = ranks.step(j, c[j]);
                    if (j > 0 && c[j] == c[j - 1]) ties |= 1u << j;
                }
                if (moves[ties].empty()) moves[ties] = moves_for(ties, static_cast<int>(ones), columns);
                work += static_cast<std::int64_t>(moves[ties].size());
                if (work > work_limit) return std::nullopt;
                for (const Move& move : moves[ties]) {
                    std::int64_t to = static_cast<std::int64_t>(rank);
                    for (std::uint32_t bits = move.positions; bits != 0; bits &= bits - 1)
                        to += step[std::countr_zero(bits)];
                    const double arriving = weight * move.share;
                    if (arriving == 0.0) continue;  // below 1e-308 of all arrangements
                    double& target = next_share[static_cast<std::size_t>(to)];
                    if (target == 0.0) {
                        next.rank.push_back(static_cast<std::size_t>(to));
                        for (std::size_t j = 0; j < k; ++j)
                            next.totals.push_back(
                                static_cast<std::uint16_t>(c[j] + (move.positions >> j & 1u)));
                    }
                    target += arriving;
                }
            }
            share.swap(next_share);
            std::swap(now, next);
            ahead.place(ones);
        }
    }

    for (std::size_t state = 0; state < now.rank.size(); ++state) {
        const std::int64_t squares = sum_of_squares(&now.totals[state * k], k);
        const double weight = share[now.rank[state]];
        result.mean += weight * static_cast<double>(squares);
        if (squares >= observed) result.at_least += weight;
        if (squares == observed) result.equal += weight;
    }
    return result;
}

std::optional<ArrangementDraws> draw_column_totals(std::span<const std::int64_t> rows_with_total,
                                                   std::int64_t observed, std::int64_t draws,
                                                   std::uint64_t seed) {
    assert(rows_with_total.size() >= 2);
    const std::size_t k = rows_with_total.size() - 1;
    std::int64_t cells_per_draw = 0;
    for (std::size_t ones = 1; ones < k; ++ones)
        cells_per_draw += rows_with_total[ones] * static_cast<std::int64_t>(std::min(ones, k - ones));
    ArrangementDraws result;
    result.draws = std::min(draws, kMostDrawnCells / std::max<std::int64_t>(1, cells_per_draw));
    if (result.draws < std::min<std::int64_t>(draws, 999)) return std::nullopt;

    std::mt19937_64 generator(seed);
    std::vector<std::size_t> column(k);
    std::iota(column.begin(), column.end(), std::size_t{0});
    std::vector<std::int64_t> totals(k);
    for (std::int64_t draw = 0; draw < result.draws; ++draw) {
        std::fill(totals.begin(), totals.end(), rows_with_total[k]);
        for (std::size_t ones = 1; ones < k; ++ones) {
            // Draw the rarer of ones and zeros, without replacement.
            const bool draw_ones = ones <= k - ones;
            const std::size_t picks = draw_ones ? ones : k - ones;
            if (!draw_ones)
                for (std::int64_t& total : totals) total += rows_with_total[ones];
            for (std::int64_t row = 0; row < rows_with_total[ones]; ++row) {
                for (std::size_t i = 0; i < picks; ++i) {
                    std::swap(column[i],
                              column[i + draw_below(generator, static_cast<std::uint32_t>(k - i))]);
                    totals[column[i]] += draw_ones ? 1 : -1;
                }
            }
        }
        std::int64_t squares = 0;
        for (std::int64_t total : totals) squares += total * total;
        result.at_least += squares >= observed ? 1 : 0;
        result.equal += squares == observed ? 1 : 0;
    }
    return result;
}

}  // namespace parafovea
