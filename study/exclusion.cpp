// Counts failed validation trials and trials without a valid answer.
#include "study/exclusion.h"

#include <cstdio>
#include <set>

namespace parafovea {
namespace {

std::string reason(const char* what, int count, int all, double allowed) {
    char text[160];
    std::snprintf(text, sizeof text, "%d of %d %s, %.3g %% allowed", count, all, what, allowed * 100);
    return text;
}

}  // namespace

std::vector<std::string> exclusion_reasons(const SessionRows& rows, const ExclusionRules& rules) {
    int validation = 0, failed = 0;
    std::set<int> sessions_begun, with_answer;
    for (const TrialRow& trial : rows.trials) {
        sessions_begun.insert(trial.planned.session);
        if (!trial.counts()) continue;
        with_answer.insert(trial.planned.number);
        if (trial.planned.kind != TrialKind::validation) continue;
        ++validation;
        if (!trial.answer->identical) ++failed;
    }
    int conditions = 0, without = 0;
    for (const PlannedTrial& planned : rows.plan.trials) {
        if (planned.kind != TrialKind::condition || !sessions_begun.contains(planned.session)) continue;
        ++conditions;
        if (!with_answer.contains(planned.number)) ++without;
    }
    std::vector<std::string> reasons;
    if (rules.failed_validation_share && failed > *rules.failed_validation_share * validation)
        reasons.push_back(
            reason("validation trials failed", failed, validation, *rules.failed_validation_share));
    if (rules.invalid_trial_share && without > *rules.invalid_trial_share * conditions)
        reasons.push_back(reason("condition trials without a valid answer", without, conditions,
                                 *rules.invalid_trial_share));
    return reasons;
}

}  // namespace parafovea
