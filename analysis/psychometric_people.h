// How far a threshold of a whole group may lie off because other people could have been asked.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "analysis/psychometric_fit.h"

namespace parafovea {

// The 95 % interval of the group's threshold at options.criterion_share: its credible interval, made wider
// about its median by as much as a bootstrap over whole participants (Efron and Tibshirani 1993; their
// answers are drawn anew with replacement, joined and fitted) spreads more than the credible interval, never
// narrower, and as Student's t is wider than the normal distribution. The draws' own percentiles would do for
// large groups; for 18 people they cover 89 % (docs/statistics.md). `people` holds each participant's levels;
// `group` is the fit of them all, with draws and with the same model, where the search begins. Absent with
// fewer than two participants. An end is absent when that end of the draws never crosses the criterion.
std::optional<CriterionThreshold> threshold_over_people(
    std::span<const std::vector<PsychometricLevel>> people, const PsychometricFit& group,
    const PsychometricFitOptions& options, int resamples);

}  // namespace parafovea
