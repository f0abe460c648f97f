// Lets one header be read by C++ and by GLSL. Shared headers use scalars, vec2(x, y), plain structs and
// functions that return by value; they write `f` on literals and use neither swizzles nor out parameters.
#ifndef PARAFOVEA_BRIDGE_H
#define PARAFOVEA_BRIDGE_H

#ifdef __cplusplus

#include <bit>
#include <cmath>
#include <cstdint>

#define SHARED_BEGIN      \
    namespace parafovea { \
    namespace shared {
#define SHARED_END \
    }              \
    }
#define SHARED_FUNCTION inline

namespace parafovea {
namespace shared {

using uint = std::uint32_t;
using std::abs;
using std::ceil;
using std::exp;
using std::floor;
using std::log;
using std::pow;
using std::sqrt;

struct vec2 {
    float x, y;
    constexpr vec2(float x_, float y_) : x(x_), y(y_) {}
    constexpr vec2() : x(0), y(0) {}
};

struct alignas(16) vec4 {
    float x, y, z, w;
};

struct alignas(16) mat4 {
    float columns[16];
};

// The bits of a float as a whole number, and back.
inline int bits_of(float x) {
    return std::bit_cast<int>(x);
}
inline float float_of(int bits) {
    return std::bit_cast<float>(bits);
}

inline float min(float a, float b) {
    return a < b ? a : b;
}
inline float max(float a, float b) {
    return a > b ? a : b;
}
inline float clamp(float x, float low, float high) {
    return min(max(x, low), high);
}

}  // namespace shared
}  // namespace parafovea

#else

#define SHARED_BEGIN
#define SHARED_END
#define SHARED_FUNCTION

int bits_of(float x) {
    return floatBitsToInt(x);
}
float float_of(int bits) {
    return intBitsToFloat(bits);
}

#endif

#endif
