// Minimises a function of a few numbers without derivatives (Nelder and Mead 1965).
#pragma once

#include <functional>
#include <span>
#include <vector>

namespace parafovea {

struct Minimum {
    std::vector<double> at;
    double value = 0.0;
};

// Starts from a simplex of the given step around start and stops when the values at its corners agree to
// tolerance and their places to `precision` in every number, or after so many evaluations. The function may
// return any large number where it is not defined. Best restarted from its own answer.
Minimum nelder_mead(const std::function<double(std::span<const double>)>& function,
                    std::span<const double> start, double step, double tolerance = 1e-10,
                    int evaluations = 2000, double precision = 1e-7);

}  // namespace parafovea
