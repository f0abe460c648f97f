// From a participant's pseudonym to the row of the counterbalancing square.
#pragma once

#include <string>

namespace parafovea {

// The number at the end of the pseudonym less one: "P01" is participant 0, "site2-17" is participant 16.
// Throws std::runtime_error where the pseudonym does not end in a number above 0 or holds other characters
// than letters, digits, '-' and '_'.
int participant_index(const std::string& id);

}  // namespace parafovea
