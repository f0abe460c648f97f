// The simulated headset's eye tracker: a recording, or an eye that looks one way, sampled at 120 Hz.
#pragma once

#include <openxr/openxr.h>

#include <vector>

#include "devices/gaze_source.h"
#include "tests/openxr_runtime/settings.h"

namespace parafovea::headset {

struct PlayedGaze {
    GazeStatus status = GazeStatus::lost;
    DirectionDeg direction;  // meaningless in a blink and when lost
    XrTime made = 0;         // when the eye was seen
};

class GazePlayer {
  public:
    // Throws std::runtime_error if the recording cannot be read or is empty.
    explicit GazePlayer(const Settings& settings);

    bool present() const { return kind_ != GazeKind::none; }

    // The first sample is made at this time.
    void start(XrTime time) { start_ = time; }

    // The sample nearest to `asked` among those that can be had at `now`.
    PlayedGaze at(XrTime asked, XrTime now) const;

  private:
    XrTime made(std::int64_t index) const;

    GazeKind kind_;
    XrDuration latency_;
    XrTime start_ = 0;
    std::vector<GazeSample> samples_;
    std::vector<XrDuration> offsets_;  // of each sample from the first
    XrDuration length_ = 0;            // of one round
};

}  // namespace parafovea::headset
