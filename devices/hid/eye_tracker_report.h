// Reports of HID eye trackers: usage page 0x12, "Eye and Head Trackers" (HUTRR74).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "devices/geometry.h"
#include "devices/hid/report_descriptor.h"
#include "devices/time.h"

namespace parafovea {

constexpr std::uint16_t kEyeTrackerPage = 0x12;

// A point in metres; an axis that the device lacks or marks as unknown is absent.
struct HidPoint {
    std::optional<double> x_m, y_m, z_m;
};

// One tracking report. The gaze point counts from the top left of the calibrated screen, x right, y down; eye
// and head positions use the same axes, z towards the user.
struct EyeTrackerReading {
    std::optional<DeviceTime> device_time;
    HidPoint gaze, left_eye, right_eye, head;
};

enum class EyeTrackerState {
    reserved = 0,
    ready = 1,
    configuring = 2,
    needs_screen_setup = 3,
    needs_calibration = 4
};

struct EyeTrackerStatus {
    EyeTrackerState state = EyeTrackerState::reserved;
    std::optional<double> rate_hz;
};

struct EyeTrackerScreen {
    double width_m = 0, height_m = 0;
};

// Where a given device keeps what, found from its descriptor by usage and collection; report ids and layout
// are the device's own business. A report is passed with its id byte first (0 where the device has no ids).
class EyeTrackerLayout {
  public:
    // Throws std::runtime_error if the device describes no gaze point.
    explicit EyeTrackerLayout(HidReportDescriptor descriptor);
    EyeTrackerLayout(EyeTrackerLayout&&) = default;  // not copied: it points into its own descriptor
    EyeTrackerLayout& operator=(EyeTrackerLayout&&) = default;

    // Nothing for reports of other kinds and for reports that are too short.
    std::optional<EyeTrackerReading> decode_tracking(std::span<const std::uint8_t> report) const;
    std::optional<EyeTrackerStatus> decode_status(std::span<const std::uint8_t> report,
                                                  HidReportKind kind) const;
    // The screen that gaze points refer to, from the configuration feature; nothing if it is of no plausible
    // size.
    std::optional<EyeTrackerScreen> decode_screen(std::span<const std::uint8_t> report) const;

    // The feature report that asks for the given data (mode bits 1 gaze, 2 eyes, 4 head; 0 stops); nothing if
    // the device has no such control and simply sends.
    std::optional<std::vector<std::uint8_t>> mode_request(std::uint8_t mode) const;

    // Ids of the feature reports to ask for.
    std::optional<std::uint8_t> configuration_report_id() const;
    std::optional<std::uint8_t> status_feature_id() const;

    const HidReportDescriptor& descriptor() const { return descriptor_; }

  private:
    const HidField* find(HidReportKind kind, std::uint16_t collection, std::uint16_t usage) const;
    std::optional<std::int64_t> value(const HidField* field, std::span<const std::uint8_t> report) const;
    std::optional<double> length_m(const HidField* field, std::span<const std::uint8_t> report) const;

    HidReportDescriptor descriptor_;
    std::vector<const HidField*> timestamp_;                  // low bits first
    std::array<std::array<const HidField*, 3>, 4> points_{};  // gaze, left, right, head; x, y, z
};

// The direction of a gaze point on a screen whose centre lies straight ahead at a distance. For a
// head-mounted tracker the project's convention is a virtual screen of 1.430104 m (100 deg) square at 0.6 m.
std::optional<DirectionDeg> direction_of_gaze_point(const HidPoint& gaze, EyeTrackerScreen screen,
                                                    double distance_m);

constexpr EyeTrackerScreen kVirtualScreen = {1.430104, 1.430104};
constexpr double kVirtualScreenDistance_m = 0.6;

}  // namespace parafovea
