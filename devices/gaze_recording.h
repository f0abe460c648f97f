// Gaze recordings in text files: reading three formats, writing one.
#pragma once

#include <filesystem>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "devices/gaze_source.h"

namespace parafovea {

// The target that was shown while a sample was taken.
struct RecordedTarget {
    int id = 0;
    DirectionDeg direction;
};

struct GazeRecording {
    std::string name;                 // of the file
    std::string format;               // which of the formats below
    double rate_hz = 0;               // 1 / the median interval between samples
    std::vector<GazeSample> samples;  // host times begin at 0 unless the format stores them
    std::vector<std::optional<RecordedTarget>> targets;  // one a sample, or empty if the format has none
};

// The screen that gaze in pixels was recorded on, its centre straight ahead of the eye. The default is the
// screen of the ETDQualitizer example recordings (a Tobii Spectrum's).
struct RecordedScreen {
    double width_mm = 528.0, height_mm = 296.9997253417969;
    double width_px = 1920, height_px = 1080;
    double distance_mm = 650;
};

// Reads a recording, telling the format from the header line:
//  - our own CSV, as write_gaze_csv makes it;
//  - the binocular head-mounted-display CSV of salient360Toolbox: device time in microseconds, one unit
//  vector an eye
//    in the head's frame (x right, y up, z forward), a validity flag an eye;
//  - the TSV of ETDQualitizer: time in milliseconds, left and right eye in pixels from the centre of
//  `screen`, y up,
//    "nan" where an eye was not seen, and the target.
// The two foreign formats hold no arrival times: samples are taken to arrive when they were made. The
// cyclopean direction is the mean of the eyes' unit vectors, or the one eye's where only one was seen. Throws
// std::runtime_error naming file and line.
GazeRecording parse_gaze_recording(std::string_view text, const std::string& name,
                                   const RecordedScreen& screen = {});
GazeRecording read_gaze_recording(const std::filesystem::path& path);

// Writes samples as CSV, one line each, so that they read back bit for bit:
//   sequence,device_time_ns,host_time_ns,host_time_error_ns,arrival_time_ns,status,azimuth_deg,elevation_deg,
//   left_azimuth_deg,left_elevation_deg,left_pupil_mm,right_azimuth_deg,right_elevation_deg,right_pupil_mm
// A field that is absent is empty; an eye with neither direction nor pupil reads back as an absent eye.
// Status is tracked, low_accuracy, blink or lost.
void write_gaze_csv(std::ostream& out, std::span<const GazeSample> samples);

}  // namespace parafovea
