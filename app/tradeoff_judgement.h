// How a method's pictures compare with full resolution's: visible difference, errors by zone, flicker, and
// the share of people who are predicted to see no difference.
#pragma once

#include <vector>

#include "analysis/tradeoff_table.h"
#include "analysis/visible_difference.h"
#include "renderer/image.h"

namespace parafovea {

// What a group's pictures are judged against; frame by frame, all of one size.
struct TradeoffReference {
    DisplayModel display;
    double refresh_hz = 70;
    std::vector<GazePx> gazes;         // of the eye
    std::vector<Image> full;           // one sample a pixel
    std::vector<Image> super_sampled;  // the mean of several
    // Their luminances, where there is one frame.
    LuminancePyramid full_luminance, super_sampled_luminance;
};

// Completes a reference whose other members are set.
void prepare(TradeoffReference& reference);

// Fills what the pictures say into the row. One frame is judged as a still picture, several as a video.
//
// Of a video, errors by zone are of the mean squared error and the mean FLIP over frames, the zones' JOD is
// of the steady channel, and the predicted share takes the visible difference of the video for the average
// person's and scales it for other people as the last frame's scales.
void judge(const TradeoffReference& reference, const std::vector<Image>& pictures, TradeoffRow& row);

}  // namespace parafovea
