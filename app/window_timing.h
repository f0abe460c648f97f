// On which refresh of the display each frame falls.
#pragma once

#include <cstdint>
#include <span>

#include "devices/time.h"

namespace parafovea {

struct Refresh {
    HostTime time;
    int missed = 0;  // refreshes since the one before, beyond the one expected
};

// The refreshes of a clock, for a display that has none of its own, such as a virtual one.
class PacedRefreshes {
  public:
    // Refresh n is at start + n / hz.
    PacedRefreshes(HostTime start, double hz);

    // The first refresh after the last one given that is not over when a frame is ready. A refresh is over a
    // tenth of a period after it began.
    Refresh next(HostTime ready);

  private:
    HostTime time_of(std::int64_t index) const;

    HostTime start_;
    double hz_;
    std::int64_t last_ = 0;
};

// The refreshes of a real display, followed through the moments at which its swapchain gave pictures back:
// these are late by the scheduler's whim, now and then by whole refreshes, and a crystal drifts.
class ObservedRefreshes {
  public:
    ObservedRefreshes(HostTime first, double hz);

    Refresh next(HostTime observed);

  private:
    double period_ns_;
    double last_ns_ = 0;  // since first_
    HostTime first_;
};

// The rate of events at these times, by the median of their spacing, Hz; 0 for fewer than two.
double median_rate_hz(std::span<const HostTime> times);

// Whether a measured rate is that of a monitor which reports `reported_hz`: a virtual display presents as
// fast as it can, and reports 0.
bool keeps_rate(double measured_hz, double reported_hz);

}  // namespace parafovea
