// The visible difference again, slowly: the publication's equations in double, pixel by pixel, nothing
// tabulated.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/visible_difference.h"

namespace parafovea::oracle {

struct Plane {
    int w = 0, h = 0;
    std::vector<double> v;
    double operator()(int x, int y) const {
        return v[static_cast<std::size_t>(std::clamp(y, 0, h - 1)) * w + std::clamp(x, 0, w - 1)];
    }
};

inline Plane luminance(RgbaView p, const DisplayModel& d) {
    Plane out{p.width, p.height, {}};
    const double black = d.peak_cd_m2 / d.contrast_ratio;
    for (std::size_t i = 0; i < static_cast<std::size_t>(p.width) * p.height; ++i) {
        const double weight[3] = {0.2126, 0.7152, 0.0722};
        double sum = d.ambient_reflection_cd_m2;
        for (int c = 0; c < 3; ++c) {
            const double v = p.bytes[4 * i + c] / 255.0;
            const double lin = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
            sum += weight[c] * ((d.peak_cd_m2 - black) * lin + black);
        }
        out.v.push_back(sum);
    }
    return out;
}

constexpr double kKernel[5] = {0.05, 0.25, 0.4, 0.25, 0.05};

inline Plane reduced(const Plane& in) {
    Plane out{(in.w + 1) / 2, (in.h + 1) / 2, {}};
    for (int y = 0; y < out.h; ++y)
        for (int x = 0; x < out.w; ++x) {
            double sum = 0;
            for (int j = -2; j <= 2; ++j)
                for (int i = -2; i <= 2; ++i)
                    sum += kKernel[j + 2] * kKernel[i + 2] * in(2 * x + i, 2 * y + j);
            out.v.push_back(sum);
        }
    return out;
}

// Zeros between the samples, the same kernel, four times the gain.
inline double expanded(const Plane& low, int x, int y) {
    double sum = 0;
    for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i)
            if ((x + i) % 2 == 0 && (y + j) % 2 == 0)
                sum += 4 * kKernel[j + 2] * kKernel[i + 2] *
                       low(static_cast<int>(std::floor((x + i) / 2.0)),
                           static_cast<int>(std::floor((y + j) / 2.0)));
    return sum;
}

// Log-log monotone cubic through the published values, Hermite form.
inline double foveal_sensitivity(double rho) {
    const double s[8] = {46, 93, 119, 97, 52, 19, 4.5, 0.8};
    const auto value = [&](int i) { return std::log(s[i]); };
    const auto secant = [&](int i) { return value(i + 1) - value(i); };
    const auto slope = [&](int i) {
        if (i == 0) return secant(0);
        if (i == 7) return secant(6);
        const double a = secant(i - 1), b = secant(i);
        return a * b > 0 ? 1 / (0.5 / a + 0.5 / b) : 0.0;
    };
    const double x = std::log2(rho) + 2;
    if (x < 0) return std::exp(value(0) + x * slope(0));
    if (x > 7) return std::exp(value(7) + (x - 7) * slope(7));
    const int i = std::min(static_cast<int>(x), 6);
    const double t = x - i, c = secant(i);
    const double quadratic = 3 * c - 2 * slope(i) - slope(i + 1), cubic = slope(i) + slope(i + 1) - 2 * c;
    return std::exp(value(i) + t * (slope(i) + t * (quadratic + t * cubic)));
}

// stelaCSF's peak height and peak frequency over luminance, as published, without any limit taken.
inline double luminance_factor(double rho, double l) {
    const auto parabola = [&](double y) {
        const double height =
            std::pow(1 + 0.713964 / y, -0.277857) * -std::expm1(-8.50217e+09 * std::log1p(7.54866e-07 / y));
        const double peak = 1.55909 * std::pow(1 + 103.604 / y, -0.251815);
        const double d = rho < peak ? 0 : std::log10(rho) - std::log10(peak);
        return height * std::pow(10, -d * d / std::pow(2, 0.177674));
    };
    return parabola(l) / parabola(50);
}

inline double pooled_q(RgbaView test, RgbaView reference, const DisplayModel& d, GazePx gaze,
                       double sensitivity = 1) {
    const double deg = 180 / std::acos(-1.0);
    const double distance = 0.5 * d.width_px / std::tan(d.horizontal_fov_deg / 2 / deg);
    const double ppd = distance * std::tan(1 / deg);
    Plane t = luminance(test, d), r = luminance(reference, d);
    double q = 0;
    for (int b = 0; t.w > 1 || t.h > 1; ++b) {
        const double rho = b == 0 ? ppd / 2 : 0.3228 * std::pow(2.0, -(b - 1)) * ppd / 2;
        const Plane t_low = reduced(t), r_low = reduced(r);
        double sum = 0;
        for (int y = 0; y < t.h; ++y)
            for (int x = 0; x < t.w; ++x) {
                const double background = std::max(0.1, expanded(r_low, x, y)), gain = b == 0 ? 1 : 2;
                const double ct =
                    std::clamp(gain * (t(x, y) - expanded(t_low, x, y)) / background, -1e3, 1e3);
                const double cr =
                    std::clamp(gain * (r(x, y) - expanded(r_low, x, y)) / background, -1e3, 1e3);

                const double px = std::ldexp(x, b) + 0.5 - d.width_px / 2.0,
                             py = std::ldexp(y, b) + 0.5 - d.height_px / 2.0;
                const double ax = deg * std::atan(px / distance), ay = deg * std::atan(py / distance);
                const double gx = deg * std::atan((gaze.x - d.width_px / 2.0) / distance);
                const double gy = deg * std::atan((gaze.y - d.height_px / 2.0) / distance);
                const double e = std::isfinite(gaze.x + gaze.y) ? std::hypot(ax - gx, ay - gy) : 0;
                const double oblique = 1 + (px * px + py * py) / (distance * distance);
                const double magnification = std::pow(3.67 / (e + 3.67), 0.604562);
                const double f = rho * oblique / magnification;
                const double s = foveal_sensitivity(f) * luminance_factor(f, background) *
                                 std::pow(10, 16.2596 / 20) * sensitivity;

                const double mask = std::min(std::fabs(ct * s), std::fabs(cr * s)) * std::pow(10, -0.973838);
                const double masked =
                    std::pow(std::fabs(ct * s - cr * s), 2.4) / (1 + std::pow(mask, 2.43685));
                sum += std::pow(std::min(masked, 1e4), 1.52134);
            }
        q += std::pow(sum / (static_cast<double>(t.w) * t.h), 1 / 1.52134);
        if (rho < 0.5) break;
        t = t_low;
        r = r_low;
    }
    return q;
}

}  // namespace parafovea::oracle
