// Host time, device time and durations as three types that cannot be mixed by accident.
#pragma once

#include <compare>
#include <cstdint>

namespace parafovea {

// A span of time in nanoseconds.
struct Duration {
    std::int64_t ns = 0;

    static constexpr Duration from_seconds(double seconds) {
        return {static_cast<std::int64_t>(seconds * 1e9 + (seconds < 0 ? -0.5 : 0.5))};
    }
    static constexpr Duration from_ms(double ms) { return from_seconds(ms * 1e-3); }
    constexpr double seconds() const { return static_cast<double>(ns) * 1e-9; }
    constexpr double ms() const { return static_cast<double>(ns) * 1e-6; }

    constexpr auto operator<=>(const Duration&) const = default;
};

constexpr Duration operator+(Duration a, Duration b) {
    return {a.ns + b.ns};
}
constexpr Duration operator-(Duration a, Duration b) {
    return {a.ns - b.ns};
}
constexpr Duration operator*(Duration a, std::int64_t n) {
    return {a.ns * n};
}

// A moment on the host's monotonic clock, nanoseconds since that clock's own epoch.
struct HostTime {
    std::int64_t ns = 0;

    constexpr auto operator<=>(const HostTime&) const = default;
};

constexpr Duration operator-(HostTime a, HostTime b) {
    return {a.ns - b.ns};
}
constexpr HostTime operator+(HostTime a, Duration b) {
    return {a.ns + b.ns};
}
constexpr HostTime operator-(HostTime a, Duration b) {
    return {a.ns - b.ns};
}

// A moment on a device's own clock, nanoseconds since that clock's own epoch; comparable to host time only
// through a clock mapping, and never altered.
struct DeviceTime {
    std::int64_t ns = 0;

    constexpr auto operator<=>(const DeviceTime&) const = default;
};

constexpr Duration operator-(DeviceTime a, DeviceTime b) {
    return {a.ns - b.ns};
}
constexpr DeviceTime operator+(DeviceTime a, Duration b) {
    return {a.ns + b.ns};
}

}  // namespace parafovea
