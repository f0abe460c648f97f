// How well the plans of a group of participants balance conditions, intervals, scenes and validation trials.
#pragma once

#include <cstdint>
#include <iosfwd>

#include "study/protocol.h"

namespace parafovea {

// A report in plain text over the participants with the indices first to last (from 0, both included), all
// with one seed: for each session how often each condition comes at each position and is followed by each
// other, how often the reference comes first, the share of validation trials, and which scene comes how
// often.
void write_balance_report(std::ostream& out, const Protocol& protocol, int first, int last,
                          std::uint64_t seed);

}  // namespace parafovea
