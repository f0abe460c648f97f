// Running summaries that need no list of all values.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

namespace parafovea {

// Mean and variance as values stream past (Welford 1962).
class RunningMoments {
  public:
    void add(double value) {
        ++n_;
        const double off = value - mean_;
        mean_ += off / static_cast<double>(n_);
        squares_ += off * (value - mean_);
    }
    std::int64_t n() const { return n_; }
    double mean() const { return mean_; }
    double sum_of_squares() const { return squares_; }  // about the mean
    std::optional<double> sd() const {
        return n_ < 2 ? std::nullopt : std::optional(std::sqrt(squares_ / static_cast<double>(n_ - 1)));
    }

  private:
    std::int64_t n_ = 0;
    double mean_ = 0.0;
    double squares_ = 0.0;
};

}  // namespace parafovea
