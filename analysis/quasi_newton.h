// Minimises a smooth function of a few numbers by its slope (Broyden, Fletcher, Goldfarb and Shanno 1970).
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace parafovea {

struct Minimum {
    std::vector<double> at;
    double value = 0.0;
};

// The function returns its value at a place and writes its slope there; infinity where it is not defined,
// the slope then does not matter. Starts where it is defined and goes downhill, never up; stops when the step
// ahead would lower the value by less than `tolerance`, or none can be found that lowers it.
using SlopedFunction = std::function<double(std::span<const double> at, std::span<double> slope)>;
Minimum quasi_newton(const SlopedFunction& function, std::span<const double> start, double tolerance);

}  // namespace parafovea
