// How good gaze data are: accuracy, precision, data loss; calibration targets; what that means for foveation.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "devices/gaze_source.h"

namespace parafovea {

// Measures of one stretch of looking at one target. Formulas as in ETDQualitizer (Niehorster): angles in
// degrees, Fick. NaN where there are too few valid samples (one for accuracy, two for SD and BCEA, one pair
// for RMS).
struct GazeQuality {
    int samples = 0;          // delivered
    int valid = 0;            // with a direction
    double accuracy_deg = 0;  // angle from the target to the mean of the unit vectors
    double offset_azimuth_deg = 0, offset_elevation_deg = 0;  // that mean, seen from the target
    double rms_s2s_deg =
        0;  // root mean square of sample-to-sample steps (azimuth, elevation); gaps not bridged
    double rms_s2s_angle_deg = 0;  // the same of the angles between unit vectors: right at every eccentricity
    double sd_azimuth_deg = 0, sd_elevation_deg = 0, sd_deg = 0;  // population SD and its hypotenuse
    double bcea_deg2 = 0;        // area of the ellipse that holds 68 % of a bivariate normal; sample SD
    double invalid_percent = 0;  // of the delivered samples
    double loss_percent = 0;     // of the samples that the nominal rate promises: counts dropped frames too
    double effective_hz = 0;
};

// `directions` are those of successive delivered samples, absent where there was none. `rate_hz` is nominal.
GazeQuality measure_gaze_quality(std::span<const std::optional<DirectionDeg>> directions, DirectionDeg target,
                                 double duration_s, double rate_hz);

// 5, 9 or 13 targets within +-extent of straight ahead, the centre first; 5: the corners, 9: and the edges,
// 13: and half way to the corners. Throws std::runtime_error for any other count.
std::vector<DirectionDeg> calibration_targets(int count, double extent_azimuth_deg,
                                              double extent_elevation_deg);

// One validation target and when it was shown.
struct ShownTarget {
    DirectionDeg direction;
    HostTime shown, hidden;
};

struct ValidationSettings {
    Duration settle = {500'000'000};  // after onset, while the eye is still on its way
    double rate_hz = 120;
};

struct TargetQuality {
    DirectionDeg target;
    GazeQuality cyclopean;
    std::optional<GazeQuality> left, right;  // absent where the device has no per-eye data
};

struct ValidationResult {
    std::vector<TargetQuality> targets;
    // Over the targets that had data, cyclopean.
    double mean_accuracy_deg = 0, median_accuracy_deg = 0, worst_accuracy_deg = 0;
    double median_sd_deg = 0, median_rms_s2s_deg = 0;
    double mean_offset_azimuth_deg = 0, mean_offset_elevation_deg = 0;
    double loss_percent = 0;
    int targets_without_data = 0;
};

// Samples may be more than those of the targets; each target uses those whose host time lies between settling
// and end.
ValidationResult validate_gaze(std::span<const GazeSample> samples, std::span<const ShownTarget> targets,
                               const ValidationSettings& settings = {});

// Measured error against the radius that a foveated picture keeps sharp.
struct FoveationMargin {
    double sharp_radius_deg = 0;
    double error_deg = 0;   // worst target's accuracy plus twice its SD: where gaze may really be
    double margin_deg = 0;  // sharp radius less error; negative: the eye may see beyond the sharp part
    bool go = false;
    std::string reason;  // one line for the experimenter
};

// Go when the margin is at least `required_margin_deg`, the mean accuracy at most
// `greatest_mean_accuracy_deg`, the loss at most `greatest_loss_percent` and every target had data.
struct MarginThresholds {
    double required_margin_deg = 0;
    double greatest_mean_accuracy_deg = 2;
    double greatest_loss_percent = 20;
};
FoveationMargin foveation_margin(const ValidationResult& validation, double sharp_radius_deg,
                                 const MarginThresholds& thresholds = {});

}  // namespace parafovea
