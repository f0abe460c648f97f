// Which kernel log-polar map is wanted, as a protocol says it, and the block that shaders read.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "devices/geometry.h"
#include "renderer/shared/kernel_map.h"

namespace parafovea {

enum class KernelKind {
    power,        // x^alpha
    polynomial,   // beta_1 x + beta_2 x^2 + ... (Meng et al. 2018, Eq. 9)
    sine,         // sin(x pi / 2)
    exponential,  // (e^x - 1) / (e - 1)
    linear_mar,   // ln(1 + k (r - r0)): spacing grows linearly with distance; needs an inset of at least r0
};

// The names for protocols: "power", "polynomial", "sine" (or "sin"), "exponential" (or "exp"),
// "linear_mar".
KernelKind kernel_kind_from_name(
    std::string_view name);  // throws std::runtime_error with the names there are
const char* name_of(KernelKind kind);
const std::vector<KernelKind>& all_kernel_kinds();

struct KernelSetting {
    KernelKind kind = KernelKind::power;
    double sigma = 1.8;         // screen pixels per buffer texel along each side; 0.5 to 50
    double alpha = 4;           // exponent of the power kernel; 1/16 to 32
    std::vector<double> betas;  // coefficients of the polynomial kernel; 1 to 8, adding up to 1
    double width_scale = 1;     // the buffer's columns, times this; 0.05 to 8
    double height_scale = 1;    // and its rows: the published shape is 6 times too coarse around the corners
    double mar_slope = 8;       // linear_mar: k for each shorter side of the screen; 0.5 to 200
    double mar_start = 0.07;    // linear_mar: r0, share of the shorter side; 0 to 0.7
    bool as_printed = false;    // Eq. 10's direction instead of the one that the paper's figures show

    bool operator==(const KernelSetting&) const = default;
};

// Throws std::runtime_error, one line, if a value is out of range or the polynomial does not rise on [0, 1].
void check(const KernelSetting& setting);

// The length that settings tell distances on the screen in: with it one setting asks for nearly the same
// share of a wide screen's quality and of a tall one's, which KFR's own buffer gives it.
inline double shorter_side_px(SizePx screen) {
    return std::min(screen.width, screen.height);
}

// round(W width_scale / sigma) x round(H height_scale / sigma), at least 1 x 1.
SizePx buffer_size(SizePx screen, const KernelSetting& setting);

// The map for a screen and a gaze point anywhere. A gaze that is not a number or infinite counts as the
// centre of the screen; one farther than a million pixels from it is brought to that distance. L is at least
// 0.001, so that a screen of one pixel has a map too. The setting has passed check().
shared::KernelMap make_kernel_map(SizePx screen, PointPx gaze, const KernelSetting& setting);

// The gaze that make_kernel_map uses, by the rules above.
PointPx usable_gaze(SizePx screen, PointPx gaze);

}  // namespace parafovea
