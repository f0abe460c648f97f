// Validation trials: did a participant attend, and what would a guesser or an attentive person have scored?
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "analysis/tally.h"

namespace parafovea {

// P(at least `needed` of `trials` right) for someone who is right with the given probability on each.
double probability_of_passing(std::int64_t needed, std::int64_t trials, double p_right);

struct ValidationRow {
    std::string participant;
    std::int64_t trials = 0;
    std::int64_t right = 0;  // said "identical" of two identical pictures
    double p_guesser = 1.0;  // P(a guesser scores as high)
    double p_attentive =
        1.0;  // P(someone right 95 % of the time scores as low); small: an inattentive or biased participant
};

// One row per participant with validation trials.
std::vector<ValidationRow> validation_rows(const Tally& tally);

// CSV: participant, trials, right, pass_rate, p_guesser, p_attentive.
std::string validation_csv(const std::vector<ValidationRow>& rows);

}  // namespace parafovea
