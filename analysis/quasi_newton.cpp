// Minimises a smooth function of a few numbers by its slope (Broyden, Fletcher, Goldfarb and Shanno 1970).
#include "analysis/quasi_newton.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace parafovea {
namespace {

constexpr int kMostSteps = 200;
constexpr double kLongestStep = 1.0;     // of any number: all are of order one
constexpr double kFirstStep = 0.1;       // before anything is known of the curvature
constexpr double kLeastDecrease = 1e-4;  // of what the slope promises (Armijo 1966)

double dot(std::span<const double> a, std::span<const double> b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

double largest(std::span<const double> values) {
    double size = 0.0;
    for (double value : values) size = std::max(size, std::abs(value));
    return size;
}

// What the slopes along the way tell of the inverse of the matrix of second derivatives.
class InverseCurvature {
  public:
    explicit InverseCurvature(std::size_t size) : size_(size), rows_(size * size), product_(size) {}

    void reset(double scale) {
        std::fill(rows_.begin(), rows_.end(), 0.0);
        for (std::size_t i = 0; i < size_; ++i) rows_[i * size_ + i] = scale;
        learnt_ = false;
    }

    void multiply(std::span<const double> vector, std::span<double> result) const {
        for (std::size_t i = 0; i < size_; ++i) result[i] = dot({rows_.data() + i * size_, size_}, vector);
    }

    // A step and by how much it changed the slope.
    void learn(std::span<const double> step, std::span<const double> change) {
        const double curvature = dot(step, change);
        if (!(curvature > 1e-12 * std::sqrt(dot(step, step) * dot(change, change)))) return;
        if (!learnt_) reset(curvature / dot(change, change));
        learnt_ = true;
        multiply(change, product_);
        const double along = (1.0 + dot(change, product_) / curvature) / curvature;
        for (std::size_t i = 0; i < size_; ++i)
            for (std::size_t j = 0; j < size_; ++j)
                rows_[i * size_ + j] +=
                    along * step[i] * step[j] - (product_[i] * step[j] + step[i] * product_[j]) / curvature;
    }

    bool learnt() const { return learnt_; }

  private:
    std::size_t size_;
    std::vector<double> rows_, product_;
    bool learnt_ = false;
};

}  // namespace

Minimum quasi_newton(const SlopedFunction& function, std::span<const double> start, double tolerance) {
    const std::size_t size = start.size();
    assert(size > 0);
    Minimum best{{start.begin(), start.end()}, 0.0};
    std::vector<double> slope(size), direction(size), place(size), next_slope(size);
    best.value = function(best.at, slope);
    assert(std::isfinite(best.value));
    InverseCurvature inverse(size);
    inverse.reset(kFirstStep / std::max(largest(slope), 1e-300));

    for (int steps = 0; steps < kMostSteps; ++steps) {
        inverse.multiply(slope, direction);
        double promised = dot(slope, direction);
        if (!(promised > 0.0)) break;
        // Half of it is what a step to the bottom of a bowl gains; the first direction knows no bowl.
        if (inverse.learnt() && 0.5 * promised < tolerance) break;
        double length = std::min(1.0, kLongestStep / largest(direction));

        // Shorten the step, to the lowest point of the parabola through what is known, until it goes down.
        double value = 0.0;
        bool found = false;
        for (int tries = 0; tries < 30 && !found; ++tries) {
            for (std::size_t i = 0; i < size; ++i) place[i] = best.at[i] - length * direction[i];
            value = function(place, next_slope);
            found = value <= best.value - kLeastDecrease * length * promised;
            if (found) break;
            const double rise = value - best.value + length * promised;
            const double shorter = 0.5 * length * length * promised / rise;
            length = std::isfinite(shorter) ? std::clamp(shorter, 0.1 * length, 0.5 * length) : 0.25 * length;
        }
        if (!found) break;

        for (std::size_t i = 0; i < size; ++i) {
            direction[i] = place[i] - best.at[i];
            slope[i] = next_slope[i] - slope[i];
        }
        inverse.learn(direction, slope);
        best.at.swap(place);
        best.value = value;
        slope.swap(next_slope);
    }
    return best;
}

}  // namespace parafovea
