// The decision of the study: the highest sigma at which pictures still pass for full resolution, and how sure
// that is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/tally.h"

namespace parafovea {

struct NonInferiority {
    double margin = 0.0;
    double low = 0.0;  // one-sided 95 % lower bound of P_I: the lower of Wilson's and the bootstrap's
    bool non_inferior = false;  // low > criterion - margin
};

struct SigmaShare {
    std::optional<double> sigma;  // absent: no setting reached the criterion
    double share = 0.0;           // of the resamples in which it was the highest accepted sigma
};

struct Decision {
    double criterion = 0.8;
    std::optional<Condition>
        chosen;            // highest sigma of the conditions with P_I >= criterion, there the highest P_I
    Proportion identical;  // of the chosen condition
    int resamples = 0;     // of whole participants; 0 with fewer than two of them
    double probability_reached = 0.0;  // share of resamples in which the chosen condition's P_I >= criterion
    double probability_chosen = 0.0;   // in which the same condition is chosen again
    Interval
        bootstrap;  // 95 % expanded percentile interval (psychometric_people.h) of the chosen condition's P_I
    std::vector<SigmaShare> highest_sigma;  // in rising order, "none" first
    std::optional<NonInferiority> non_inferiority;
};

// The paper's rule (Meng et al. 2018, Section 4.3) with a bootstrap over participants (Efron and Tibshirani
// 1993).
Decision decide(const Tally& tally, double criterion, double margin, int resamples = 4000,
                std::uint64_t seed = 1);

// The same in sentences.
std::string decision_text(const Decision& decision);

}  // namespace parafovea
