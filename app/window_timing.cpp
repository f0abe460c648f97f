// Grids of refreshes, by a clock or observed.
#include "app/window_timing.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace parafovea {

namespace {

// Share of an observation's deviation that moves the grid: slow enough to average scheduling jitter, fast
// enough to follow a crystal.
constexpr double kFollow = 0.05;

}  // namespace

PacedRefreshes::PacedRefreshes(HostTime start, double hz) : start_(start), hz_(hz) {}

HostTime PacedRefreshes::time_of(std::int64_t index) const {
    return start_ + Duration::from_seconds(static_cast<double>(index) / hz_);
}

Refresh PacedRefreshes::next(HostTime ready) {
    const double passed = (ready - start_).seconds() * hz_ - 0.1;
    const std::int64_t index = std::max(last_ + 1, static_cast<std::int64_t>(std::ceil(passed)));
    const int missed = static_cast<int>(index - last_ - 1);
    last_ = index;
    return {time_of(index), missed};
}

ObservedRefreshes::ObservedRefreshes(HostTime first, double hz) : period_ns_(1e9 / hz), first_(first) {}

Refresh ObservedRefreshes::next(HostTime observed) {
    const double observed_ns = static_cast<double>((observed - first_).ns);
    const double periods = std::max(1.0, std::round((observed_ns - last_ns_) / period_ns_));
    const double expected_ns = last_ns_ + periods * period_ns_;
    last_ns_ = expected_ns + kFollow * (observed_ns - expected_ns);
    return {first_ + Duration{std::llround(last_ns_)}, static_cast<int>(periods) - 1};
}

double median_rate_hz(std::span<const HostTime> times) {
    std::vector<std::int64_t> spacing;
    for (std::size_t i = 1; i < times.size(); ++i) spacing.push_back((times[i] - times[i - 1]).ns);
    if (spacing.empty()) return 0;
    const auto middle = spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 2);
    std::nth_element(spacing.begin(), middle, spacing.end());
    return 1e9 / static_cast<double>(std::max<std::int64_t>(*middle, 1));
}

bool keeps_rate(double measured_hz, double reported_hz) {
    return reported_hz > 0 && std::abs(measured_hz / reported_hz - 1) < 0.05;
}

}  // namespace parafovea
