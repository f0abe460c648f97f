// Plays a gaze recording as if it were an eye tracker.
#pragma once

#include <string>
#include <vector>

#include "devices/clock.h"
#include "devices/gaze_recording.h"
#include "devices/gaze_source.h"

namespace parafovea {

struct ReplayOptions {
    // At the end, begin again one sample interval later. Sequence numbers count on; device times begin again,
    // as after a reset of the device, because they are never altered.
    bool repeat = false;
};

// The recording's first sample is made at the moment of construction; host and arrival times are shifted by
// that one span and keep all their spacing, gaps and bunches. Not thread safe. The clock must outlive it.
class ReplayGaze final : public GazeSource {
  public:
    ReplayGaze(Clock& clock, GazeRecording recording, ReplayOptions options = {});

    void drain(std::vector<GazeSample>& samples) override;
    std::string description() const override;

    // Whether every sample has been delivered; never so when repeating.
    bool finished() const { return next_ == recording_.samples.size(); }

  private:
    Clock& clock_;
    GazeRecording recording_;
    ReplayOptions options_;
    std::size_t next_ = 0;
    Duration shift_;
    Duration period_;
    std::int64_t sequence_shift_ = 0, sequence_period_ = 0;
};

}  // namespace parafovea
