// Powers, logarithms and exponentials of floats that a compiler can vectorise, with stated error bounds.
#pragma once

#include <bit>
#include <cstdint>

namespace parafovea {

// log2 of a normal positive float; absolute error below 2e-7 + 6e-8 |log2 x|.
inline float fast_log2(float x) {
    // Split into 2^exponent and a mantissa in [sqrt(1/2), sqrt(2)).
    const auto bits = std::bit_cast<std::int32_t>(x);
    const std::int32_t offset_bits = bits - 0x3f3504f3;
    const std::int32_t exponent = offset_bits >> 23;
    const float mantissa = std::bit_cast<float>((offset_bits & 0x007fffff) + 0x3f3504f3);
    // ln m = 2 artanh((m - 1) / (m + 1)), its series to the seventh power.
    const float s = (mantissa - 1.0f) / (mantissa + 1.0f);
    const float s2 = s * s;
    const float series = 2.885390082f + s2 * (0.961796694f + s2 * (0.577078016f + s2 * 0.412198583f));
    return static_cast<float>(exponent) + s * series;
}

// 2^x, relative error below 5e-7, clamped to 2^-126 below and 2^127 above.
inline float fast_exp2(float x) {
    x = x < -126.0f ? -126.0f : x;
    x = x > 127.0f ? 127.0f : x;
    // Split into the nearest whole number and a rest in [-1/2, 1/2]; adding 1.5 2^23 rounds.
    const float shifted = x + 12582912.0f;
    const float whole = shifted - 12582912.0f;
    const float f = x - whole;
    const float series =
        1.0f +
        f * (0.693147181f +
             f * (0.240226507f +
                  f * (0.0555041087f + f * (0.00961812911f + f * (0.00133335581f + f * 0.000154035304f)))));
    const std::int32_t exponent_bits = (std::bit_cast<std::int32_t>(shifted) - 0x4b400000 + 127) << 23;
    return series * std::bit_cast<float>(exponent_bits);
}

// x^p for x >= 0 and p > 0; relative error below 1e-5 for results within 1e-30 to 1e30, exactly 0 below x =
// 1e-9.
inline float fast_power(float x, float p) {
    const float safe = x > 1e-9f ? x : 1e-9f;
    const float power = fast_exp2(p * fast_log2(safe));
    return x > 1e-9f ? power : 0.0f;
}

}  // namespace parafovea
