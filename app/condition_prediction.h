// What simulated people would answer to a protocol's conditions, before anybody is invited.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "app/picture_source.h"
#include "study/protocol.h"

namespace parafovea {

// One condition in one scene, looked at where its fovea is: the centre.
struct ConditionPrediction {
    std::string scene;
    MethodSetting condition;
    double jod = 10;         // for the average person
    double p_identical = 1;  // the mean over people
    // JOD by the logarithm of contrast sensitivity relative to the average person's, rising in the latter.
    std::vector<std::pair<double, double>> jod_by_log10_sensitivity;
};

// Draws and judges every scene with every condition, in this order. `progress` hears how many of all are done
// and what is next. Throws what drawing throws, and std::runtime_error where the protocol has a procedure
// that chooses the levels.
std::vector<ConditionPrediction> predict_conditions(
    const Protocol& protocol, PictureSource& pictures,
    const std::function<void(int done, const std::string& next)>& progress);

// The share of simulated studies in which Cochran's Q finds an effect of alpha at one sigma (p below 0.05, of
// the chi-square distribution, a block for each person and session), with so many people who answer as
// simulated participants do. Session s shows scene s, where there are fewer scenes from the first again. The
// predictions are those of this sigma.
double share_of_studies_with_alpha_effect(const std::vector<ConditionPrediction>& predictions,
                                          const Protocol& protocol, int people, int studies,
                                          std::uint64_t seed);

// Tables for readers and for scripts (scene, sigma, alpha, jod, p_identical).
std::string predictions_csv(const std::vector<ConditionPrediction>& predictions);
std::string predictions_markdown(const std::vector<ConditionPrediction>& predictions,
                                 const Protocol& protocol, int people, const std::string& machine);

}  // namespace parafovea
