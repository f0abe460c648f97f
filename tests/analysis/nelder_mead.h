// An oracle: minimises a function of a few numbers without its slope (Nelder and Mead 1965).
#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "analysis/quasi_newton.h"

namespace parafovea {

// Starts from a simplex of the given step around start and stops when the values at its corners agree to
// tolerance and their places to 1e-7 in every number, or after so many evaluations. The function may return
// any large number where it is not defined. Best restarted from its own answer.
inline Minimum nelder_mead(const std::function<double(std::span<const double>)>& function,
                           std::span<const double> start, double step, double tolerance = 1e-10,
                           int evaluations = 2000) {
    const std::size_t dimensions = start.size();
    assert(dimensions > 0);
    std::vector<Minimum> corners;
    for (std::size_t i = 0; i <= dimensions; ++i) {
        Minimum corner{{start.begin(), start.end()}, 0.0};
        if (i > 0) corner.at[i - 1] += step;
        corner.value = function(corner.at);
        corners.push_back(std::move(corner));
    }
    int used = static_cast<int>(dimensions) + 1;
    const auto by_value = [](const Minimum& a, const Minimum& b) { return a.value < b.value; };
    std::vector<double> centre(dimensions);
    const auto along = [&](double distance) {  // from the worst corner through the centre of the others
        Minimum point{std::vector<double>(dimensions), 0.0};
        for (std::size_t j = 0; j < dimensions; ++j)
            point.at[j] = centre[j] + distance * (centre[j] - corners.back().at[j]);
        point.value = function(point.at);
        ++used;
        return point;
    };
    while (used < evaluations) {
        std::sort(corners.begin(), corners.end(), by_value);
        if (corners.back().value - corners.front().value < tolerance) {
            double size = 0.0;
            for (std::size_t j = 0; j < dimensions; ++j)
                size = std::max(size, std::abs(corners.back().at[j] - corners.front().at[j]));
            if (size < 1e-7) break;
        }
        std::fill(centre.begin(), centre.end(), 0.0);
        for (std::size_t i = 0; i < dimensions; ++i)
            for (std::size_t j = 0; j < dimensions; ++j)
                centre[j] += corners[i].at[j] / static_cast<double>(dimensions);
        Minimum reflected = along(1.0);
        if (reflected.value < corners.front().value) {
            Minimum expanded = along(2.0);
            corners.back() = expanded.value < reflected.value ? std::move(expanded) : std::move(reflected);
        } else if (reflected.value < corners[dimensions - 1].value) {
            corners.back() = std::move(reflected);
        } else {
            const bool outside = reflected.value < corners.back().value;
            Minimum contracted = along(outside ? 0.5 : -0.5);
            if (contracted.value < std::min(reflected.value, corners.back().value)) {
                corners.back() = std::move(contracted);
            } else {
                for (std::size_t i = 1; i <= dimensions; ++i) {
                    for (std::size_t j = 0; j < dimensions; ++j)
                        corners[i].at[j] = 0.5 * (corners[i].at[j] + corners[0].at[j]);
                    corners[i].value = function(corners[i].at);
                    ++used;
                }
            }
        }
    }
    return *std::min_element(corners.begin(), corners.end(), by_value);
}

}  // namespace parafovea
