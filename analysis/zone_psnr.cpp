// Sums errors by eccentricity.
#include "analysis/zone_psnr.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "analysis/flip.h"
#include "analysis/visible_difference_pyramid.h"

namespace parafovea {
namespace {

struct Sums {
    double pixels = 0, squares = 0, flip = 0;

    PictureError error(double all_pixels) const {
        if (pixels == 0) return {};
        const double mse = squares / (3 * pixels);
        return {pixels / all_pixels, mse,
                mse > 0 ? 10 * std::log10(255.0 * 255.0 / mse) : std::numeric_limits<double>::infinity(),
                flip / pixels};
    }
};

}  // namespace

ZoneErrors zone_errors(RgbaView test, RgbaView reference, const DisplayModel& display, GazePx gaze) {
    check_picture(test, display);
    check_picture(reference, display);
    const std::vector<float> flip = flip_map(test, reference, display.pixels_per_degree());

    const auto angle_deg = [&](double offset_px) {
        return std::atan(offset_px / display.distance_px()) * 180 / std::numbers::pi;
    };
    const bool gaze_known = std::isfinite(gaze.x) && std::isfinite(gaze.y);
    const double centre_x = 0.5 * display.width_px, centre_y = 0.5 * display.height_px;
    std::vector<double> azimuth_off(static_cast<std::size_t>(display.width_px));
    for (int x = 0; x < display.width_px; ++x)
        azimuth_off[x] = gaze_known ? angle_deg(x + 0.5 - centre_x) - angle_deg(gaze.x - centre_x) : 0;

    std::array<Sums, kEccentricityZones> sums;
    for (int y = 0; y < display.height_px; ++y) {
        const double elevation_off =
            gaze_known ? angle_deg(y + 0.5 - centre_y) - angle_deg(gaze.y - centre_y) : 0;
        for (int x = 0; x < display.width_px; ++x) {
            const double eccentricity = std::hypot(azimuth_off[x], elevation_off);
            int zone = 0;
            while (zone + 1 < kEccentricityZones && eccentricity >= kEccentricityZoneStartsDeg[zone + 1])
                ++zone;
            const std::size_t pixel = static_cast<std::size_t>(y) * display.width_px + x;
            Sums& sum = sums[zone];
            sum.pixels += 1;
            sum.flip += flip[pixel];
            for (int c = 0; c < 3; ++c) {
                const int apart = int{test.bytes[4 * pixel + c]} - int{reference.bytes[4 * pixel + c]};
                sum.squares += apart * apart;
            }
        }
    }

    ZoneErrors errors;
    Sums whole;
    for (const Sums& sum : sums) {
        whole.pixels += sum.pixels;
        whole.squares += sum.squares;
        whole.flip += sum.flip;
    }
    errors.whole = whole.error(whole.pixels);
    for (int z = 0; z < kEccentricityZones; ++z) errors.zones[z] = sums[z].error(whole.pixels);
    return errors;
}

}  // namespace parafovea
