// Checks predicted display times.
#include "devices/openxr/display_time_check.h"

#include <algorithm>
#include <cmath>

namespace parafovea {

std::string_view name_of(DisplayTimeFault fault) {
    switch (fault) {
        case DisplayTimeFault::none:
            return "";
        case DisplayTimeFault::not_positive:
            return "display_time_not_positive";
        case DisplayTimeFault::backwards:
            return "display_time_backwards";
        case DisplayTimeFault::far_ahead:
            return "display_time_far_ahead";
    }
    return "";
}

CheckedDisplayTime DisplayTimeCheck::check(DeviceTime predicted, Duration period, DeviceTime now) {
    constexpr Duration kFarAhead{10'000'000'000};
    if (period.ns > 0) period_ = period;

    CheckedDisplayTime checked{predicted, DisplayTimeFault::none, 0};
    if (predicted.ns <= 0) {
        checked.fault = DisplayTimeFault::not_positive;
    } else if (any_ && predicted <= last_believed_) {
        checked.fault = DisplayTimeFault::backwards;
    } else if (any_ && predicted - now > kFarAhead) {
        checked.fault = DisplayTimeFault::far_ahead;
    }

    if (checked.fault != DisplayTimeFault::none) {
        checked.time = (any_ ? last_used_ : now) + period_;
    } else {
        last_believed_ = predicted;
        if (any_) {
            const double periods =
                static_cast<double>((predicted - last_used_).ns) / static_cast<double>(period_.ns);
            checked.missed_refreshes = std::max(0, static_cast<int>(std::lround(std::min(periods, 1e9))) - 1);
        }
    }
    any_ = true;
    last_used_ = std::max(checked.time, last_used_);
    checked.time = last_used_;
    return checked;
}

}  // namespace parafovea
