// Quality of gaze while a person looks at a known target: accuracy, precision, spread and loss.
#include "analysis/gaze_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace parafovea {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

using Direction = std::array<double, 3>;  // right, up, forward

Direction direction(const GazeAngle& angle) {
    const double azimuth = angle.azimuth_deg * kRadians, elevation = angle.elevation_deg * kRadians;
    return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
            std::cos(azimuth) * std::cos(elevation)};
}

struct Moments {
    double azimuth = 0.0, elevation = 0.0, product = 0.0;  // sums of squares and products about the mean
};

Moments moments(std::span<const GazeAngle> samples) {
    const double n = static_cast<double>(samples.size());
    double azimuth = 0.0, elevation = 0.0;
    for (const GazeAngle& sample : samples) {
        azimuth += sample.azimuth_deg / n;
        elevation += sample.elevation_deg / n;
    }
    Moments sums;
    for (const GazeAngle& sample : samples) {
        const double a = sample.azimuth_deg - azimuth, e = sample.elevation_deg - elevation;
        sums.azimuth += a * a;
        sums.elevation += e * e;
        sums.product += a * e;
    }
    return sums;
}

}  // namespace

std::optional<GazeAccuracy> gaze_accuracy(std::span<const GazeAngle> samples, GazeAngle target) {
    Direction mean{};
    for (const GazeAngle& sample : samples) {
        const Direction d = direction(sample);
        for (std::size_t i = 0; i < 3; ++i) mean[i] += d[i];
    }
    const double length = std::hypot(mean[0], mean[1], mean[2]);
    if (samples.empty() || length == 0.0) return std::nullopt;
    const Direction to = direction(target);
    const Direction cross{mean[1] * to[2] - mean[2] * to[1], mean[2] * to[0] - mean[0] * to[2],
                          mean[0] * to[1] - mean[1] * to[0]};
    const double dot = mean[0] * to[0] + mean[1] * to[1] + mean[2] * to[2];
    GazeAccuracy result;
    result.angle_deg = std::atan2(std::hypot(cross[0], cross[1], cross[2]), dot) / kRadians;
    // Its parts: the angle along the direction in which the mean gaze misses the target, as seen from the
    // eye.
    const double right = mean[0] / length - to[0], up = mean[1] / length - to[1],
                 miss = std::hypot(right, up);
    if (miss > 0.0) {
        result.azimuth_deg = result.angle_deg * right / miss;
        result.elevation_deg = result.angle_deg * up / miss;
    }
    return result;
}

std::optional<double> gaze_rms_s2s_deg(std::span<const GazeAngle> samples) {
    if (samples.size() < 2) return std::nullopt;
    double sum = 0.0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const double a = samples[i].azimuth_deg - samples[i - 1].azimuth_deg;
        const double e = samples[i].elevation_deg - samples[i - 1].elevation_deg;
        sum += a * a + e * e;
    }
    return std::sqrt(sum / static_cast<double>(samples.size() - 1));
}

std::optional<double> gaze_std_deg(std::span<const GazeAngle> samples) {
    if (samples.size() < 2) return std::nullopt;
    const Moments sums = moments(samples);
    return std::sqrt((sums.azimuth + sums.elevation) / static_cast<double>(samples.size()));
}

std::optional<double> gaze_bcea_deg2(std::span<const GazeAngle> samples, double share) {
    if (samples.size() < 2) return std::nullopt;
    const Moments sums = moments(samples);
    // sd_x sd_y sqrt(1 - rho^2) is the root of the covariance matrix's determinant.
    const double determinant = std::max(0.0, sums.azimuth * sums.elevation - sums.product * sums.product);
    return 2.0 * std::log(1.0 / (1.0 - share)) * std::numbers::pi * std::sqrt(determinant) /
           static_cast<double>(samples.size() - 1);
}

GazeLoss gaze_loss(std::int64_t samples, std::int64_t valid, double duration_s, double nominal_hz) {
    GazeLoss result;
    result.invalid_share =
        samples > 0 ? 1.0 - static_cast<double>(valid) / static_cast<double>(samples) : 0.0;
    if (duration_s > 0.0) {
        result.effective_hz = static_cast<double>(valid) / duration_s;
        if (nominal_hz > 0.0)
            result.missing_share =
                std::clamp(1.0 - static_cast<double>(valid) / (duration_s * nominal_hz), 0.0, 1.0);
    }
    return result;
}

}  // namespace parafovea
