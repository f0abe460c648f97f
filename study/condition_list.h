// The conditions of a protocol: a full crossing of factors, or an explicit list.
#pragma once

#include "study/protocol.h"
#include "study/toml_section.h"

namespace parafovea {

// Reads [conditions] into reference, conditions and factors of the protocol:
//   method = "kfr", reference = "full"
//   [conditions.factors]  sigma = { from = 1.2, to = 2.4, step = 0.2 }, alpha = [1, 2, 3, 4], kernel =
//   ["power", "sine"] [conditions.fixed]    as_printed = true
// or, in place of factors, [[conditions.list]] tables of parameters. "method" may itself be a factor. The
// first factor varies slowest.
void read_conditions(TomlSection& root, Protocol& protocol);

// The numbers from, from + step, ... up to `to`, each the double nearest to its decimal value (so 1.8, not
// 1.8000000000000003). Empty where step does not lead from one end to the other in whole steps.
std::vector<double> stepped_numbers(double from, double to, double step);

}  // namespace parafovea
