// Gaze and timing of a study, already counted by the caller: plain arrays for the figures and tables of
// quality.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace parafovea {

// Where people looked while pictures were shown: counts over a regular grid of gaze angles about the middle
// of the display.
struct GazeHeatMap {
    int columns = 0;
    int rows = 0;
    double width_deg = 0.0;   // of the whole grid, centred: azimuth from -width/2 to width/2, right positive
    double height_deg = 0.0;  // elevation, up positive; the first row is the topmost
    std::vector<double> counts;  // rows x columns
};

struct SessionQuality {
    std::string participant;
    int session = 1;
    std::optional<double> accuracy_deg;   // of the calibration's validation
    std::optional<double> precision_deg;  // RMS from sample to sample
    std::optional<double> gaze_loss;      // share of samples without a gaze
    std::optional<double> gaze_hz;        // valid samples per second
    std::int64_t frames = 0;
    std::int64_t missed = 0;            // refreshes without a new frame
    std::optional<double> gaze_age_ms;  // 95th percentile of the gaze's age when its picture was seen
};

struct FrameTimes {
    double bin_ms = 0.1;
    std::vector<std::int64_t> counts;  // of frame intervals: bin i holds [i, i + 1) bin_ms
    double refresh_hz = 0.0;           // nominal
};

struct StudyRecordings {
    std::optional<GazeHeatMap> gaze;
    std::vector<SessionQuality> sessions;
    std::optional<FrameTimes> frames;
};

}  // namespace parafovea
