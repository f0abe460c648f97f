// Which sessions the analysis leaves out, by the rules their protocol fixed before they were run.
#pragma once

#include <string>
#include <vector>

#include "study/session_log_reader.h"

namespace parafovea {

// One line for each rule that a session breaks, with the numbers; empty where it is to be analysed. Shares
// are of the trials that were answered (validation) or planned in the sessions begun (invalid).
std::vector<std::string> exclusion_reasons(const SessionRows& rows, const ExclusionRules& rules);

}  // namespace parafovea
