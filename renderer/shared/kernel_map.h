// The kernel log-polar map between screen and reduced buffer; the one place where its mathematics stands.
// Meng, Du, Zwicker, Varshney 2018, "Kernel Foveated Rendering", Eqs. 9 to 13 and Algorithms 1 and 2.
//
// Author orientation (default):  u / w = K(ln r / L)        r = exp(L * K^-1(u / w))
// As printed in Eq. 10:          u / w = K^-1(ln r / L)     r = exp(L * K(u / w))
// Both:                          v / h = theta / 2 pi, theta in [0, 2 pi) from +x towards +y (down).
//
// Screen positions are pixels from the top left corner, pixel (i, j) centred at (i + 0.5, j + 0.5). Buffer
// positions are texels, texel (a, b) centred at (a + 0.5, b + 0.5); the buffer wraps in v and clamps in u.
#ifndef PARAFOVEA_KERNEL_MAP_H
#define PARAFOVEA_KERNEL_MAP_H

#include "bridge.h"
#include "elementary.h"

SHARED_BEGIN

const uint kKernelPower = 0u;        // x^alpha
const uint kKernelPolynomial = 1u;   // beta_1 x + ... + beta_8 x^8, the betas adding up to 1 (Eq. 9)
const uint kKernelSine = 2u;         // sin(x pi / 2)
const uint kKernelExponential = 3u;  // (e^x - 1) / (e - 1)
// ln(1 + k (r - r0)) over its value at the farthest corner: the samples' spacing grows linearly with the
// distance, as the eye's smallest resolvable angle does; for a native inset of at least r0. Its x is not ln r
// / L.
const uint kKernelLinearMar = 4u;

// KernelMap::doublings of an alpha that is not 1, 2, 4 or 8.
const uint kAnyAlpha = 99u;

// How many vec4 a KernelMap fills.
const uint kMapVectors = 7u;

// Uniform block; std140. Sizes in pixels or texels as floats.
struct KernelMap {
    vec2 screen_size;      // W, H
    vec2 buffer_size;      // w, h
    vec2 gaze;             // screen position of the fovea
    float log_max_radius;  // L, ln of the largest distance from the gaze to a screen corner (Eqs. 12, 13)
    float alpha;           // exponent of kKernelPower; kKernelLinearMar: ln(1 + k (R - r0)), R = e^L
    uint kernel;           // one of the kKernel* constants
    uint as_printed;       // 1: Eq. 10's direction, 0: the author orientation
    float inset_px;        // radius of the disc that is drawn at full resolution; 0: none
    float inset_rim_px;    // the outer part of it that fades into the rest
    vec4 beta_low;         // beta_1 .. beta_4
    vec4 beta_high;        // beta_5 .. beta_8
    float mar_slope;       // k of kKernelLinearMar, 1 / pixel
    float mar_start;       // and r0, pixels
    uint doublings;        // kKernelPower: alpha = 2^doublings, or kAnyAlpha
    // Where the texels of the first columns are finer than pixels, each has the light of the pixel that it
    // lies in: so many columns, and the corner, on the screen, of the square of pixels around the gaze that
    // they lie in. Whole.
    float fine_columns;
    vec2 fine_corner;
    float pad_0;
    float pad_1;
};

// x^alpha and x^(1 / alpha): products and roots alone where that is enough.
SHARED_FUNCTION float alpha_power(KernelMap map, float x) {
    if (map.doublings == kAnyAlpha) return power_of(x, map.alpha);
    float y = x;
    if (map.doublings > 0u) y = y * y;
    if (map.doublings > 1u) y = y * y;
    if (map.doublings > 2u) y = y * y;
    return y;
}
SHARED_FUNCTION float alpha_root(KernelMap map, float x) {
    if (map.doublings == kAnyAlpha) return power_of(x, 1.0f / map.alpha);
    float y = x;
    if (map.doublings > 0u) y = root_of(y);
    if (map.doublings > 1u) y = root_of(y);
    if (map.doublings > 2u) y = root_of(y);
    return y;
}

SHARED_FUNCTION float polynomial_kernel(KernelMap map, float x) {
    float high = map.beta_high.x + x * (map.beta_high.y + x * (map.beta_high.z + x * map.beta_high.w));
    return x *
           (map.beta_low.x + x * (map.beta_low.y + x * (map.beta_low.z + x * (map.beta_low.w + x * high))));
}

// K(x) for x in [0, 1]; K(0) = 0, K(1) = 1, rising.
SHARED_FUNCTION float kernel(KernelMap map, float x) {
    if (map.kernel == kKernelPower) return alpha_power(map, x);
    if (map.kernel == kKernelPolynomial) return polynomial_kernel(map, x);
    if (map.kernel == kKernelSine) return unit_vector(0.25f * x).y;
    return (natural_exp(x) - 1.0f) * (1.0f / 1.71828182845905f);
}

// K^-1(y) for y in [0, 1].
SHARED_FUNCTION float inverse_kernel(KernelMap map, float y) {
    if (map.kernel == kKernelPower) return alpha_root(map, y);
    if (map.kernel == kKernelPolynomial) {
        // A rising polynomial has one root in the bracket; 30 halvings reach the last bit of a float.
        float low = 0.0f;
        float high = 1.0f;
        for (int i = 0; i < 30; ++i) {
            float middle = 0.5f * (low + high);
            if (polynomial_kernel(map, middle) < y)
                low = middle;
            else
                high = middle;
        }
        return 0.5f * (low + high);
    }
    if (map.kernel == kKernelSine) return arcsine_quarters(clamp(y, 0.0f, 1.0f));
    return natural_log(1.0f + y * 1.71828182845905f);
}

// Screen position to buffer position, as shares of the buffer's width and height (Algorithm 1). r < 1 counts
// as r = 1. u in [0, 1] on screen, v in [0, 1).
SHARED_FUNCTION vec2 share_from_screen(KernelMap map, vec2 position) {
    float x = position.x - map.gaze.x;
    float y = position.y - map.gaze.y;
    float squared = max(x * x + y * y, 1.0f);
    float u = 0.0f;
    if (map.kernel == kKernelLinearMar) {
        u = min(natural_log(1.0f + map.mar_slope * max(sqrt(squared) - map.mar_start, 0.0f)) / map.alpha,
                1.0f);
    } else {
        float radial = min(0.5f * natural_log(squared) / map.log_max_radius, 1.0f);
        u = map.as_printed == 0u ? kernel(map, radial) : inverse_kernel(map, radial);
    }
    return vec2(u, turns_of(x, y));
}

// The same in texels.
SHARED_FUNCTION vec2 buffer_from_screen(KernelMap map, vec2 position) {
    vec2 share = share_from_screen(map, position);
    return vec2(share.x * map.buffer_size.x, share.y * map.buffer_size.y);
}

// Distance from the gaze, in pixels, of buffer column position u (Algorithm 2).
SHARED_FUNCTION float radius_of_column(KernelMap map, float u) {
    float radial = clamp(u / map.buffer_size.x, 0.0f, 1.0f);
    if (map.kernel == kKernelLinearMar)
        return map.mar_start + (natural_exp(radial * map.alpha) - 1.0f) / map.mar_slope;
    return natural_exp(map.log_max_radius *
                       (map.as_printed == 0u ? inverse_kernel(map, radial) : kernel(map, radial)));
}

// Buffer position to screen position (Algorithm 2); may lie off the screen.
SHARED_FUNCTION vec2 screen_from_buffer(KernelMap map, vec2 position) {
    float r = radius_of_column(map, position.x);
    vec2 direction = unit_vector(position.y / map.buffer_size.y);
    return vec2(map.gaze.x + r * direction.x, map.gaze.y + r * direction.y);
}

// Distance between neighbouring columns at buffer column position u, where the radius is given.
SHARED_FUNCTION float radial_spacing(KernelMap map, float u, float radius) {
    // The derivative of radius_of_column(), where it comes almost for nothing.
    if (map.kernel == kKernelLinearMar)
        return (1.0f / map.mar_slope + radius - map.mar_start) * map.alpha / map.buffer_size.x;
    if (map.kernel == kKernelPower && map.as_printed == 0u) {
        float log_radius = map.log_max_radius * inverse_kernel(map, clamp(u / map.buffer_size.x, 0.0f, 1.0f));
        return radius * log_radius / (map.alpha * max(u, 0.5f));
    }
    return radius_of_column(map, u + 0.5f) - radius_of_column(map, u - 0.5f);
}

// Distance between neighbouring samples at a buffer position, in pixels: (radial, tangential).
SHARED_FUNCTION vec2 sample_spacing(KernelMap map, vec2 position) {
    float radius = radius_of_column(map, position.x);
    return vec2(radial_spacing(map, position.x, radius), radius * (2.0f * kMapPi) / map.buffer_size.y);
}

SHARED_END

#ifdef __cplusplus
#include <cstddef>
static_assert(offsetof(parafovea::shared::KernelMap, gaze) == 16);
static_assert(offsetof(parafovea::shared::KernelMap, kernel) == 32);
static_assert(offsetof(parafovea::shared::KernelMap, beta_low) == 48);
static_assert(offsetof(parafovea::shared::KernelMap, mar_slope) == 80);
static_assert(offsetof(parafovea::shared::KernelMap, fine_corner) == 96);
static_assert(sizeof(parafovea::shared::KernelMap) == 16 * parafovea::shared::kMapVectors);
#endif

#endif
