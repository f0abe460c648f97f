// Finds fixations, saccades and blinks in gaze samples.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "devices/gaze_source.h"

namespace parafovea {

enum class EyeEventKind { fixation, saccade, blink, loss };

// Samples first to last, both included. Times are the host times of these samples.
struct EyeEvent {
    EyeEventKind kind = EyeEventKind::fixation;
    std::size_t first = 0, last = 0;
    HostTime begin, end;
    DirectionDeg from, to;               // first and last direction; meaningless for blink and loss
    DirectionDeg centre;                 // mean direction of a fixation
    double amplitude_deg = 0;            // of a saccade: from first to last
    double peak_velocity_deg_per_s = 0;  // of a saccade; at 120 Hz short ones are underestimated
};

// Velocity threshold. Defaults are those of the Tobii I-VT fixation filter (Olsen 2012).
struct VelocityThresholdSettings {
    double velocity_deg_per_s = 30;
    Duration velocity_window = {
        20'000'000};  // the velocity at a sample is taken over the samples within half of this
    Duration merge_gap = {75'000'000};          // fixations closer than this in time
    double merge_angle_deg = 0.5;               // and in space are one
    Duration shortest_fixation = {60'000'000};  // shorter ones are dropped
};

// Dispersion threshold (Salvucci and Goldberg 2000): defaults as commonly used at a desk; 0.7 deg and 160 ms
// have been used in head-mounted displays.
struct DispersionThresholdSettings {
    double dispersion_deg = 1.0;  // (max - min azimuth) + (max - min elevation)
    Duration shortest_fixation = {100'000'000};
};

// Runs of samples without a direction are blinks where the device says so, or where it cannot tell and the
// run is as long as a blink (80 to 500 ms); else losses. A device that reports any blink is taken to tell.
struct GapSettings {
    Duration shortest_blink = {80'000'000}, longest_blink = {500'000'000};
};

// The speed of gaze at each sample in degrees a second, absent where the sample or a neighbour has no
// direction. Angles between unit vectors, so right at every eccentricity. Samples in the order of host time.
std::vector<std::optional<double>> gaze_velocity(std::span<const GazeSample> samples,
                                                 Duration window = {20'000'000});

// Fixations, saccades, blinks and losses, in the order of time; what is none of these is left out. A loss
// shorter than merge_gap may lie within a fixation.
std::vector<EyeEvent> detect_by_velocity(std::span<const GazeSample> samples,
                                         const VelocityThresholdSettings& settings = {},
                                         const GapSettings& gaps = {});

// Fixations, blinks and losses, in the order of time.
std::vector<EyeEvent> detect_by_dispersion(std::span<const GazeSample> samples,
                                           const DispersionThresholdSettings& settings = {},
                                           const GapSettings& gaps = {});

}  // namespace parafovea
