// Collects a condition's answers and asks its procedure.
#include "study/adaptive.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace parafovea {
namespace {

struct AnswerAtLevel {
    double level = 0;
    bool different = false;
};

std::vector<AnswerAtLevel> answers_of(const TrialPlan& plan, const std::vector<ShownTrial>& shown,
                                      const PlannedTrial& trial) {
    std::vector<AnswerAtLevel> answers;
    for (const ShownTrial& earlier : shown) {
        const PlannedTrial& planned = plan.trials[static_cast<std::size_t>(earlier.number)];
        const bool same_track = planned.session == trial.session && planned.condition == trial.condition;
        const bool teaches =
            earlier.answered && earlier.valid && !earlier.interrupted && !earlier.superseded && earlier.level;
        if (same_track && teaches) answers.push_back({*earlier.level, !earlier.identical});
    }
    return answers;
}

double staircase_level(const Staircase& staircase, const std::vector<AnswerAtLevel>& answers) {
    std::vector<bool> positive;
    for (const AnswerAtLevel& answer : answers) positive.push_back(answer.different);
    return staircase.levels[static_cast<std::size_t>(staircase_track(staircase, positive).back())];
}

double quest_level(const QuestPlus& quest, const std::vector<AnswerAtLevel>& answers) {
    std::vector<QuestPlusTrial> trials;
    for (const AnswerAtLevel& answer : answers) {
        const auto at = std::find(quest.levels.begin(), quest.levels.end(), answer.level);
        assert(at != quest.levels.end());
        trials.push_back({static_cast<int>(at - quest.levels.begin()), answer.different});
    }
    return quest.levels[static_cast<std::size_t>(quest_plus_next(quest, trials))];
}

}  // namespace

std::optional<double> adaptive_level(const Protocol& protocol, const TrialPlan& plan,
                                     const std::vector<ShownTrial>& shown, const PlannedTrial& trial) {
    if (!protocol.procedure || trial.kind == TrialKind::validation) return std::nullopt;
    const std::vector<AnswerAtLevel> answers =
        trial.kind == TrialKind::training ? std::vector<AnswerAtLevel>() : answers_of(plan, shown, trial);
    const Procedure& procedure = *protocol.procedure;
    return procedure.quest_plus ? quest_level(*procedure.quest_plus, answers)
                                : staircase_level(procedure.staircase, answers);
}

PlannedTrial at_level(PlannedTrial trial, const Protocol& protocol, std::optional<double> level) {
    if (!level) return trial;
    (trial.reference_interval == 0 ? trial.second : trial.first).numbers[protocol.procedure->parameter] =
        *level;
    return trial;
}

}  // namespace parafovea
