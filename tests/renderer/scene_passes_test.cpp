// What the passes put on the picture: geometry where the camera says, light as the equations say.
#include "renderer/scene_passes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "renderer/frame_renderer.h"
#include "renderer/scene_tangents.h"

namespace parafovea {
namespace {

int add_material(Scene& scene, glm::vec3 color, float metallic, float roughness) {
    Material m;
    m.base_color = glm::vec4(color, 1);
    m.metallic = metallic;
    m.roughness = roughness;
    scene.materials.push_back(m);
    return static_cast<int>(scene.materials.size()) - 1;
}

// A square of side 2 around the origin, facing +z.
void add_square(Scene& scene, int material, const glm::mat4& world) {
    Triangles square;
    for (const auto& [x, y] : {std::pair{-1.0f, -1.0f}, {1.0f, -1.0f}, {1.0f, 1.0f}, {-1.0f, 1.0f}}) {
        SceneVertex v;
        v.position = {x, y, 0};
        v.normal = {0, 0, 1};
        square.vertices.push_back(v);
    }
    square.indices = {0, 1, 2, 0, 2, 3};
    scene.instances.push_back({append_mesh(scene, square, material), world});
}

glm::mat4 moved(float x, float y, float z, float scale = 1) {
    glm::mat4 m{scale};
    m[3] = {x, y, z, 1};
    return m;
}

// Black sky, sun straight behind the camera, which looks along -z from z = 5.
Scene dark_scene() {
    Scene scene;
    scene.sky = Sky{glm::vec3(0), glm::vec3(0), glm::vec3(0)};
    scene.sun = Sun{{0, 0, 1}, glm::vec3(2), true};
    scene.cameras.push_back(camera_looking({0, 0, 5}, {0, 0, 0}, 0.6f));
    return scene;
}

Image render(Gpu& gpu, const Scene& scene, SizePx size) {
    FrameRenderer renderer(gpu, scene);
    return renderer.render(size, view_through(scene.cameras[0], size), {}, centre_of(size)).image;
}

double linear_of(std::uint8_t byte) {
    const double s = byte / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

const std::uint8_t* pixel(const Image& image, int x, int y) {
    return &image.rgba[static_cast<std::size_t>(y * image.size.width + x) * 4];
}

// The tone curve, the BRDF and the encoding once more, in double, from their papers.
double tone(double x) {
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

double head_on_radiance(double color, double metallic, double roughness, double irradiance) {
    const double f0 = 0.04 * (1 - metallic) + color * metallic;
    const double alpha = roughness * roughness;
    const double distribution = 1 / (std::numbers::pi * alpha * alpha);  // n = h
    const double specular = distribution * f0 / 4;                       // G = 1 at normal incidence
    return ((1 - metallic) * (1 - f0) * color / std::numbers::pi + specular) * irradiance;
}

class HeadOn : public testing::TestWithParam<std::tuple<float, float>> {};

TEST_P(HeadOn, SurfacesShineAsTheMicrofacetModelSays) {
    const auto [metallic, roughness] = GetParam();
    Gpu gpu({.validation = true});
    Scene scene = dark_scene();
    const glm::vec3 color{0.25f, 0.49f, 0.81f};
    add_square(scene, add_material(scene, color, metallic, roughness), glm::mat4(1));
    const Image image = render(gpu, scene, {65, 65});
    for (int c = 0; c < 3; ++c) {
        const double expected = tone(head_on_radiance(color[c], metallic, roughness, 2));
        EXPECT_NEAR(linear_of(pixel(image, 32, 32)[c]), expected, 0.012 + 0.02 * expected) << c;
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

INSTANTIATE_TEST_SUITE_P(Materials, HeadOn,
                         testing::Combine(testing::Values(0.0f, 1.0f), testing::Values(0.4f, 0.7f, 1.0f)));

TEST(Picture, ShowsASquareWhereTheProjectionPutsIt) {
    Gpu gpu({.validation = true});
    Scene scene = dark_scene();
    add_square(scene, add_material(scene, glm::vec3(0.9f), 0, 1), moved(0.5f, 0.25f, 0, 0.5f));
    const SizePx size{128, 96};
    const Image image = render(gpu, scene, size);
    // Half the picture's height lies tan(0.3) from the axis.
    const double px_per_tan = 48 / std::tan(0.3);
    int wrong = 0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const double wx = (x + 0.5 - 64) / px_per_tan * 5, wy = (48 - y - 0.5) / px_per_tan * 5;
            const bool inside = wx > 0 && wx < 1 && wy > -0.25 && wy < 0.75;
            wrong += (pixel(image, x, y)[0] > 20) != inside;
        }
    }
    EXPECT_EQ(wrong, 0);
}

TEST(Picture, IsDarkInTheShadowAndNowhereElse) {
    Gpu gpu({.validation = true});
    Scene scene = dark_scene();
    const int grey = add_material(scene, glm::vec3(0.5f), 0, 1);
    add_square(scene, grey, glm::mat4(1));
    // A small square nearer to the sun, beside the line of sight: its shadow falls around (0.5, 0) on the
    // large one.
    scene.sun->direction = glm::normalize(glm::vec3(0.5f, 0, 1));
    add_square(scene, grey, moved(1.0f, 0, 1, 0.2f));
    const SizePx size{200, 200};
    const Image image = render(gpu, scene, size);
    const auto at = [&](double x, double y) {
        const double px_per_m = 100 / std::tan(0.3) / 5;
        return pixel(image, static_cast<int>(100 + x * px_per_m), static_cast<int>(100 - y * px_per_m))[1];
    };
    EXPECT_LT(at(0.5, 0), 4);
    EXPECT_LT(at(0.5, 0.12), 4);
    for (double x : {-0.9, -0.5, 0.0, 0.2}) EXPECT_GT(at(x, 0), 60) << x;
    EXPECT_GT(at(0.5, 0.4), 60);
    EXPECT_GT(at(0.5, -0.4), 60);
}

TEST(Picture, LightsLampsByInverseSquareAndCone) {
    Gpu gpu({.validation = true});
    Scene scene = dark_scene();
    scene.sun.reset();
    add_square(scene, add_material(scene, glm::vec3(0.8f), 0, 1), moved(0, 0, 0, 2));
    PunctualLight lamp;
    lamp.kind = LightKind::spot;
    lamp.position = {0, 0, 2};
    lamp.direction = {0, 0, -1};
    lamp.intensity = glm::vec3(6);
    lamp.inner_cone_rad = 0.2f;
    lamp.outer_cone_rad = 0.4f;
    scene.lights.push_back(lamp);
    const Image image = render(gpu, scene, {101, 101});
    const double expected = tone(head_on_radiance(0.8, 0, 1, 6.0 / 4));
    EXPECT_NEAR(linear_of(pixel(image, 50, 50)[1]), expected, 0.02);
    EXPECT_EQ(pixel(image, 99, 50)[1], 0) << "outside the cone";
}

TEST(Picture, IsDarkWhereALampIsHidden) {
    Gpu gpu({.validation = true});
    Scene scene = dark_scene();
    scene.sun.reset();
    const int grey = add_material(scene, glm::vec3(0.8f), 0, 1);
    add_square(scene, grey, glm::mat4(1));
    add_square(scene, grey, moved(0.55f, 0, 1, 0.1f));  // halfway between the lamp and the large square
    PunctualLight lamp;
    lamp.kind = LightKind::spot;
    lamp.position = {0.5f, 0, 2};
    lamp.direction = {0, 0, -1};
    lamp.intensity = glm::vec3(6);
    lamp.range_m = 10;
    lamp.outer_cone_rad = 0.9f;
    lamp.inner_cone_rad = 0.8f;
    const auto at = [](const Image& image, double x) {
        const double px_per_m = 100 / std::tan(0.3) / 5;
        return pixel(image, static_cast<int>(100 + x * px_per_m), 100)[1];
    };
    scene.lights = {lamp};
    const Image open = render(gpu, scene, {200, 200});
    scene.lights[0].casts_shadow = true;
    const Image shadowed = render(gpu, scene, {200, 200});
    // The shadow spans x from 0.4 to 0.8; from z = 5 the small square hides what lies beyond 0.56.
    EXPECT_GT(at(open, 0.48), 60);
    EXPECT_LT(at(shadowed, 0.48), 8);
    EXPECT_NEAR(at(shadowed, 0.0), at(open, 0.0), 2);
    EXPECT_NEAR(at(shadowed, -0.6), at(open, -0.6), 2);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(Picture, ShowsWhatLiesBehindGlass) {
    Gpu gpu({.validation = true});
    Scene scene = dark_scene();
    add_square(scene, add_material(scene, glm::vec3(0.0f, 0.8f, 0.0f), 0, 1), glm::mat4(1));
    const int glass = add_material(scene, glm::vec3(1.0f, 0.0f, 0.0f), 0, 1);
    scene.materials[static_cast<std::size_t>(glass)].alpha_mode = AlphaMode::blend;
    scene.materials[static_cast<std::size_t>(glass)].base_color.w = 0.25f;
    add_square(scene, glass, moved(0, 0, 1, 0.5f));
    const Image image = render(gpu, scene, {101, 101});
    const std::uint8_t *through = pixel(image, 50, 50), *beside = pixel(image, 80, 50);
    EXPECT_GT(through[0], beside[0] + 20) << "the glass is red";
    EXPECT_LT(through[1], beside[1]) << "and takes some of the green";
    EXPECT_GT(through[1], beside[1] / 2) << "but not most of it";
}

TEST(Passes, BuildOnlyWhatTheSceneNeeds) {
    Gpu gpu({.validation = true});
    Scene scene = dark_scene();
    add_square(scene, add_material(scene, glm::vec3(0.5f), 0, 1), glm::mat4(1));
    const auto has = [](const std::vector<FeatureNote>& notes, const std::string& name) {
        return std::any_of(notes.begin(), notes.end(), [&](const FeatureNote& n) { return n.name == name; });
    };
    const ScenePasses plain(gpu, scene);
    EXPECT_TRUE(has(plain.built(), "shadow map"));
    EXPECT_TRUE(has(plain.left_out(), "blended layer"));
    EXPECT_TRUE(has(plain.left_out(), "lamps"));
    scene.sun->casts_shadow = false;
    scene.materials[0].alpha_mode = AlphaMode::blend;
    const ScenePasses glass(gpu, scene);
    EXPECT_TRUE(has(glass.left_out(), "shadow map"));
    EXPECT_TRUE(has(glass.built(), "blended layer"));
    const ScenePasses everything(gpu, scene, {.force_everything = true});
    EXPECT_TRUE(has(everything.built(), "shadow map"));
    EXPECT_GT(everything.built().size(), glass.built().size());
}

TEST(Passes, ForcedOnChangeNothingOnThePicture) {
    Gpu gpu({.validation = true});
    Scene scene = dark_scene();
    add_square(scene, add_material(scene, glm::vec3(0.3f, 0.5f, 0.7f), 0, 0.5f), glm::mat4(1));
    const SizePx size{64, 64};
    const CameraView view = view_through(scene.cameras[0], size);
    FrameRenderer lean(gpu, scene), full(gpu, scene, {.force_everything = true});
    EXPECT_EQ(lean.render(size, view, {}, {32, 32}).image, full.render(size, view, {}, {32, 32}).image);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(Passes, DrawOnlyInstancesThatMayBeSeen) {
    Gpu gpu;
    Scene scene = dark_scene();
    const int grey = add_material(scene, glm::vec3(0.5f), 0, 1);
    add_square(scene, grey, glm::mat4(1));
    add_square(scene, grey, moved(0, 0, 20));  // behind the camera
    add_square(scene, grey, moved(50, 0, 0));  // far to the right
    ScenePasses passes(gpu, scene);
    passes.set_view({64, 64}, view_through(scene.cameras[0], SizePx{64, 64}));
    EXPECT_EQ(passes.triangles_in_view(), 2u);
}

TEST(Passes, ListWhatTheLastViewShowsWhetherOrNotItWasDrawn) {
    Gpu gpu;
    Scene scene = dark_scene();
    const int grey = add_material(scene, glm::vec3(0.5f), 0, 1);
    for (int i = 0; i < 3; ++i) add_square(scene, grey, moved(0, 0, -static_cast<float>(i)));
    add_square(scene, grey, moved(0, 0, 20));  // behind the camera
    ScenePasses passes(gpu, scene);
    const SizePx size{64, 64};
    const CameraView ahead = view_through(scene.cameras[0], size);
    CameraView back = ahead;
    back.world_from_eye = glm::rotate(ahead.world_from_eye, std::numbers::pi_v<float>, {0, 1, 0});
    const auto triangles = [&](const CameraView& view, bool draw) {
        passes.set_view(size, view);
        if (draw) gpu.submit_and_wait([&](VkCommandBuffer commands) { passes.record(commands, nullptr); });
        return passes.triangles_in_view();
    };
    EXPECT_EQ(triangles(ahead, true), 6u);
    EXPECT_EQ(triangles(ahead, false), 6u);
    EXPECT_EQ(triangles(back, false), 2u);
    EXPECT_EQ(triangles(ahead, false), 6u) << "though the targets hold this view";
    EXPECT_EQ(triangles(back, true), 2u);
}

// Blended words are not cleared: what an earlier view left there must not show.
TEST(Passes, ForgetTheGlassOfAnEarlierView) {
    Gpu gpu({.validation = true});
    Scene scene = dark_scene();
    add_square(scene, add_material(scene, {0.0f, 0.8f, 0.0f}, 0, 1), glm::mat4(1));
    const int glass = add_material(scene, {1.0f, 0.0f, 0.0f}, 0, 1);
    scene.materials[static_cast<std::size_t>(glass)].alpha_mode = AlphaMode::blend;
    scene.materials[static_cast<std::size_t>(glass)].base_color.w = 0.25f;
    add_square(scene, glass, moved(0, 0, 1, 0.5f));
    const SizePx size{64, 64};
    const CameraView view = view_through(scene.cameras[0], size);
    CameraView aside = view;
    aside.world_from_eye[3].x += 0.6f;
    FrameRenderer renderer(gpu, scene);
    const Image before = renderer.render(size, view, {}, centre_of(size)).image;
    const Image after = renderer.render(size, aside, {}, centre_of(size)).image;
    EXPECT_TRUE(after == FrameRenderer(gpu, scene).render(size, aside, {}, centre_of(size)).image);
    EXPECT_FALSE(after == before);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(Passes, DrawTheGeometryOfAStillViewOnceAndOfAnotherAnew) {
    Gpu gpu({.validation = true});
    Scene scene = dark_scene();
    add_square(scene, add_material(scene, {0.8f, 0.4f, 0.2f}, 0, 0.6f), moved(0.2f, -0.1f, 0, 0.7f));
    FrameRenderer renderer(gpu, scene);
    const SizePx size{80, 60}, other_size{60, 80};
    const CameraView view = view_through(scene.cameras[0], size);
    CameraView moved_view = view;
    moved_view.world_from_eye[3].x += 0.3f;
    const auto frame = [&](SizePx s, const CameraView& v) { return renderer.render(s, v, {}, centre_of(s)); };
    const auto fresh = [&](SizePx s, const CameraView& v) {
        return FrameRenderer(gpu, scene).render(s, v, {}, centre_of(s)).image;
    };
    EXPECT_GT(frame(size, view).statistics.pass_ms("defer"), 0);
    const RenderedFrame again = frame(size, view);
    EXPECT_EQ(again.statistics.pass_ms("defer"), 0);
    EXPECT_TRUE(again.image == fresh(size, view));
    EXPECT_TRUE(frame(size, moved_view).image == fresh(size, moved_view));
    EXPECT_TRUE(frame(other_size, moved_view).image == fresh(other_size, moved_view));
    EXPECT_TRUE(frame(size, view).image == fresh(size, view));

    FrameRenderer forgetful(gpu, scene, {.keep_geometry = false});
    forgetful.render(size, view, {}, centre_of(size));
    EXPECT_GT(forgetful.render(size, view, {}, centre_of(size)).statistics.pass_ms("defer"), 0);
    EXPECT_TRUE(gpu.validation_messages().empty());
}

TEST(CameraBlock, SendsEveryPixelsRayThroughThatPixel) {
    CameraView view;
    view.world_from_eye = camera_looking({1, 2, 3}, {-4, 1, 0}, 1).world_from_camera;
    view.tan_left = 0.9f;
    view.tan_right = 1.3f;
    view.tan_up = 0.8f;
    view.tan_down = 1.1f;
    view.jitter_px = {0.3, -0.2};
    const SizePx size{640, 400};
    const shared::Camera block = camera_block(view, size);
    const glm::mat4 matrix = clip_from_world(view, size);
    for (const PointPx p : {PointPx{0, 0}, {640, 400}, {320, 200}, {17.5, 311.25}}) {
        for (float distance : {0.1f, 1.0f, 500.0f}) {
            const auto along = [&](float o, float x, float y) {
                return o + static_cast<float>(p.x) * x + static_cast<float>(p.y) * y;
            };
            const glm::vec3 ray{along(block.ray_origin.x, block.ray_per_px_x.x, block.ray_per_px_y.x),
                                along(block.ray_origin.y, block.ray_per_px_x.y, block.ray_per_px_y.y),
                                along(block.ray_origin.z, block.ray_per_px_x.z, block.ray_per_px_y.z)};
            const glm::vec4 clip = matrix * glm::vec4(glm::vec3(1, 2, 3) + distance * ray, 1);
            EXPECT_NEAR((clip.x / clip.w * 0.5 + 0.5) * 640, p.x, 0.02);
            EXPECT_NEAR((clip.y / clip.w * 0.5 + 0.5) * 400, p.y, 0.02);
            EXPECT_NEAR(clip.z / clip.w * distance, view.near_m, 1e-4);
        }
    }
}

}  // namespace
}  // namespace parafovea
