// CLOCK_MONOTONIC through std::chrono.
#include "devices/clock.h"

#include <chrono>
#include <thread>

namespace parafovea {

HostTime SteadyClock::now() {
    const auto since_epoch = std::chrono::steady_clock::now().time_since_epoch();
    return {std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count()};
}

void SteadyClock::wait_until(HostTime time) {
    std::this_thread::sleep_until(std::chrono::steady_clock::time_point(std::chrono::nanoseconds(time.ns)));
}

}  // namespace parafovea
