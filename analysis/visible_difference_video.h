// How visible the difference between two videos is: flicker and motion as well as detail, frame by frame.
//
// Source: as in visible_difference.h. The eye's response over time is split into a sustained and a transient
// channel by two filters of a quarter of a second; each channel's difference is judged like a still
// picture's, the transient one by its own contrast sensitivity (5 Hz) and masking. Before the first frame,
// the first frame is held to have been there for ever. As in the publication, flicker that is uniform over
// the picture is not seen.
#pragma once

#include <cstddef>
#include <deque>
#include <vector>

#include "analysis/visible_difference.h"

namespace parafovea {

// Weights of the last N = ceil(0.25 s x rate) frames, the newest first. As published, they sample the
// log-normal response exp(-(ln(t + 0.1 ms) - ln 60 ms)^2 / (2 0.5^2)) at N times from 0 to N frames, both
// ends included; the transient response is its forward difference quotient.
struct TemporalFilters {
    std::vector<double> sustained;  // sums to 1
    std::vector<double> transient;
};

// Throws std::runtime_error where the rate is not positive and at most 1000.
TemporalFilters temporal_filters(double frames_per_second);

struct FrameDifference {
    VisibleDifference sustained;
    VisibleDifference transient;
    double q = 0;  // both channels together
};

class VideoVisibleDifference {
  public:
    // Throws what luminance_pyramid and temporal_filters throw. Keeps a quarter of a second of both videos as
    // luminances (8 bytes a pixel for each frame).
    VideoVisibleDifference(const DisplayModel& display, double frames_per_second);

    // Takes the next frame of both videos and judges it at the gaze during that frame.
    FrameDifference add_frame(RgbaView test, RgbaView reference, GazePx gaze);

    std::size_t frames() const { return q_.size(); }

    // Of all frames so far, the mean over frames; without a frame q is 0.
    double q() const;
    double jod() const { return jod_from_q(q()); }

  private:
    struct Frame {
        LuminancePyramid::Level test, reference;
    };

    LuminancePyramid filtered(const std::vector<double>& weights,
                              LuminancePyramid::Level Frame::*which) const;

    DisplayModel display_;
    TemporalFilters filters_;
    std::deque<Frame> history_;  // the newest in front
    std::vector<double> q_;
};

}  // namespace parafovea
