// Fits a psychometric function: its most probable parameters, credible intervals, and the threshold at a
// criterion.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "analysis/psychometric_function.h"

namespace parafovea {

struct PsychometricFitOptions {
    PsychometricModel model;
    double criterion_share = 0.2;  // of "different" at the wanted threshold: 80 % identical
    double credibility = 0.95;
    int draws = 10'000;  // from the posterior; 0 for no intervals
    std::uint64_t seed = 1;
    // Where the search begins, for data known to be like others; it ends within 1e-8 of the lowest negative
    // log posterior. When absent, from several places, within 1e-13.
    std::optional<PsychometricParameters> start;
};

// An end is absent when that end of the posterior never crosses the criterion.
struct CriterionThreshold {
    std::optional<double> value;  // at the most probable parameters
    std::optional<double> low, high;
    std::optional<double> median;  // of the posterior
};

struct PsychometricFit {
    PsychometricModel model;
    PsychometricParameters best;  // maximum of the posterior
    double negative_log_posterior = 0.0;
    std::vector<PsychometricLevel> levels;
    Interval threshold, width, lambda, gamma, eta;  // credible; meaningless without draws
    CriterionThreshold at_criterion;
    double acceptance = 0.0;            // of the Metropolis walk; 0 without draws
    std::vector<std::string> warnings;  // what a reader must know about these data
};

// The maximum by quasi-Newton searches on x rescaled to its range; intervals are equal-tailed, from an
// adaptive Metropolis walk (Haario, Saksman and Tamminen 2001) started there. Absent without a trial.
std::optional<PsychometricFit> fit_psychometric(std::span<const PsychometricLevel> levels,
                                                const PsychometricFitOptions& options = {});

}  // namespace parafovea
