// Walks through the targets and turns the gaze at each into accuracy, precision and loss.
#include "app/calibration_page.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "devices/gaze_quality.h"

namespace parafovea {

namespace {

// The tracker's own rate, from the median interval of its own clock; validate_gaze takes it as nominal.
double rate_of(const std::vector<GazeSample>& samples) {
    std::vector<std::int64_t> intervals;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const std::int64_t steps = samples[i].sequence - samples[i - 1].sequence;
        if (steps > 0) intervals.push_back((samples[i].device_time - samples[i - 1].device_time).ns / steps);
    }
    std::erase_if(intervals, [](std::int64_t ns) { return ns <= 0; });
    if (intervals.empty()) return ValidationSettings().rate_hz;
    const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
    std::nth_element(intervals.begin(), middle, intervals.end());
    return 1e9 / static_cast<double>(*middle);
}

std::optional<double> if_number(double value) {
    if (std::isfinite(value)) return value;
    return std::nullopt;
}

CalibrationPoint point_from(const TargetQuality& target) {
    const GazeQuality& quality = target.cyclopean;
    CalibrationPoint point;
    point.target = target.target;
    point.samples = quality.samples;
    point.valid_samples = quality.valid;
    if (quality.valid > 0)
        point.measured = DirectionDeg{target.target.azimuth_deg + quality.offset_azimuth_deg,
                                      target.target.elevation_deg + quality.offset_elevation_deg};
    point.accuracy_deg = if_number(quality.accuracy_deg);
    point.precision_rms_deg = if_number(quality.rms_s2s_deg);
    point.precision_sd_deg = if_number(quality.sd_deg);
    return point;
}

}  // namespace

std::optional<CalibrationRecord> measure_calibration(Stage& stage, GazeSource& gaze, Clock& clock,
                                                     std::stop_token stop,
                                                     const CalibrationPageSettings& settings) {
    CalibrationRecord record;
    record.method = "validation only";
    record.started = clock.now();

    // Targets stay a little inside the picture.
    const ViewGeometry view = stage.view();
    const DirectionDeg corner = view.direction_from_point({0.9 * view.size.width, 0.1 * view.size.height});
    const double extent_azimuth_deg = std::min(settings.extent_deg, corner.azimuth_deg);
    const double extent_elevation_deg = std::min(settings.extent_deg, corner.elevation_deg);

    std::vector<GazeSample> samples;
    gaze.drain(samples);
    samples.clear();
    std::vector<ShownTarget> shown;
    Picture picture;
    picture.kind = PictureKind::target;
    for (const DirectionDeg target :
         calibration_targets(settings.targets, extent_azimuth_deg, extent_elevation_deg)) {
        picture.fovea = view.point_from_direction(target);
        ShownTarget now{target, {}, {}};
        now.shown = stage.show(picture).display_time;
        for (now.hidden = now.shown; now.hidden - now.shown < settings.each;) {
            if (stop.stop_requested()) return std::nullopt;
            now.hidden = stage.show(picture).display_time;
            gaze.drain(samples);
        }
        shown.push_back(now);
    }

    ValidationSettings validation;
    validation.rate_hz = rate_of(samples);
    const ValidationResult result = validate_gaze(samples, shown, validation);
    for (const TargetQuality& target : result.targets) record.points.push_back(point_from(target));
    record.mean_accuracy_deg = if_number(result.mean_accuracy_deg);
    record.worst_accuracy_deg = if_number(result.worst_accuracy_deg);
    record.data_loss_share = result.loss_percent / 100;
    record.accepted = result.targets_without_data == 0 &&
                      result.mean_accuracy_deg <= settings.greatest_mean_accuracy_deg &&
                      result.loss_percent <= settings.greatest_loss_percent;
    record.ended = clock.now();
    return record;
}

}  // namespace parafovea
