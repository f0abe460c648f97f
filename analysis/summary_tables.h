// Tables beside the main ones: sensitivity, pairs of alphas, response times, results with and without
// exclusions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/condition_table.h"
#include "analysis/effect_size.h"
#include "analysis/mcnemar.h"
#include "analysis/signal_detection.h"
#include "analysis/tally.h"

namespace parafovea {

struct SensitivityRow {
    Condition condition;
    DetectionRates rates;  // log-linear corrected, all participants together
    double d_yes_no = 0.0, d_independent = 0.0, d_differencing = 0.0, criterion = 0.0;
};

// Validation pairs give the false alarms; empty without validation trials.
std::vector<SensitivityRow> sensitivity_rows(const Tally& tally, const std::vector<ConditionRow>& conditions);
std::string sensitivity_csv(const std::vector<SensitivityRow>& rows);

struct ParticipantSensitivity {
    std::string participant;
    std::int64_t different_trials = 0, same_trials = 0;  // foveated pairs of all conditions; validation pairs
    DetectionRates rates;                                // log-linear corrected
    double d_yes_no = 0.0, d_independent = 0.0, d_differencing = 0.0, criterion = 0.0;
};

// One row per participant who has both kinds of trial, in the tally's order.
std::vector<ParticipantSensitivity> participant_sensitivity(const Tally& tally);

// CSV: participant, different_trials, same_trials, then as sensitivity_csv.
std::string participant_sensitivity_csv(const std::vector<ParticipantSensitivity>& rows);

struct SigmaEffects {
    double sigma = 0.0;
    std::vector<double> alphas;
    EffectSize effect;
    std::vector<PairwiseRow> pairs;  // blocks: participants x sessions; Holm within this sigma
};

std::vector<SigmaEffects> sigma_effects(const Tally& tally);
std::string pairwise_csv(const std::vector<SigmaEffects>& effects);

struct ResponseTimeRow {
    Condition condition;
    std::int64_t n = 0;
    double mean_s = 0.0, median_s = 0.0, lower_quartile_s = 0.0, upper_quartile_s = 0.0;
};

// Conditions without a measured time are left out.
std::vector<ResponseTimeRow> response_time_rows(const Tally& tally,
                                                const std::vector<ConditionRow>& conditions);
std::string response_time_csv(const std::vector<ResponseTimeRow>& rows);

// CSV: sigma, alpha, n and p_identical with the exclusions applied and with every answer used.
std::string exclusion_csv(const std::vector<ConditionRow>& applied, const std::vector<ConditionRow>& ignored);

}  // namespace parafovea
