// Adaptive procedures in a session: which level comes next for each condition.
#pragma once

#include <optional>
#include <vector>

#include "study/protocol.h"
#include "study/session_log.h"
#include "study/trial_plan.h"

namespace parafovea {

// The level at which to show a planned trial: a pure function of what was shown. Each condition of each
// testing session has a procedure of its own, which learns from that condition's answers in that session, in
// the order shown; "different" is the positive answer. Invalid, interrupted and superseded showings teach
// nothing. A training trial is shown at the procedure's first level. Nothing for a validation trial, and
// where the protocol has no procedure.
std::optional<double> adaptive_level(const Protocol& protocol, const TrialPlan& plan,
                                     const std::vector<ShownTrial>& shown, const PlannedTrial& trial);

// The trial with the level filled in where it shows something else than the reference.
PlannedTrial at_level(PlannedTrial trial, const Protocol& protocol, std::optional<double> level);

}  // namespace parafovea
