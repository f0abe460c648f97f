// Walks a staircase.
#include "study/staircase.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace parafovea {

std::vector<int> staircase_track(const Staircase& staircase, const std::vector<bool>& positive) {
    const int top = static_cast<int>(staircase.levels.size()) - 1;
    assert(top >= 0 && staircase.start >= 0 && staircase.start <= top);
    assert(staircase.down_after >= 1 && staircase.step_up >= 1 && staircase.step_down >= 1);
    std::vector<int> track = {staircase.start};
    int in_a_row = 0;
    for (const bool answer : positive) {
        int level = track.back();
        if (!answer) {
            level = std::min(top, level + staircase.step_up);
            in_a_row = 0;
        } else if (++in_a_row == staircase.down_after) {
            level = std::max(0, level - staircase.step_down);
            in_a_row = 0;
        }
        track.push_back(level);
    }
    return track;
}

std::vector<int> staircase_reversals(const Staircase& staircase, const std::vector<bool>& positive) {
    const std::vector<int> track = staircase_track(staircase, positive);
    std::vector<int> reversals;
    int direction = 0;
    for (std::size_t i = 0; i + 1 < track.size(); ++i) {
        const int step = track[i + 1] - track[i];
        if (step == 0) continue;
        const int now = step > 0 ? 1 : -1;
        if (direction != 0 && now != direction) reversals.push_back(static_cast<int>(i));
        direction = now;
    }
    return reversals;
}

double staircase_threshold(const Staircase& staircase, const std::vector<bool>& positive, int skipped) {
    const std::vector<int> track = staircase_track(staircase, positive);
    const std::vector<int> reversals = staircase_reversals(staircase, positive);
    double sum = 0;
    int count = 0;
    for (std::size_t i = static_cast<std::size_t>(std::max(0, skipped)); i < reversals.size(); ++i) {
        sum += staircase.levels[static_cast<std::size_t>(track[static_cast<std::size_t>(reversals[i])])];
        ++count;
    }
    return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

double staircase_target(const Staircase& staircase) {
    const double up = staircase.step_up, down = staircase.step_down;
    return std::pow(up / (up + down), 1.0 / staircase.down_after);
}

}  // namespace parafovea
