// In the place of renderer/shared/bridge.h: lets the shared maps run as on the least accurate device that
// Vulkan allows. Divisions, square roots, logarithms and exponentials err by the whole of what the
// specification grants ("Vulkan Environment for SPIR-V", Precision of core instructions), up or down as a
// hash of their arguments says; additions and multiplications are exact to rounding, as they must be.
// Included by worst_device.cpp alone.
#ifndef PARAFOVEA_BRIDGE_H
#define PARAFOVEA_BRIDGE_H

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#define SHARED_BEGIN                \
    namespace parafovea {           \
    inline namespace worst_device { \
    namespace shared {
#define SHARED_END \
    }              \
    }              \
    }
#define SHARED_FUNCTION inline

namespace parafovea {
inline namespace worst_device {
namespace shared {

using uint = std::uint32_t;

// 1 or -1, as good as at random.
inline double sign_of(float a, float b, std::uint32_t operation) {
    std::uint32_t h = std::bit_cast<std::uint32_t>(a) * 0x9e3779b1u ^
                      std::bit_cast<std::uint32_t>(b) * 0x85ebca6bu ^ operation * 0xc2b2ae35u;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 13;
    return (h & 1u) != 0 ? 1.0 : -1.0;
}

// A result that is off by so many units in the last place.
inline float off_by(double exact, double units, double sign) {
    if (!std::isfinite(exact) || exact == 0) return static_cast<float>(exact);
    const float near = std::abs(static_cast<float>(exact));
    const double unit = static_cast<double>(std::nextafter(near, INFINITY)) - static_cast<double>(near);
    return static_cast<float>(exact + sign * units * unit);
}

struct DeviceFloat {
    float value;

    constexpr DeviceFloat() : value(0) {}
    constexpr DeviceFloat(float v) : value(v) {}
    explicit constexpr DeviceFloat(int v) : value(static_cast<float>(v)) {}
    explicit constexpr DeviceFloat(uint v) : value(static_cast<float>(v)) {}
    explicit constexpr operator int() const { return static_cast<int>(value); }
    explicit constexpr operator uint() const { return static_cast<uint>(value); }

    constexpr DeviceFloat operator-() const { return DeviceFloat(-value); }
    friend constexpr DeviceFloat operator+(DeviceFloat a, DeviceFloat b) {
        return DeviceFloat(a.value + b.value);
    }
    friend constexpr DeviceFloat operator-(DeviceFloat a, DeviceFloat b) {
        return DeviceFloat(a.value - b.value);
    }
    friend constexpr DeviceFloat operator*(DeviceFloat a, DeviceFloat b) {
        return DeviceFloat(a.value * b.value);
    }
    friend DeviceFloat operator/(DeviceFloat a, DeviceFloat b) {
        return DeviceFloat(off_by(static_cast<double>(a.value) / static_cast<double>(b.value), 2.5,
                                  sign_of(a.value, b.value, 1)));
    }
    friend constexpr bool operator<(DeviceFloat a, DeviceFloat b) { return a.value < b.value; }
    friend constexpr bool operator<=(DeviceFloat a, DeviceFloat b) { return a.value <= b.value; }
    friend constexpr bool operator>(DeviceFloat a, DeviceFloat b) { return a.value > b.value; }
    friend constexpr bool operator>=(DeviceFloat a, DeviceFloat b) { return a.value >= b.value; }
};

struct vec2 {
    DeviceFloat x, y;
    constexpr vec2(DeviceFloat x_, DeviceFloat y_) : x(x_), y(y_) {}
    constexpr vec2() = default;
};
struct alignas(16) vec4 {
    DeviceFloat x, y, z, w;
};

inline int bits_of(DeviceFloat x) {
    return std::bit_cast<int>(x.value);
}
inline DeviceFloat float_of(int bits) {
    return DeviceFloat(std::bit_cast<float>(bits));
}
inline DeviceFloat abs(DeviceFloat x) {
    return DeviceFloat(std::abs(x.value));
}
inline DeviceFloat floor(DeviceFloat x) {
    return DeviceFloat(std::floor(x.value));
}
inline DeviceFloat min(DeviceFloat a, DeviceFloat b) {
    return b < a ? b : a;
}
inline DeviceFloat max(DeviceFloat a, DeviceFloat b) {
    return b > a ? b : a;
}
inline DeviceFloat clamp(DeviceFloat x, DeviceFloat low, DeviceFloat high) {
    return min(max(x, low), high);
}

// sqrt(x) inherits from 1 / inversesqrt(x): 2 units, and a division's 2.5.
inline DeviceFloat sqrt(DeviceFloat x) {
    return DeviceFloat(off_by(std::sqrt(static_cast<double>(x.value)), 4.5, sign_of(x.value, 0, 2)));
}
// 3 units outside [0.5, 2], 2^-21 inside.
inline float worst_log2(float x) {
    const double exact = std::log2(static_cast<double>(x));
    const double sign = sign_of(x, 0, 3);
    return x >= 0.5f && x <= 2.0f ? static_cast<float>(exact + sign * 0x1p-21) : off_by(exact, 3, sign);
}
// 3 + 2 |x| units.
inline float worst_exp2(float x) {
    return off_by(std::exp2(static_cast<double>(x)), 3 + 2 * std::abs(static_cast<double>(x)),
                  sign_of(x, 0, 4));
}
inline DeviceFloat log(DeviceFloat x) {
    return DeviceFloat(worst_log2(x.value) * 0.693147181f);
}
inline DeviceFloat exp(DeviceFloat x) {
    return DeviceFloat(worst_exp2(x.value * 1.44269504f));
}
inline DeviceFloat pow(DeviceFloat x, DeviceFloat y) {
    return DeviceFloat(worst_exp2(y.value * worst_log2(x.value)));
}
// 4096 units.
inline float worst_atan2(float y, float x) {
    return off_by(std::atan2(static_cast<double>(y), static_cast<double>(x)), 4096, sign_of(y, x, 5));
}
// An error of 2^-11 inside [-pi, pi].
inline float worst_cosine(float x) {
    return static_cast<float>(std::cos(static_cast<double>(x)) + sign_of(x, 0, 6) * 0x1p-11);
}
inline float worst_sine(float x) {
    return static_cast<float>(std::sin(static_cast<double>(x)) + sign_of(x, 0, 7) * 0x1p-11);
}

}  // namespace shared
}  // namespace worst_device
}  // namespace parafovea

#endif
