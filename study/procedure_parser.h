// Reads [procedure] of a protocol.
#pragma once

#include "study/protocol.h"
#include "study/toml_section.h"

namespace parafovea {

//   kind = "staircase", parameter = "sigma", levels = { from = 1.2, to = 2.4, step = 0.1 }, trials = 30,
//   start = 2.4, down_after = 2, step_up = 1, step_down = 1                          (steps in levels)
// or
//   kind = "quest_plus", shape = "normal" | "weibull_db", thresholds, slopes, guesses, lapses: a range or a
//   list each
// `trials` is how many each condition gets in a session; it takes the place of design.repetitions.
void read_procedure(TomlSection& root, Protocol& protocol);

}  // namespace parafovea
