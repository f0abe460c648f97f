// The steps from a picture to contrast, for whoever filters pictures in between.
#pragma once

#include "analysis/visible_difference.h"

namespace parafovea {

// Throws what luminance_pyramid throws of a picture and its display.
void check_picture(RgbaView picture, const DisplayModel& display);

// Luminance of every pixel in cd/m2. Throws what luminance_pyramid throws.
LuminancePyramid::Level luminance_plane(RgbaView picture, const DisplayModel& display);

// The plane and its halvings, as many as the display has bands, and one more.
LuminancePyramid pyramid_over(LuminancePyramid::Level full, const DisplayModel& display);

// Contrast of two band-pass pictures relative to the luminance of another, steady pair of the same display;
// throws std::runtime_error where the displays differ.
ContrastBands relative_contrast(const LuminancePyramid& test, const LuminancePyramid& reference,
                                const LuminancePyramid& steady_test, const LuminancePyramid& steady_reference,
                                ContrastBackground background, TemporalChannel channel);

}  // namespace parafovea
