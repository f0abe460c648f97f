// Checks a kernel setting and fills the map's block.
#include "renderer/kernel_setting.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace parafovea {
namespace {

constexpr double kFarthestGaze = 1e6;
constexpr double kLeastLogRadius = 1e-3;

struct KernelName {
    std::string_view name;
    KernelKind kind;
};
constexpr std::array kNames{KernelName{"power", KernelKind::power},
                            KernelName{"polynomial", KernelKind::polynomial},
                            KernelName{"sine", KernelKind::sine},
                            KernelName{"exponential", KernelKind::exponential},
                            KernelName{"linear_mar", KernelKind::linear_mar},
                            KernelName{"sin", KernelKind::sine},
                            KernelName{"exp", KernelKind::exponential}};

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

void check_range(const char* name, double value, double low, double high) {
    if (!(value >= low && value <= high)) {
        throw std::runtime_error(std::string("kernel map: ") + name + " = " + number(value) + " is not in " +
                                 number(low) + " to " + number(high));
    }
}

void check_polynomial(const std::vector<double>& betas) {
    if (betas.empty() || betas.size() > 8) {
        throw std::runtime_error(
            "kernel map: a polynomial kernel has 1 to 8 coefficients (beta_1, beta_2, ...), not " +
            std::to_string(betas.size()));
    }
    double sum = 0;
    for (const double beta : betas) sum += beta;
    if (!(std::abs(sum - 1) <= 1e-6)) {
        throw std::runtime_error(
            "kernel map: the coefficients beta of a polynomial kernel add up to 1, not to " + number(sum));
    }
    constexpr int kSteps = 4096;
    for (int i = 0; i <= kSteps; ++i) {
        const double x = static_cast<double>(i) / kSteps;
        double slope = 0;
        for (std::size_t k = betas.size(); k > 0; --k)
            slope = slope * x + static_cast<double>(k) * betas[k - 1];
        if (slope < -1e-9) {
            throw std::runtime_error(
                "kernel map: the polynomial kernel must rise on [0, 1], but it falls at x = " + number(x));
        }
    }
}

shared::uint number_of(KernelKind kind) {
    switch (kind) {
        case KernelKind::power:
            return shared::kKernelPower;
        case KernelKind::polynomial:
            return shared::kKernelPolynomial;
        case KernelKind::sine:
            return shared::kKernelSine;
        case KernelKind::exponential:
            return shared::kKernelExponential;
        case KernelKind::linear_mar:
            return shared::kKernelLinearMar;
    }
    assert(false);
    return 0;
}

std::uint32_t doublings_of(double alpha) {
    constexpr std::array kAlphas{1.0, 2.0, 4.0, 8.0};
    const auto found = std::ranges::find(kAlphas, alpha);
    return found == kAlphas.end() ? shared::kAnyAlpha : static_cast<std::uint32_t>(found - kAlphas.begin());
}

int reduced(int pixels, double sigma) {
    return std::max(1, static_cast<int>(std::lround(pixels / sigma)));
}

}  // namespace

KernelKind kernel_kind_from_name(std::string_view name) {
    const auto found = std::ranges::find(kNames, name, &KernelName::name);
    if (found == kNames.end()) {
        throw std::runtime_error("unknown kernel \"" + std::string(name) +
                                 "\"; there are power, polynomial, sine, exponential and linear_mar");
    }
    return found->kind;
}

const char* name_of(KernelKind kind) {
    return std::ranges::find(kNames, kind, &KernelName::kind)->name.data();
}

const std::vector<KernelKind>& all_kernel_kinds() {
    static const std::vector<KernelKind> kinds{KernelKind::power, KernelKind::polynomial, KernelKind::sine,
                                               KernelKind::exponential, KernelKind::linear_mar};
    return kinds;
}

void check(const KernelSetting& setting) {
    check_range("sigma", setting.sigma, 0.5, 50);
    if (setting.kind == KernelKind::power) check_range("alpha", setting.alpha, 0.0625, 32);
    if (setting.kind == KernelKind::polynomial) check_polynomial(setting.betas);
    check_range("width_scale", setting.width_scale, 0.05, 8);
    check_range("height_scale", setting.height_scale, 0.05, 8);
    if (setting.kind == KernelKind::linear_mar) {
        check_range("mar_slope", setting.mar_slope, 0.5, 200);
        check_range("mar_start", setting.mar_start, 0, 0.7);
        if (setting.as_printed)
            throw std::runtime_error("kernel map: linear_mar has no direction as printed");
    }
}

SizePx buffer_size(SizePx screen, const KernelSetting& setting) {
    return {reduced(screen.width, setting.sigma / setting.width_scale),
            reduced(screen.height, setting.sigma / setting.height_scale)};
}

PointPx usable_gaze(SizePx screen, PointPx gaze) {
    const PointPx centre = centre_of(screen);
    if (!std::isfinite(gaze.x) || !std::isfinite(gaze.y)) return centre;
    const double distance = std::hypot(gaze.x - centre.x, gaze.y - centre.y);
    if (distance <= kFarthestGaze) return gaze;
    // Halves first: the difference of two huge numbers may not fit a double.
    const double scale = 0.5 * std::max(std::abs(gaze.x), std::abs(gaze.y));
    const double x = gaze.x / scale, y = gaze.y / scale;
    return {centre.x + kFarthestGaze * x / std::hypot(x, y), centre.y + kFarthestGaze * y / std::hypot(x, y)};
}

shared::KernelMap make_kernel_map(SizePx screen, PointPx gaze, const KernelSetting& setting) {
    assert(screen.width > 0 && screen.height > 0);
    const PointPx fovea = usable_gaze(screen, gaze);
    double farthest = 0;
    for (const double x : {0.0, static_cast<double>(screen.width)}) {
        for (const double y : {0.0, static_cast<double>(screen.height)}) {
            farthest = std::max(farthest, std::hypot(x - fovea.x, y - fovea.y));
        }
    }
    farthest = std::max(farthest, std::exp(kLeastLogRadius));
    const SizePx reduced_size = buffer_size(screen, setting);
    std::array<float, 8> betas{};
    std::ranges::transform(setting.betas, betas.begin(),
                           [](double beta) { return static_cast<float>(beta); });

    shared::KernelMap map{};
    map.screen_size = {static_cast<float>(screen.width), static_cast<float>(screen.height)};
    map.buffer_size = {static_cast<float>(reduced_size.width), static_cast<float>(reduced_size.height)};
    map.gaze = {static_cast<float>(fovea.x), static_cast<float>(fovea.y)};
    map.log_max_radius = static_cast<float>(std::log(farthest));
    map.alpha = static_cast<float>(setting.alpha);
    if (setting.kind == KernelKind::linear_mar) {
        const double start = std::min(setting.mar_start * shorter_side_px(screen), 0.5 * farthest);
        const double slope = setting.mar_slope / shorter_side_px(screen);
        map.mar_slope = static_cast<float>(slope);
        map.mar_start = static_cast<float>(start);
        map.alpha = static_cast<float>(std::log1p(slope * (farthest - start)));
    }
    map.kernel = number_of(setting.kind);
    map.as_printed = setting.as_printed ? 1 : 0;
    map.doublings = doublings_of(setting.alpha);
    map.beta_low = {betas[0], betas[1], betas[2], betas[3]};
    map.beta_high = {betas[4], betas[5], betas[6], betas[7]};
    return map;
}

}  // namespace parafovea
