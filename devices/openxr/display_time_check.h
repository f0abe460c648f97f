// Whether the display times that a headset's runtime predicts can be believed. Some runtimes return negative
// times, or times that run backwards, without calling it an error.
#pragma once

#include <string_view>

#include "devices/time.h"

namespace parafovea {

enum class DisplayTimeFault {
    none,
    not_positive,  // zero or negative
    backwards,     // not after the last believable one
    far_ahead,     // more than ten seconds from now
};

// "", "display_time_not_positive", "display_time_backwards" or "display_time_far_ahead".
std::string_view name_of(DisplayTimeFault fault);

struct CheckedDisplayTime {
    DeviceTime time;  // the predicted one, or where that cannot be believed one period after the last
    DisplayTimeFault fault = DisplayTimeFault::none;
    int missed_refreshes = 0;  // between the last frame's time and this one
};

// Keeps the times of one display, in order. A period that is not positive counts as the last good one.
class DisplayTimeCheck {
  public:
    // `now` is on the same clock as `predicted`.
    CheckedDisplayTime check(DeviceTime predicted, Duration period, DeviceTime now);

  private:
    bool any_ = false;
    DeviceTime last_believed_, last_used_;
    Duration period_{1'000'000'000 / 60};
};

}  // namespace parafovea
