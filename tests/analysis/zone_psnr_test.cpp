// Errors by eccentricity: worked by hand and at the extremes.
#include "analysis/zone_psnr.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/flip.h"
#include "tests/analysis/visible_difference_pictures.h"

namespace parafovea {
namespace {

const DisplayModel kDisplay{400, 20, 90, 100, 1000, 0};  // 200 px from the eye to the picture

TEST(ZoneErrors, PsnrIsTheTextbookFigure) {
    const RgbaPicture reference = rgba_from(flat_picture(400, 20, 100));
    RgbaPicture test = reference;
    for (std::size_t i = 0; i < test.bytes.size(); i += 4) test.bytes[i] = 110;  // red only
    const ZoneErrors errors = zone_errors(test, reference, kDisplay, {200, 10});
    EXPECT_DOUBLE_EQ(errors.whole.mean_squared_error, 100.0 / 3);
    EXPECT_NEAR(errors.whole.psnr_db, 20 * std::log10(255) - 10 * std::log10(100.0 / 3), 1e-9);
    for (const PictureError& zone : errors.zones) EXPECT_DOUBLE_EQ(zone.mean_squared_error, 100.0 / 3);
    EXPECT_NEAR(errors.whole.flip, flip_mean(flip_map(test, reference, kDisplay.pixels_per_degree())), 1e-12);
}

TEST(ZoneErrors, AnErrorIsCountedInItsZoneOnly) {
    const RgbaPicture reference = rgba_from(flat_picture(400, 20, 100));
    // Pixel columns at 0.1, 10, 20 and 40 degrees from the gaze at the centre.
    const int column_of_zone[kEccentricityZones] = {200, 235, 272, 367};
    for (int changed = 0; changed < kEccentricityZones; ++changed) {
        RgbaPicture test = reference;
        test.bytes[4 * (10 * 400 + static_cast<std::size_t>(column_of_zone[changed]))] = 130;
        const ZoneErrors errors = zone_errors(test, reference, kDisplay, {200, 10});
        for (int z = 0; z < kEccentricityZones; ++z)
            EXPECT_EQ(errors.zones[z].mean_squared_error > 0, z == changed);
        const PictureError& zone = errors.zones[changed];
        EXPECT_NEAR(zone.mean_squared_error * 3 * zone.share * 8000, 900, 1e-6);
    }
}

TEST(ZoneErrors, ZonesFollowTheGazeAndCoverThePicture) {
    const RgbaPicture p = rgba_from(textured_picture(400, 20));
    for (const GazePx gaze : {GazePx{200, 10}, {0, 0}, {1e6, 3}, {std::nan(""), 0}}) {
        const ZoneErrors errors = zone_errors(p, p, kDisplay, gaze);
        double share = 0;
        for (const PictureError& zone : errors.zones) share += zone.share;
        EXPECT_NEAR(share, 1, 1e-12);
    }
    EXPECT_EQ(zone_errors(p, p, kDisplay, {std::nan(""), 0}).zones[0].share, 1);
    // 5 degrees are 17.5 px at the centre: about 35 columns of 400.
    EXPECT_NEAR(zone_errors(p, p, kDisplay, {200, 10}).zones[0].share, 35.0 / 400, 0.01);
    EXPECT_EQ(zone_errors(p, p, kDisplay, {1e6, 3}).zones[0].share, 0);
}

TEST(ZoneErrors, EqualPicturesHaveInfinitePsnr) {
    const RgbaPicture p = rgba_from(textured_picture(400, 20));
    const ZoneErrors errors = zone_errors(p, p, kDisplay, {200, 10});
    EXPECT_EQ(errors.whole.psnr_db, std::numeric_limits<double>::infinity());
    EXPECT_EQ(errors.whole.flip, 0);
    EXPECT_EQ(errors.zones[2].psnr_db, std::numeric_limits<double>::infinity());
}

TEST(ZoneErrors, BlackAgainstWhiteIsZeroDecibels) {
    const ZoneErrors errors = zone_errors(rgba_from(flat_picture(400, 20, 0)),
                                          rgba_from(flat_picture(400, 20, 255)), kDisplay, {200, 10});
    EXPECT_EQ(errors.whole.psnr_db, 0);
}

TEST(ZoneErrors, PicturesOfAnotherSizeAreRefused) {
    const RgbaPicture p = rgba_from(flat_picture(8, 8, 0));
    EXPECT_THROW(zone_errors(p, p, kDisplay, {0, 0}), std::runtime_error);
}

}  // namespace
}  // namespace parafovea
