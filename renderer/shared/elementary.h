// Logarithm, exponential, angle and direction from additions, multiplications and divisions alone, so that
// every device finds the same to a few units in the last place. Vulkan lets sin() and cos() be off by 2^-11,
// atan() by 4096 units, log() near 1 by 2^-21, exp() by more the larger its argument, and pow() by all of
// these: up to 13 pixels on a screen of 16384.
#ifndef PARAFOVEA_ELEMENTARY_H
#define PARAFOVEA_ELEMENTARY_H

#include "bridge.h"

SHARED_BEGIN

const float kMapPi = 3.14159265358979f;

// ln(x), to 1e-7 of its value or of 1, whichever is larger; x above 1e-37, less counts as that.
SHARED_FUNCTION float natural_log(float x) {
    int bits = bits_of(max(x, 1e-37f));
    int exponent = (bits - 0x3f3504f3) >> 23;  // x = m 2^exponent with m from sqrt(1/2) to sqrt(2)
    float t = float_of(bits - (exponent << 23)) - 1.0f;
    // ln(1 + t) = t - t^2 / 2 + t^3 p(t); p fitted to 7e-9.
    float s = t * t;
    float p = (0.0867657885f * s + (-0.1437558830f * t + 0.1497458369f)) * (s * s) +
              ((-0.1656478643f * t + 0.1995530576f) * s + (-0.2500169277f * t + 0.3333415091f));
    float e = float(exponent);
    // ln 2 in two parts, the first of few digits, so that its multiples are exact (Cody and Waite 1980).
    return ((p * t * s - 0.5f * s + e * -2.12194440e-4f) + t) + e * 0.693359375f;
}

// e^x, to 1e-7 of its value; x from -87 to 88, what is beyond counts as that.
SHARED_FUNCTION float natural_exp(float x) {
    float limited = clamp(x, -87.0f, 88.0f);
    float n = floor(limited * 1.44269504f + 0.5f);
    float f = (limited - n * 0.693359375f) - n * -2.12194440e-4f;
    // e^f = 1 + f + f^2 p(f); p fitted to 3e-9.
    float p = 0.0013950464f;
    p = p * f + 0.0083688758f;
    p = p * f + 0.0416662060f;
    p = p * f + 0.1666651964f;
    p = p * f + 0.5f;
    return ((p * (f * f) + f) + 1.0f) * float_of((int(n) + 127) << 23);
}

// x^a for x from 0 to 1 and a above 0.
SHARED_FUNCTION float power_of(float x, float a) {
    return x <= 0.0f ? 0.0f : natural_exp(a * natural_log(x));
}

// sqrt(x), to 1e-7 of its value: one step of Newton's from what a device finds, which may be off by 4.5
// units.
SHARED_FUNCTION float root_of(float x) {
    float r = sqrt(x);
    return r - (r * r - x) * (0.5f / max(r, 1e-18f));
}

// arctan(x) for x in [0, 1], to 2e-8 (Abramowitz and Stegun 1964, 4.4.49).
SHARED_FUNCTION float arctan_unit(float x) {
    float s = x * x;
    float s2 = s * s;
    float p = ((0.0028662257f * s - 0.0161657367f) * s2 + (0.0429096138f * s - 0.0752896400f)) * (s2 * s2) +
              ((0.1065626393f * s - 0.1420889944f) * s2 + (0.1999355085f * s - 0.3333314528f));
    return x + x * s * p;
}

// (cos, sin) of an angle given in turns, to 1e-7.
SHARED_FUNCTION vec2 unit_vector(float turns) {
    float quarter = floor(turns * 4.0f + 0.5f);
    float x = (turns - quarter * 0.25f) * (2.0f * kMapPi);
    float s = x * x;
    float sine =
        x *
        (1.0f + s * (-1.0f / 6.0f + s * (1.0f / 120.0f + s * (-1.0f / 5040.0f + s * (1.0f / 362880.0f)))));
    float cosine = 1.0f + s * (-0.5f + s * (1.0f / 24.0f + s * (-1.0f / 720.0f + s * (1.0f / 40320.0f))));
    float turn_quarter = quarter - 4.0f * floor(quarter * 0.25f);
    if (turn_quarter < 0.5f) return vec2(cosine, sine);
    if (turn_quarter < 1.5f) return vec2(-sine, cosine);
    if (turn_quarter < 2.5f) return vec2(-cosine, -sine);
    return vec2(sine, -cosine);
}

// arcsin(y) for y in [0, 1], in quarter turns, to 1e-7.
SHARED_FUNCTION float arcsine_quarters(float y) {
    float cosine = sqrt((1.0f - y) * (1.0f + y));
    if (y <= cosine) return arctan_unit(y / cosine) * (2.0f / kMapPi);
    return 1.0f - arctan_unit(cosine / y) * (2.0f / kMapPi);
}

// The angle of (x, y) in turns, in [0, 1); 0 for the zero vector.
SHARED_FUNCTION float turns_of(float x, float y) {
    float ax = abs(x);
    float ay = abs(y);
    float larger = max(ax, ay);
    if (larger <= 0.0f) return 0.0f;
    float turns = arctan_unit(min(ax, ay) / larger) * (0.5f / kMapPi);
    if (ay > ax) turns = 0.25f - turns;
    if (x < 0.0f) turns = 0.5f - turns;
    if (y < 0.0f) turns = 1.0f - turns;
    return turns >= 1.0f ? 0.0f : turns;
}

SHARED_END

#endif
