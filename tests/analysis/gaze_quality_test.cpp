// Gaze quality against worked examples.
#include "analysis/gaze_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace parafovea {
namespace {

const std::vector<GazeAngle> kThree{{1, 1}, {2, 2}, {3, 3}};

TEST(GazeQuality, agrees_with_etdqualitizers_examples) {
    const std::vector<GazeAngle> two{{1, 1}, {2, 2}};
    const auto accuracy = gaze_accuracy(two, {0, 0});
    EXPECT_NEAR(accuracy->angle_deg, 2.12116, 5e-6);
    EXPECT_NEAR(accuracy->azimuth_deg, 1.49954, 5e-6);
    EXPECT_NEAR(accuracy->elevation_deg, 1.50023, 5e-6);
    EXPECT_NEAR(*gaze_rms_s2s_deg(kThree), 1.414214, 5e-7);
    EXPECT_NEAR(*gaze_std_deg(kThree), 1.154701, 5e-7);
    // Its components: the same steps along one axis only.
    for (const std::vector<GazeAngle>& axis :
         {std::vector<GazeAngle>{{1, 0}, {2, 0}, {3, 0}}, std::vector<GazeAngle>{{0, 1}, {0, 2}, {0, 3}}}) {
        EXPECT_NEAR(*gaze_rms_s2s_deg(axis), 1.0, 1e-12);
        EXPECT_NEAR(*gaze_std_deg(axis), .816497, 5e-7);
    }
}

TEST(GazeQuality, bcea_of_independent_axes_is_its_closed_form) {
    const std::vector<GazeAngle> square{{-1, -1}, {1, -1}, {-1, 1}, {1, 1}};  // variances 4/3, no correlation
    EXPECT_NEAR(*gaze_bcea_deg2(square), 2.0 * std::log(1.0 / 0.32) * std::numbers::pi * 4.0 / 3.0, 1e-12);
    EXPECT_NEAR(*gaze_bcea_deg2(kThree), 0.0, 1e-12) << "a line has no area";
}

TEST(GazeQuality, is_absent_without_samples_and_counts_what_is_missing) {
    EXPECT_FALSE(gaze_accuracy({}, {}) || gaze_rms_s2s_deg({}) || gaze_std_deg({}) || gaze_bcea_deg2({}));
    const GazeLoss loss = gaze_loss(100, 90, 1.0, 120.0);
    EXPECT_NEAR(loss.invalid_share, 0.1, 1e-12);
    EXPECT_NEAR(*loss.missing_share, 0.25, 1e-12);
    EXPECT_NEAR(*loss.effective_hz, 90.0, 1e-12);
    EXPECT_FALSE(gaze_loss(0, 0, 0.0, 0.0).missing_share);
}

}  // namespace
}  // namespace parafovea
