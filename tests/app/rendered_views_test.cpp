// Two eyes' pictures: mirrored frusta, each its own gaze point and its own sigma.
#include "app/rendered_views.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/scene.h"

namespace parafovea {
namespace {

constexpr SizePx kSize{400, 300};

SceneCamera some_camera() {
    return camera_looking({1, 2, 3}, {4, 1, -2}, 1.1f);
}

TwoEyes asymmetric() {
    TwoEyes eyes;
    parse_eye_fov("54,46,50,48", eyes);
    return eyes;
}

TEST(RenderedViews, EyesStandApartAndTheirFrustaMirrorEachOther) {
    const SceneCamera camera = some_camera();
    const TwoEyes two = asymmetric();
    const auto views = rendered_views(camera, kSize, {}, centre_of(kSize), &two);
    ASSERT_EQ(views.size(), 2U);
    const CameraView &left = views[0].view, &right = views[1].view;
    EXPECT_NEAR(left.tan_left, std::tan(rad_from_deg(54)), 1e-5);
    EXPECT_NEAR(left.tan_right, std::tan(rad_from_deg(46)), 1e-5);
    EXPECT_EQ(left.tan_left, right.tan_right);
    EXPECT_EQ(left.tan_right, right.tan_left);
    EXPECT_NEAR(right.tan_up, std::tan(rad_from_deg(50)), 1e-5);
    EXPECT_NEAR(right.tan_down, std::tan(rad_from_deg(48)), 1e-5);
    const glm::vec3 apart(right.world_from_eye[3] - left.world_from_eye[3]);
    EXPECT_NEAR(glm::length(apart), 0.063, 1e-5);
    // Along the camera's own x axis, to the right.
    EXPECT_NEAR(glm::dot(apart, glm::vec3(camera.world_from_camera[0])), 0.063, 1e-5);
}

TEST(RenderedViews, BothEyesLookAtOnePoint) {
    TwoEyes two = asymmetric();
    for (const double distance_m : {0.4, 2.0, 1e5}) {
        two.gaze_distance_m = distance_m;
        const auto views = rendered_views(some_camera(), kSize, {}, centre_of(kSize), &two);
        // A point straight ahead of the head lies to the right of the left eye's straight ahead.
        const double inward = 0.0315 / distance_m;
        const double width = std::tan(rad_from_deg(54)) + std::tan(rad_from_deg(46));
        EXPECT_NEAR(views[0].gaze.x, (std::tan(rad_from_deg(54)) + inward) / width * kSize.width, 1e-3);
        EXPECT_NEAR(views[0].gaze.x + views[1].gaze.x, kSize.width, 1e-3);
        EXPECT_NEAR(views[0].gaze.y, views[1].gaze.y, 1e-9);
    }
}

TEST(RenderedViews, TheOtherEyeIsDrawnCoarserAndOneViewIsTheDominantEyes) {
    const TwoEyes two;
    const RenderMethod method{"kfr", {{"sigma", 1.5}, {"sigma_other_eye", 2.5}}, {{"dominant_eye", "left"}}};
    const auto views = rendered_views(some_camera(), kSize, method, centre_of(kSize), &two);
    EXPECT_EQ(views[0].method.numbers.at("sigma"), 1.5);
    EXPECT_EQ(views[1].method.numbers.at("sigma"), 2.5);
    Eyes one = eyes_beside(some_camera(), kSize, two);
    one.views.pop_back();
    EXPECT_EQ(method_of_eye(one, 0, method).numbers.at("sigma"), 1.5);
    // Quad views: an outer and an inner pair.
    Eyes quad = eyes_beside(some_camera(), kSize, two);
    quad.views.insert(quad.views.end(), quad.views.begin(), quad.views.begin() + 2);
    EXPECT_EQ(method_of_eye(quad, 2, method).numbers.at("sigma"), 1.5);
    EXPECT_EQ(method_of_eye(quad, 3, method).numbers.at("sigma"), 2.5);
}

TEST(RenderedViews, WithoutAnglesEyesSeeAsTheCameraDoes) {
    const TwoEyes two;
    const auto one = rendered_views(some_camera(), kSize, {}, {10, 20}, nullptr);
    const auto both = rendered_views(some_camera(), kSize, {}, {10, 20}, &two);
    ASSERT_EQ(one.size(), 1U);
    EXPECT_EQ(one[0].gaze, (PointPx{10, 20}));
    EXPECT_NEAR(both[0].view.tan_left, one[0].view.tan_left, 1e-6);
    EXPECT_NEAR(both[1].view.tan_up, one[0].view.tan_up, 1e-6);
}

TEST(RenderedViews, RefusesAnglesThatAreNone) {
    TwoEyes eyes;
    for (const char* text : {"", "54", "54,46,50", "54,46,50,48,2", "54,46,50,90", "54,0,50,48", "a,b,c,d"})
        EXPECT_ANY_THROW(parse_eye_fov(text, eyes)) << text;
}

TEST(RenderedViews, LieSideBySide) {
    const Image a{{1, 2}, {1, 2, 3, 4, 5, 6, 7, 8}};
    const Image b{{2, 2}, {11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26}};
    const Image both = side_by_side({a, b});
    EXPECT_EQ(both.size, (SizePx{3, 2}));
    EXPECT_EQ(both.rgba, (std::vector<std::uint8_t>{1, 2, 3, 4, 11, 12, 13, 14, 15, 16, 17, 18,
                                                    5, 6, 7, 8, 19, 20, 21, 22, 23, 24, 25, 26}));
}

}  // namespace
}  // namespace parafovea
