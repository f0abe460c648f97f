// Up-down staircases: the next level as a pure function of the answers so far.
#pragma once

#include <vector>

namespace parafovea {

// Transformed and weighted up-down rules on an ascending ladder of levels. After `down_after` positive
// answers in a row the level falls by `step_down` rungs, after every negative answer it rises by `step_up`;
// at the ladder's ends it stays. "Positive" is whatever a higher level makes likelier: here, that a
// difference was seen.
//   Levitt 1971, "Transformed up-down methods in psychoacoustics": equal steps, 1 up n down.
//   Kaernbach 1991, "Simple adaptive testing with the weighted up-down method": down_after = 1, unequal
//   steps.
struct Staircase {
    std::vector<double> levels;  // ascending, at least one
    int start = 0;               // index of the first level
    int down_after = 1;
    int step_up = 1, step_down = 1;  // rungs, at least 1
};

// The index of the level of every trial so far and of the next one: answers.size() + 1 of them.
std::vector<int> staircase_track(const Staircase& staircase, const std::vector<bool>& positive);

// Trials (their numbers, from 0) after which the direction of movement changed. Staying at an end is no
// movement.
std::vector<int> staircase_reversals(const Staircase& staircase, const std::vector<bool>& positive);

// The mean of the levels at the reversals, the first `skipped` left out; Levitt's mid-run estimate is this
// mean over an even number of them. NaN where none are left.
double staircase_threshold(const Staircase& staircase, const std::vector<bool>& positive, int skipped);

// The probability of a positive answer that the staircase comes to rest at: where an expected step up and
// down are equal, p^n step_down = (1 - p^n) step_up (Garcia-Perez 1998, "Forced-choice staircases with fixed
// step sizes").
double staircase_target(const Staircase& staircase);

}  // namespace parafovea
