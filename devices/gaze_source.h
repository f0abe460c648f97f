// What an eye tracker delivers, whichever it is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/geometry.h"
#include "devices/time.h"

namespace parafovea {

// Why a sample has, or has not, a direction. A blink or a loss is data: the sample is still delivered.
enum class GazeStatus { tracked, low_accuracy, blink, lost };

// One eye's direction relative to straight ahead in the display's view, and pupil diameter where the device
// has one.
struct EyeSample {
    std::optional<DirectionDeg> direction;
    std::optional<double> pupil_mm;
};

// One sample. The raw device time is never altered; beside it stand the mapped host time and its error bound.
struct GazeSample {
    std::int64_t sequence = 0;  // the device's own counter; counts on across dropped samples
    DeviceTime device_time;     // when the eye was seen, device clock
    HostTime host_time;         // the same moment mapped to the host clock
    Duration host_time_error;   // half-width of the mapping's uncertainty
    HostTime arrival_time;      // when the host received it
    GazeStatus status = GazeStatus::lost;
    std::optional<DirectionDeg> direction;  // cyclopean; absent in a blink or when lost
    std::optional<EyeSample> left, right;   // absent where the device has no per-eye data
};

class GazeSource {
  public:
    virtual ~GazeSource() = default;

    // Appends every sample that has arrived up to now, oldest first. Never blocks.
    virtual void drain(std::vector<GazeSample>& samples) = 0;

    // A name for the log, with the settings that matter, e.g. "simulated FOVE-like, 120 Hz, seed 7".
    virtual std::string description() const = 0;
};

}  // namespace parafovea
