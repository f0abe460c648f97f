// The kernel log-polar map written a second time, straight from the equations in long double, to judge the
// real one. Meng et al. 2018, Eqs. 9 to 13, with the conventions of pixel and texel centres.
#pragma once

#include <cmath>
#include <numbers>
#include <utility>

#include "renderer/kernel_setting.h"

namespace parafovea::oracle {

using Real = long double;

struct Position {
    Real x = 0;
    Real y = 0;
};

struct Map {
    Map(SizePx screen_, PointPx gaze_, KernelSetting setting_)
        : screen(screen_), gaze(gaze_), setting(std::move(setting_)), log_radius(farthest_log_radius()) {}

    SizePx screen;
    PointPx gaze;
    KernelSetting setting;
    Real log_radius;

    Real w() const { return reduced(screen.width, setting.width_scale); }
    Real h() const { return reduced(screen.height, setting.height_scale); }
    Real reduced(int pixels, double scale) const {
        return std::fmax(1.0L, std::floor(pixels / (Real{setting.sigma} / scale) + 0.5L));
    }

    // The linear-MAR kernel: u / w = ln(1 + k (r - r0)) / ln(1 + k (R - r0)).
    Real mar_slope() const { return Real{setting.mar_slope} / std::min(screen.width, screen.height); }
    Real mar_start() const {
        return std::fmin(Real{setting.mar_start} * std::min(screen.width, screen.height),
                         std::exp(log_radius) / 2);
    }
    Real mar_span() const { return std::log(1 + mar_slope() * (std::exp(log_radius) - mar_start())); }

    // Eqs. 12 and 13.
    Real farthest_log_radius() const {
        const Real x = gaze.x, y = gaze.y, right = screen.width - x, below = screen.height - y;
        const Real l1 = std::sqrt(x * x + y * y), l2 = std::sqrt(right * right + below * below);
        const Real l3 = std::sqrt(x * x + below * below), l4 = std::sqrt(right * right + y * y);
        return std::fmax(std::log(std::fmax(std::fmax(l1, l2), std::fmax(l3, l4))), 0.001L);
    }

    Real forward(Real x) const {
        switch (setting.kind) {
            case KernelKind::power:
                return std::pow(x, Real{setting.alpha});
            case KernelKind::polynomial: {
                Real sum = 0;
                for (std::size_t i = 0; i < setting.betas.size(); ++i) {
                    sum += Real{setting.betas[i]} * std::pow(x, static_cast<Real>(i + 1));
                }
                return sum;
            }
            case KernelKind::sine:
                return std::sin(x * std::numbers::pi_v<Real> / 2);
            case KernelKind::exponential:
                return std::expm1(x) / std::expm1(Real{1});
            case KernelKind::linear_mar:
                break;
        }
        return 0;
    }

    // By bisection for every kernel: knows no closed form.
    Real inverse(Real y) const {
        Real low = 0, high = 1;
        for (int i = 0; i < 80; ++i) {
            const Real middle = (low + high) / 2;
            (forward(middle) < y ? low : high) = middle;
        }
        return (low + high) / 2;
    }

    Position to_buffer(Position p) const {
        const Real x = p.x - gaze.x, y = p.y - gaze.y;
        const Real r = std::fmax(std::sqrt(x * x + y * y), 1.0L);
        const Real radial = std::fmin(std::log(r) / log_radius, 1.0L);
        Real theta = (x == 0 && y == 0) ? 0 : std::atan2(y, x);
        if (theta < 0) theta += 2 * std::numbers::pi_v<Real>;
        Real share = 0;
        if (setting.kind == KernelKind::linear_mar)
            share =
                std::fmin(std::log(1 + mar_slope() * std::fmax(r - mar_start(), 0.0L)) / mar_span(), 1.0L);
        else
            share = setting.as_printed ? inverse(radial) : forward(radial);
        return {share * w(), theta / (2 * std::numbers::pi_v<Real>)*h()};
    }

    Real radius(Real u) const {
        const Real radial = std::fmin(std::fmax(u / w(), 0.0L), 1.0L);
        if (setting.kind == KernelKind::linear_mar)
            return mar_start() + (std::exp(radial * mar_span()) - 1) / mar_slope();
        return std::exp(log_radius * (setting.as_printed ? forward(radial) : inverse(radial)));
    }

    Position to_screen(Position p) const {
        const Real r = radius(p.x);
        const Real theta = 2 * std::numbers::pi_v<Real> * p.y / h();
        return {gaze.x + r * std::cos(theta), gaze.y + r * std::sin(theta)};
    }
};

// The difference of two heights in a buffer that wraps around.
inline Real wrapped_difference(Real a, Real b, Real h) {
    Real d = std::fmod(std::abs(a - b), h);
    return std::fmin(d, h - d);
}

}  // namespace parafovea::oracle
