// Keeps the simulated headset's refresh rate.
#include "tests/openxr_runtime/timeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

namespace parafovea::headset {

namespace {

// libstdc++'s steady clock is CLOCK_MONOTONIC.
XrTime monotonic_now() {
    return time_from_host(
        std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count());
}

}  // namespace

Timeline::Timeline(bool simulated, double refresh_hz) : simulated_(simulated), refresh_hz_(refresh_hz) {
    simulated_now_ = time_from_host(1'000'000'000);
    start_ = now();
}

XrTime Timeline::now() const {
    return simulated_ ? simulated_now_ : monotonic_now();
}

XrDuration Timeline::period() const {
    return std::llround(1e9 / refresh_hz_);
}

void Timeline::set_refresh_hz(double hz) {
    start_ = now();
    last_ = -1;
    refresh_hz_ = hz;
}

// From the start and not from the last one, so that rounding never adds up.
XrTime Timeline::refresh_time(std::int64_t index) const {
    return start_ + std::llround(static_cast<double>(index) * 1e9 / refresh_hz_);
}

Refresh Timeline::choose_refresh(std::int64_t late) {
    const auto passed = static_cast<std::int64_t>(static_cast<double>(now() - start_) * 1e-9 * refresh_hz_);
    std::int64_t next = std::max(last_, passed) + 1;
    if (simulated_ && last_ < 0) next = 1;
    last_ = next + late;
    return {refresh_time(last_), refresh_time(last_ + 1)};
}

void Timeline::wait_until(XrTime time) {
    if (simulated_) {
        simulated_now_ = std::max(simulated_now_, time);
        return;
    }
    std::this_thread::sleep_until(
        std::chrono::steady_clock::time_point(std::chrono::nanoseconds(host_from_time(time))));
}

}  // namespace parafovea::headset
