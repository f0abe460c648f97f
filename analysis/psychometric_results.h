// Psychometric functions of a study: P("different") against sigma^2, for every alpha and every participant.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "analysis/psychometric_fit.h"
#include "analysis/tally.h"

namespace parafovea {

struct StudyFit {
    std::optional<std::size_t>
        participant;  // index in PsychometricResults::participants; absent: all together
    double alpha = 0.0;
    PsychometricFit fit;  // x is sigma^2
    // Of a fit to several participants: the interval over people, which is the one to report of a group.
    // Absent for one participant, whose credible interval it then is.
    std::optional<CriterionThreshold> over_people;

    const CriterionThreshold& reported() const { return over_people ? *over_people : fit.at_criterion; }
};

struct PsychometricResults {
    std::vector<std::string> participants;  // those fitted one by one; none in studies too large for that
    std::vector<StudyFit> pooled;           // one per alpha, in rising order
    std::vector<StudyFit> individual;       // participants in order, within them alphas
    std::vector<StudyFit> other_sigmoids;   // pooled, with the cumulative normal and the Weibull
    bool individuals_left_out = false;
    double criterion = 0.8;  // share of "identical"
};

// The logistic function throughout; alphas with a single sigma are fitted too and say so in their warnings.
// Credible intervals take a participant's answers as independent given the function (binomial) unless
// `dispersion` says otherwise. Runs on all cores.
PsychometricResults psychometric_results(const Tally& tally, double criterion, std::uint64_t seed,
                                         Dispersion dispersion = Dispersion::binomial);

// CSV: participant ("all" for pooled), alpha, sigmoid, threshold and width with credible ends, lambda, gamma,
// eta, sigma2 and sigma at the criterion with credible ends and ends over people, trials,
// negative_log_posterior, warnings.
std::string psychometric_csv(const PsychometricResults& results);

}  // namespace parafovea
