// Plain errors of a picture by eccentricity: mean squared error, PSNR and FLIP around a gaze.
#pragma once

#include <array>

#include "analysis/visible_difference.h"

namespace parafovea {

struct PictureError {
    double share = 0;               // of the picture's pixels; the rest is 0 where this is 0
    double mean_squared_error = 0;  // of the 8-bit sRGB codes, over red, green and blue
    double psnr_db = 0;             // 10 log10(255^2 / mean squared error); infinite without an error
    double flip = 0;                // mean FLIP at the display's pixels per degree
};

struct ZoneErrors {
    PictureError whole;
    std::array<PictureError, kEccentricityZones> zones;  // see kEccentricityZoneStartsDeg
};

// Eccentricity as in visible_difference.h; a gaze that is not finite puts every pixel into the first zone.
// Throws std::runtime_error where the pictures are not as large as the display or it makes no sense.
ZoneErrors zone_errors(RgbaView test, RgbaView reference, const DisplayModel& display, GazePx gaze);

}  // namespace parafovea
