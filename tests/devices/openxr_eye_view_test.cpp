// Projection onto one eye's picture: against the tangents of a frustum, and there and back.
#include <gtest/gtest.h>

#include <cmath>

#include "devices/openxr/eye_view.h"
#include "devices/random.h"

namespace parafovea {
namespace {

constexpr SizePx kSize{1280, 1440};

XrView eye_at(float x, double left_deg, double right_deg) {
    const auto rad = [](double deg) { return static_cast<float>(rad_from_deg(deg)); };
    return {XR_TYPE_VIEW,
            nullptr,
            {{0, 0, 0, 1}, {x, 0, 0}},
            {-rad(left_deg), rad(right_deg), rad(50), -rad(50)}};
}

TEST(EyeView, TheCornersOfThePictureAreTheEdgesOfTheField) {
    const XrView eye = eye_at(0, 52, 48);
    const double left = std::tan(rad_from_deg(52)), right = std::tan(rad_from_deg(48)),
                 up = std::tan(rad_from_deg(50));
    const PointPx top_left = picture_point(eye, kSize, {-left, up, 1});
    EXPECT_NEAR(top_left.x, 0, 1e-3);
    EXPECT_NEAR(top_left.y, 0, 1e-3);
    const PointPx bottom_right = picture_point(eye, kSize, {3 * right, -3 * up, 3});
    EXPECT_NEAR(bottom_right.x, 1280, 1e-3);
    EXPECT_NEAR(bottom_right.y, 1440, 1e-3);
    // Straight ahead lies nearer to the nose than the middle of the picture.
    EXPECT_NEAR(picture_point(eye, kSize, {0, 0, 1}).x, 1280 * left / (left + right), 1e-3);
}

TEST(EyeView, EachEyeSeesANearPointOnItsOwnSide) {
    // 63 mm apart, half a metre away: 3.6 degrees to the nose each.
    const Vector3 near{0, 0, 0.5};
    const XrView left = eye_at(-0.0315f, 50, 50), right = eye_at(0.0315f, 50, 50);
    const double px_per_tangent = 640 / std::tan(rad_from_deg(50));
    EXPECT_NEAR(picture_point(left, kSize, near).x, 640 + px_per_tangent * 0.063, 1e-3);
    EXPECT_NEAR(picture_point(right, kSize, near).x, 640 - px_per_tangent * 0.063, 1e-3);
}

TEST(EyeView, LinesOfSightComeBackToTheirPixelFromAnyEye) {
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
        XrView eye = eye_at(static_cast<float>(random.uniform(-0.1, 0.1)), random.uniform(20, 60),
                            random.uniform(20, 60));
        // Turned outwards by up to 20 degrees, as in headsets with canted displays.
        const double half_turn = rad_from_deg(random.uniform(-10, 10));
        eye.pose.orientation = {0, static_cast<float>(std::sin(half_turn)), 0,
                                static_cast<float>(std::cos(half_turn))};
        eye.pose.position.z = static_cast<float>(random.uniform(-0.05, 0.05));
        const PointPx px{random.uniform(200, 1080), random.uniform(0, 1440)};
        const double distance_m = random.uniform(0.3, 10);
        const Vector3 point = point_on_plane(eye, kSize, px, distance_m);
        if (std::isnan(point.x)) continue;
        EXPECT_DOUBLE_EQ(point.z, distance_m);
        const PointPx back = picture_point(eye, kSize, point);
        EXPECT_NEAR(back.x, px.x, 2e-3);
        EXPECT_NEAR(back.y, px.y, 2e-3);
    }
}

TEST(EyeView, BehindTheEyeThereIsNoPicture) {
    EXPECT_TRUE(std::isnan(picture_point(eye_at(0, 50, 50), kSize, {0.1, 0.1, -1}).x));
    XrView sideways = eye_at(0, 50, 50);
    sideways.pose.orientation = {0, std::sqrt(0.5f), 0, std::sqrt(0.5f)};  // a quarter turn
    EXPECT_TRUE(std::isnan(point_on_plane(sideways, kSize, {0, 720}, 1).x));
}

TEST(EyeView, ThePictureBetweenTheEyesKeepsThePixelsPerDegree) {
    const XrView eyes[] = {eye_at(-0.03f, 52, 48), eye_at(0.03f, 48, 52)};
    const ViewGeometry between = picture_between(eyes, kSize);
    EXPECT_EQ(between.size, kSize);
    const double tangents = std::tan(rad_from_deg(52)) + std::tan(rad_from_deg(48));
    EXPECT_NEAR(between.distance_px(), 1280 / tangents, 1e-3);
    // Far away both eyes see what the picture between them sees, shifted.
    const Vector3 far{100, 50, 1000};
    const double shift =
        picture_point(eyes[0], kSize, far).x - between.point_from_direction(direction_of(far)).x;
    EXPECT_NEAR(shift, 1280 * (std::tan(rad_from_deg(52)) / tangents - 0.5), 0.05);
}

}  // namespace
}  // namespace parafovea
