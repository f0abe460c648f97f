// Walks through the targets and turns the gaze at each into accuracy, precision and loss.
#include "app/calibration_page.h"

#include <algorithm>
#include <cassert>
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

// Shows the targets one after the other, collects the gaze and measures it. None where it was stopped.
std::optional<CalibrationRecord> measure_at(const std::vector<DirectionDeg>& targets, Stage& stage,
                                            GazeSource& gaze, Clock& clock, const CalibrationRules& rules,
                                            const std::stop_token& stop) {
    CalibrationRecord record;
    record.method = "validation only";
    record.started = clock.now();
    gaze.drain(record.gaze);
    record.gaze.clear();
    std::vector<ShownTarget> shown;
    Picture picture;
    picture.kind = PictureKind::target;
    const Duration each = Duration::from_seconds(rules.each_s);
    for (const DirectionDeg target : targets) {
        picture.fovea = stage.view().point_from_direction(target);
        ShownTarget now{target, {}, {}};
        now.shown = stage.show(picture).display_time;
        for (now.hidden = now.shown; now.hidden - now.shown < each;) {
            if (stop.stop_requested()) return std::nullopt;
            now.hidden = stage.show(picture).display_time;
            gaze.drain(record.gaze);
        }
        shown.push_back(now);
    }

    ValidationSettings validation;
    validation.rate_hz = rate_of(record.gaze);
    const ValidationResult result = validate_gaze(record.gaze, shown, validation);
    for (const TargetQuality& target : result.targets) record.points.push_back(point_from(target));
    record.mean_accuracy_deg = if_number(result.mean_accuracy_deg);
    record.worst_accuracy_deg = if_number(result.worst_accuracy_deg);
    record.data_loss_share = result.loss_percent / 100;
    record.accepted =
        result.targets_without_data == 0 && result.loss_percent <= 100 * rules.greatest_loss_share;
    record.ended = clock.now();
    return record;
}

}  // namespace

std::optional<CalibrationRecord> measure_calibration(Stage& stage, GazeSource& gaze, Clock& clock,
                                                     const CalibrationRules& rules, std::stop_token stop) {
    // Targets stay a little inside the picture.
    const ViewGeometry view = stage.view();
    const DirectionDeg corner = view.direction_from_point({0.9 * view.size.width, 0.1 * view.size.height});
    const std::vector<DirectionDeg> targets =
        calibration_targets(rules.targets, std::min(rules.extent_deg, corner.azimuth_deg),
                            std::min(rules.extent_deg, corner.elevation_deg));
    std::optional<CalibrationRecord> record = measure_at(targets, stage, gaze, clock, rules, stop);
    if (record) record->accepted &= record->mean_accuracy_deg <= rules.greatest_mean_accuracy_deg;
    return record;
}

std::optional<CalibrationRecord> measure_drift(Stage& stage, GazeSource& gaze, Clock& clock,
                                               const CalibrationRules& rules, std::stop_token stop) {
    assert(rules.drift_check_deg);
    std::optional<CalibrationRecord> record = measure_at({{0, 0}}, stage, gaze, clock, rules, stop);
    if (!record) return std::nullopt;
    record->kind = "drift check";
    record->accepted &= record->mean_accuracy_deg <= rules.drift_check_deg;
    return record;
}

}  // namespace parafovea
