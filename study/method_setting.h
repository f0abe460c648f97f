// How a stimulus is rendered: a method's name and its parameters, as a protocol writes them and the log
// stores them.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace parafovea {

// Parameters by name. The study does not interpret them: the renderer's method of that name does, and rejects
// what it does not know. Conventions:
//   numbers   every numeric parameter, in the unit its name says ("sigma", "alpha", "inner_deg"); switches
//   are 0 or 1
//             ("as_printed"); the coefficients of a polynomial kernel are "beta_1", "beta_2", ...
//   words     every parameter chosen from a list ("kernel" = "power" | "polynomial" | "sine" | "exponential"
//   ...)
// A parameter that is absent has the method's default.
struct MethodSetting {
    std::string method = "full";  // "full" is full resolution, the reference of every comparison
    std::map<std::string, double> numbers;
    std::map<std::string, std::string> words;

    bool operator==(const MethodSetting&) const = default;
};

// The canonical text, the same for equal settings and only for them, used in logs, tables and as a cache key:
// "full", "kfr(alpha=4,kernel=power,sigma=1.8)". Names in alphabetical order, numbers in the shortest form
// that reads back to the same double.
std::string to_text(const MethodSetting& setting);

// The inverse of to_text. Throws std::runtime_error where the text is not one that to_text writes.
MethodSetting parse_method_setting(std::string_view text);

}  // namespace parafovea
