// The eyes of a headset as they are kept with a session.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "app/eye_pictures.h"
#include "devices/random.h"

namespace parafovea {
namespace {

Eyes some_eyes(std::uint64_t seed, std::size_t count) {
    Random random(seed);
    Eyes eyes;
    eyes.gaze_distance_m = random.uniform(0.3, 10);
    const auto any = [&random] { return static_cast<float>(random.uniform(-1, 1)); };
    for (std::size_t i = 0; i < count; ++i) {
        XrView view{XR_TYPE_VIEW, nullptr, {}, {}};
        view.pose = {{any(), any(), any(), any()}, {any(), any(), any()}};
        view.fov = {any(), any(), any(), any()};
        eyes.views.push_back(view);
        eyes.sizes.push_back(
            {1 + static_cast<int>(random.below(4096)), 1 + static_cast<int>(random.below(4096))});
    }
    return eyes;
}

TEST(Eyes, ReadBackBitForBit) {
    for (std::uint64_t seed = 0; seed < 100; ++seed)
        for (std::size_t count = 1; count <= 4; ++count) {
            const Eyes eyes = some_eyes(seed, count);
            const Eyes back = parse_eyes(to_text(eyes));
            EXPECT_EQ(back.gaze_distance_m, eyes.gaze_distance_m);
            EXPECT_EQ(back.sizes, eyes.sizes);
            EXPECT_TRUE(nearly_same(back.views, eyes.views));
            EXPECT_EQ(to_text(back), to_text(eyes));
        }
}

TEST(Eyes, EveryCutLineIsRefused) {
    const std::string line = to_text(some_eyes(1, 2));
    for (std::size_t length = 0; length < line.rfind(' '); ++length)
        EXPECT_THROW(parse_eyes(std::string_view(line).substr(0, length)), std::runtime_error) << length;
    EXPECT_THROW(parse_eyes("5 2"), std::runtime_error);
    EXPECT_THROW(parse_eyes("1 2 0 100 0 0 0 1 0 0 0 -1 1 1 -1"), std::runtime_error);
    EXPECT_THROW(parse_eyes("eyes"), std::runtime_error);
}

TEST(Eyes, WhatARuntimesRoundingLeavesIsNoMovement) {
    const Eyes eyes = some_eyes(2, 2);
    std::vector<XrView> moved = eyes.views;
    moved[1].pose.position.x += 5e-5f;
    moved[0].pose.orientation.y -= 5e-5f;
    EXPECT_TRUE(nearly_same(eyes.views, moved));
    moved[1].pose.position.x += 5e-4f;
    EXPECT_FALSE(nearly_same(eyes.views, moved)) << "half a millimetre is somebody's hand on the wheel";
    EXPECT_FALSE(nearly_same(eyes.views, {}));
}

TEST(Eyes, BothEyesAreLedToOnePoint) {
    Eyes eyes;
    for (const float side : {-1.f, 1.f}) {
        XrView view{XR_TYPE_VIEW, nullptr, {{0, 0, 0, 1}, {side * 0.032f, 0, 0}}, {-0.8f, 0.8f, 0.8f, -0.8f}};
        eyes.views.push_back(view);
        eyes.sizes.push_back({1000, 1000});
    }
    // Where the lines of sight through both gaze points come nearest to the plane of the gaze distance.
    const PointPx looked_at = eyes.view().point_from_direction({-7, 11});
    const Vector3 left = point_on_plane(eyes.views[0], eyes.sizes[0], eyes.seen_at(0, looked_at), 2);
    const Vector3 right = point_on_plane(eyes.views[1], eyes.sizes[1], eyes.seen_at(1, looked_at), 2);
    EXPECT_NEAR(left.x, right.x, 1e-6);
    EXPECT_NEAR(left.y, right.y, 1e-6);
    const DirectionDeg direction = direction_of(left);
    EXPECT_NEAR(direction.azimuth_deg, -7, 1e-4);
    EXPECT_NEAR(direction.elevation_deg, 11, 1e-4);
}

}  // namespace
}  // namespace parafovea
