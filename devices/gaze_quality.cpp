// Gaze quality by the formulas of ETDQualitizer, validation per target and eye, and the foveation margin.
#include "devices/gaze_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>

#include "devices/unit_vector.h"

namespace parafovea {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kBceaProbability = 0.68;

double median(std::vector<double> values) {
    std::erase_if(values, [](double v) { return std::isnan(v); });
    if (values.empty()) return kNaN;
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return n % 2 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

// The vector in the frame whose z axis points at the target.
Vector3 seen_from(DirectionDeg target, Vector3 v) {
    const double ca = std::cos(rad_from_deg(target.azimuth_deg)),
                 sa = std::sin(rad_from_deg(target.azimuth_deg));
    const double ce = std::cos(rad_from_deg(target.elevation_deg)),
                 se = std::sin(rad_from_deg(target.elevation_deg));
    const double forward = sa * v.x + ca * v.z;
    return {ca * v.x - sa * v.z, ce * v.y - se * forward, se * v.y + ce * forward};
}

void measure_accuracy(std::span<const std::optional<DirectionDeg>> directions, DirectionDeg target,
                      GazeQuality& q) {
    Vector3 sum;
    for (const auto& d : directions)
        if (d) sum = sum + unit_vector(*d);
    if (q.valid == 0) {
        q.accuracy_deg = q.offset_azimuth_deg = q.offset_elevation_deg = kNaN;
        return;
    }
    const Vector3 seen = seen_from(target, sum);
    q.accuracy_deg = deg_from_rad(std::atan2(std::hypot(seen.x, seen.y), seen.z));
    const DirectionDeg offset = direction_of(seen);
    q.offset_azimuth_deg = offset.azimuth_deg;
    q.offset_elevation_deg = offset.elevation_deg;
}

void measure_steps(std::span<const std::optional<DirectionDeg>> directions, GazeQuality& q) {
    double fick = 0, angle = 0;
    int pairs = 0;
    for (std::size_t i = 1; i < directions.size(); ++i) {
        if (!directions[i - 1] || !directions[i]) continue;
        const double da = directions[i]->azimuth_deg - directions[i - 1]->azimuth_deg;
        const double de = directions[i]->elevation_deg - directions[i - 1]->elevation_deg;
        const double step = angle_between_deg(*directions[i], *directions[i - 1]);
        fick += da * da + de * de;
        angle += step * step;
        ++pairs;
    }
    q.rms_s2s_deg = pairs ? std::sqrt(fick / pairs) : kNaN;
    q.rms_s2s_angle_deg = pairs ? std::sqrt(angle / pairs) : kNaN;
}

void measure_spread(std::span<const std::optional<DirectionDeg>> directions, GazeQuality& q) {
    if (q.valid < 2) {
        q.sd_azimuth_deg = q.sd_elevation_deg = q.sd_deg = q.bcea_deg2 = kNaN;
        return;
    }
    const double n = q.valid;
    double mean_a = 0, mean_e = 0;
    for (const auto& d : directions) {
        if (!d) continue;
        mean_a += d->azimuth_deg / n;
        mean_e += d->elevation_deg / n;
    }
    double aa = 0, ee = 0, ae = 0;
    for (const auto& d : directions) {
        if (!d) continue;
        const double a = d->azimuth_deg - mean_a, e = d->elevation_deg - mean_e;
        aa += a * a;
        ee += e * e;
        ae += a * e;
    }
    q.sd_azimuth_deg = std::sqrt(aa / n);
    q.sd_elevation_deg = std::sqrt(ee / n);
    q.sd_deg = std::hypot(q.sd_azimuth_deg, q.sd_elevation_deg);
    // 2 k pi sx sy sqrt(1 - rho^2), written without the division by sx sy that fails when one of them is
    // zero.
    const double k = std::log(1 / (1 - kBceaProbability));
    q.bcea_deg2 = 2 * k * std::numbers::pi * std::sqrt(std::max(0.0, aa * ee - ae * ae)) / (n - 1);
}

}  // namespace

GazeQuality measure_gaze_quality(std::span<const std::optional<DirectionDeg>> directions, DirectionDeg target,
                                 double duration_s, double rate_hz) {
    GazeQuality q;
    q.samples = static_cast<int>(directions.size());
    q.valid = static_cast<int>(
        std::count_if(directions.begin(), directions.end(), [](const auto& d) { return d.has_value(); }));
    measure_accuracy(directions, target, q);
    measure_steps(directions, q);
    measure_spread(directions, q);
    q.invalid_percent = q.samples ? 100.0 * (q.samples - q.valid) / q.samples : 100;
    const double promised = duration_s * rate_hz;
    q.loss_percent = promised > 0 ? std::max(0.0, 100 * (1 - q.valid / promised)) : kNaN;
    q.effective_hz = duration_s > 0 ? q.valid / duration_s : kNaN;
    return q;
}

std::vector<DirectionDeg> calibration_targets(int count, double extent_azimuth_deg,
                                              double extent_elevation_deg) {
    if (count != 5 && count != 9 && count != 13)
        throw std::runtime_error("a calibration has 5, 9 or 13 targets, not " + std::to_string(count));
    const double a = extent_azimuth_deg, e = extent_elevation_deg;
    std::vector<DirectionDeg> targets = {{0, 0}, {-a, e}, {a, e}, {-a, -e}, {a, -e}};
    if (count >= 9) targets.insert(targets.end(), {{0, e}, {-a, 0}, {a, 0}, {0, -e}});
    if (count == 13)
        targets.insert(targets.end(), {{-a / 2, e / 2}, {a / 2, e / 2}, {-a / 2, -e / 2}, {a / 2, -e / 2}});
    return targets;
}

ValidationResult validate_gaze(std::span<const GazeSample> samples, std::span<const ShownTarget> targets,
                               const ValidationSettings& settings) {
    ValidationResult result;
    std::vector<double> accuracies, sds, steps;
    double valid = 0, promised = 0;
    for (const ShownTarget& target : targets) {
        const HostTime from = target.shown + settings.settle;
        const double duration_s = std::max(0.0, (target.hidden - from).seconds());

        // Collect each eye's directions over the settled stretch.
        std::vector<std::optional<DirectionDeg>> cyclopean, left, right;
        for (const GazeSample& sample : samples) {
            if (sample.host_time < from || sample.host_time >= target.hidden) continue;
            cyclopean.push_back(sample.direction);
            if (sample.left) left.push_back(sample.left->direction);
            if (sample.right) right.push_back(sample.right->direction);
        }
        TargetQuality quality;
        quality.target = target.direction;
        quality.cyclopean = measure_gaze_quality(cyclopean, target.direction, duration_s, settings.rate_hz);
        if (!left.empty())
            quality.left = measure_gaze_quality(left, target.direction, duration_s, settings.rate_hz);
        if (!right.empty())
            quality.right = measure_gaze_quality(right, target.direction, duration_s, settings.rate_hz);

        // Sum up.
        valid += quality.cyclopean.valid;
        promised += duration_s * settings.rate_hz;
        if (quality.cyclopean.valid == 0) {
            ++result.targets_without_data;
        } else {
            accuracies.push_back(quality.cyclopean.accuracy_deg);
            sds.push_back(quality.cyclopean.sd_deg);
            steps.push_back(quality.cyclopean.rms_s2s_deg);
            result.mean_offset_azimuth_deg += quality.cyclopean.offset_azimuth_deg;
            result.mean_offset_elevation_deg += quality.cyclopean.offset_elevation_deg;
        }
        result.targets.push_back(std::move(quality));
    }

    const double n = static_cast<double>(accuracies.size());
    double sum = 0;
    for (const double accuracy : accuracies) sum += accuracy;
    result.mean_accuracy_deg = n > 0 ? sum / n : kNaN;
    result.mean_offset_azimuth_deg = n > 0 ? result.mean_offset_azimuth_deg / n : kNaN;
    result.mean_offset_elevation_deg = n > 0 ? result.mean_offset_elevation_deg / n : kNaN;
    result.worst_accuracy_deg = n > 0 ? *std::max_element(accuracies.begin(), accuracies.end()) : kNaN;
    result.median_accuracy_deg = median(accuracies);
    result.median_sd_deg = median(sds);
    result.median_rms_s2s_deg = median(steps);
    result.loss_percent = promised > 0 ? std::max(0.0, 100 * (1 - valid / promised)) : 100;
    return result;
}

FoveationMargin foveation_margin(const ValidationResult& validation, double sharp_radius_deg,
                                 const MarginThresholds& thresholds) {
    FoveationMargin margin;
    margin.sharp_radius_deg = sharp_radius_deg;
    for (const TargetQuality& target : validation.targets) {
        const double sd = std::isnan(target.cyclopean.sd_deg) ? 0 : target.cyclopean.sd_deg;
        if (target.cyclopean.valid > 0)
            margin.error_deg = std::max(margin.error_deg, target.cyclopean.accuracy_deg + 2 * sd);
    }
    margin.margin_deg = sharp_radius_deg - margin.error_deg;

    std::array<char, 200> text;
    const int n = static_cast<int>(validation.targets.size());
    if (n == 0 || validation.targets_without_data > 0)
        std::snprintf(text.data(), text.size(),
                      "no go: %d of %d targets had no gaze data; adjust the headset and recalibrate",
                      validation.targets_without_data, n);
    else if (validation.loss_percent > thresholds.greatest_loss_percent)
        std::snprintf(text.data(), text.size(),
                      "no go: %.0f %% of gaze samples are missing, at most %.0f %% allowed",
                      validation.loss_percent, thresholds.greatest_loss_percent);
    else if (validation.mean_accuracy_deg > thresholds.greatest_mean_accuracy_deg)
        std::snprintf(text.data(), text.size(),
                      "no go: mean error %.2f deg, at most %.2f deg allowed; recalibrate",
                      validation.mean_accuracy_deg, thresholds.greatest_mean_accuracy_deg);
    else if (margin.margin_deg < thresholds.required_margin_deg)
        std::snprintf(
            text.data(), text.size(),
            "no go: gaze may be %.2f deg off and %.2f deg are sharp, a margin of %.2f deg; %.2f deg required",
            margin.error_deg, sharp_radius_deg, margin.margin_deg, thresholds.required_margin_deg);
    else {
        margin.go = true;
        std::snprintf(text.data(), text.size(),
                      "go: gaze may be %.2f deg off, %.2f deg are sharp, a margin of %.2f deg",
                      margin.error_deg, sharp_radius_deg, margin.margin_deg);
    }
    margin.reason = text.data();
    return margin;
}

}  // namespace parafovea
