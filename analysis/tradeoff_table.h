// One measured setting of a method, and the CSV table that holds many of them.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/visible_difference.h"

namespace parafovea {

// What one method at one setting costs and how it looks, on one display, for one scene, gaze and motion.
// Where there are several frames: means over them, and times are medians.
struct TradeoffRow {
    std::string scene;
    int width = 0, height = 0;  // pixels of the display
    double gaze_x = 0, gaze_y = 0;
    std::string motion;   // still, path: of the camera
    std::string method;   // as protocols name it
    std::string setting;  // "alpha=4 sigma=1.8"
    std::uint64_t shaded_samples = 0;
    double frame_ms = 0;  // from the call to the finished picture, not read back
    double jod = 10;      // against full resolution
    std::array<double, kEccentricityZones> psnr_db{};
    // Mean absolute change, from one frame to the next, of the difference to full resolution: 8-bit codes. 0
    // for one frame.
    double flicker = 0;
    // Share of simulated people who would call the picture identical to full resolution, from 0 to 1.
    double predicted_p_identical = 1;

    std::string gaze;    // centre, quarter, corner, path
    std::string family;  // what tables and figures call the method, without the setting
    double horizontal_fov_deg = 90;
    double peak_cd_m2 = 100;
    double refresh_hz = 70;
    int frames = 1;
    double frame_ms_low = 0, frame_ms_high = 0;  // quartiles
    double full_frame_ms = 0;                    // of full resolution, measured in turns with this
    double shading_ms = 0;                       // pass_1
    std::string passes_ms;                       // "shadow=1.2 depth=0.3 ...": medians of device time
    std::uint64_t memory_bytes = 0;              // device memory: the scene and this method's own
    double jod_supersampled = 10;                // against the mean of several samples a pixel
    std::array<double, kEccentricityZones> jod_zone{10, 10, 10, 10};
    double jod_transient = 10;  // of what changes alone; 10 for one frame
    double psnr_whole_db = 0;
    double flip = 0;
    std::array<double, kEccentricityZones> flip_zone{};

    bool operator==(const TradeoffRow&) const = default;

    double share_of_samples() const {
        return static_cast<double>(shaded_samples) / (static_cast<double>(width) * height);
    }
    double speedup() const { return full_frame_ms / frame_ms; }
};

// What distinguishes a row from all others of a sweep, in words.
std::string key_of(const TradeoffRow& row);

// The header and the lines of the table, each with its line end. Numbers read back to the same bits.
std::string tradeoff_csv_header();
std::string tradeoff_csv_line(const TradeoffRow& row);
std::string tradeoff_csv(const std::vector<TradeoffRow>& rows);

// The inverse of tradeoff_csv_line, without the line end. Throws std::runtime_error that begins with `place`.
TradeoffRow parse_tradeoff_line(std::string_view line, const std::string& place);

}  // namespace parafovea
