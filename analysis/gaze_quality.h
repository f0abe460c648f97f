// Quality of gaze while a person looks at a known target: accuracy, precision, spread and loss.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace parafovea {

// Azimuth (right positive) and elevation (up positive) of one valid gaze sample.
struct GazeAngle {
    double azimuth_deg = 0.0;
    double elevation_deg = 0.0;
};

struct GazeAccuracy {
    double angle_deg = 0.0;  // between the mean gaze direction (mean of unit vectors) and the target
    double azimuth_deg =
        0.0;  // its part to the right; with elevation_deg they give angle_deg after Pythagoras
    double elevation_deg = 0.0;
};

// All absent without enough samples: one for accuracy, two for the step-to-step precision and for the spread.
std::optional<GazeAccuracy> gaze_accuracy(std::span<const GazeAngle> samples, GazeAngle target);
// sqrt(mean(d azimuth^2 + d elevation^2)) over successive samples.
std::optional<double> gaze_rms_s2s_deg(std::span<const GazeAngle> samples);
// hypot of the standard deviations of azimuth and elevation (divisor n).
std::optional<double> gaze_std_deg(std::span<const GazeAngle> samples);
// Area of the ellipse that holds the share of samples: 2 k pi sd_x sd_y sqrt(1 - rho^2), k = ln(1 / (1 -
// share)), divisor n - 1.
std::optional<double> gaze_bcea_deg2(std::span<const GazeAngle> samples, double share = 0.68);

struct GazeLoss {
    double invalid_share = 0.0;  // of the samples that came
    std::optional<double>
        missing_share;  // of the samples that should have come, invalid ones counted as missing
    std::optional<double> effective_hz;  // valid samples per second
};

// Absent parts need a duration (and a nominal rate) above 0.
GazeLoss gaze_loss(std::int64_t samples, std::int64_t valid, double duration_s, double nominal_hz);

}  // namespace parafovea
