// Whether a trial counts, by rules fixed before the session.
#pragma once

#include <string>
#include <vector>

#include "study/protocol.h"
#include "study/trial_record.h"

namespace parafovea {

// The names of the rules that the trial broke, each at most once, in this order: "gaze_off_center",
// "gaze_lost", "gaze_age", "missed_frames", "display_time" (times that do not rise; always applied),
// "unanswered". Gaze is judged by the samples seen during the two intervals; where the tracker fell silent,
// the samples that it would have delivered at its own rate count as lost.
std::vector<std::string> broken_rules(const TrialRecord& record, const Protocol& protocol);

}  // namespace parafovea
