// Whole frames of real scenes: methods agree where they must, culling changes nothing, costs are told.
#include "renderer/frame_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/scene_catalog.h"

namespace parafovea {
namespace {

RenderMethod kfr(std::map<std::string, double> numbers = {}) {
    return {"kfr", std::move(numbers), {}};
}

// Mean absolute difference of the colour values of pixels whose distance from a point is in [from, to).
double mean_difference(const Image& a, const Image& b, PointPx centre, double from_px, double to_px) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < a.size.height; ++y) {
        for (int x = 0; x < a.size.width; ++x) {
            const double r = std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y);
            if (r < from_px || r >= to_px) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t i = static_cast<std::size_t>(y * a.size.width + x) * 4 + c;
                sum += std::abs(a.rgba[i] - b.rgba[i]);
                ++count;
            }
        }
    }
    return sum / std::max(count, 1);
}

class FrameRendererScenes : public testing::TestWithParam<const char*> {};

TEST_P(FrameRendererScenes, KfrLooksLikeFullResolutionAndMostSoAtTheGaze) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene(GetParam());
    FrameRenderer renderer(gpu, scene);
    const SizePx size{640, 360};
    const CameraView view = view_through(scene.cameras[0], size);
    const PointPx gaze{400, 150};
    const Image full = renderer.render(size, view, {}, gaze).image;
    const Image foveated = renderer.render(size, view, kfr(), gaze).image;
    const auto [darkest, brightest] = std::ranges::minmax_element(full.rgba);
    EXPECT_GT(*brightest - *darkest, 60) << "an empty picture";
    EXPECT_LT(mean_difference(full, foveated, gaze, 0, 1e9), 24);
    EXPECT_LT(mean_difference(full, foveated, gaze, 0, 60), 12);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST_P(FrameRendererScenes, PictureIsBitByBitTheSameWithAndWithoutCullingAndFromRunToRun) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene(GetParam());
    FrameRenderer renderer(gpu, scene);
    const SizePx size{320, 180};
    const CameraView view = view_through(scene.cameras[0], size);
    const Image first = renderer.render(size, view, kfr(), {160, 90}).image;
    // Drawn in turn, so that what is not shaded holds the remains of other gazes.
    for (const bool in_compute : {false, true}) {
        FrameRenderer drawing(gpu, scene, {.shade_in_compute = in_compute});
        for (const PointPx gaze : {PointPx{160, 90}, PointPx{0, 0}, PointPx{320, 180}, PointPx{319.5, 0.4},
                                   PointPx{37.3, 120.6}, PointPx{-6, 90}, PointPx{900, -300}}) {
            for (const std::map<std::string, double>& numbers :
                 std::vector<std::map<std::string, double>>{{},
                                                            {{"alpha", 1}, {"sigma", 0.8}},
                                                            {{"as_printed", 1}},
                                                            {{"inset", 0.1}},
                                                            {{"taa", 3}}}) {
                RenderMethod culled = kfr(numbers), whole = kfr(numbers);
                whole.numbers["culling"] = 0;
                EXPECT_TRUE(drawing.render(size, view, culled, gaze).image ==
                            drawing.render(size, view, whole, gaze).image)
                    << gaze.x << ", " << gaze.y << (numbers.empty() ? "" : numbers.begin()->first)
                    << (in_compute ? " in compute" : "");
            }
        }
    }
    renderer.render({200, 100}, view_through(scene.cameras[0], SizePx{200, 100}), kfr({{"sigma", 2.4}}),
                    {0, 0});
    EXPECT_TRUE(renderer.render(size, view, kfr(), {160, 90}).image == first);
    FrameRenderer another(gpu, scene);
    EXPECT_TRUE(another.render(size, view, kfr(), {160, 90}).image == first);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST_P(FrameRendererScenes, TellWhatAFrameCost) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene(GetParam());
    FrameRenderer renderer(gpu, scene);
    const SizePx size{320, 180};
    const CameraView view = view_through(scene.cameras[0], size);
    const FrameStatistics full = renderer.render(size, view, {}, centre_of(size)).statistics;
    EXPECT_EQ(full.shaded_samples, 320U * 180U);
    EXPECT_EQ(full.screen_pixels, 320U * 180U);
    EXPECT_FALSE(full.device.empty());
    EXPECT_FALSE(full.driver.empty());
    EXPECT_FALSE(full.built.empty());
    EXPECT_GT(full.device_memory_bytes, 0U);
    const RenderedFrame frame = renderer.render(size, view, kfr(), centre_of(size), false);
    EXPECT_TRUE(frame.image.rgba.empty());
    EXPECT_EQ(frame.statistics.buffer, (SizePx{178, 100}));
    EXPECT_LT(frame.statistics.shaded_samples, full.shaded_samples / 3);
    double sum = 0;
    for (const PassTimer::Pass& pass : frame.statistics.passes) {
        EXPECT_GE(pass.ms, 0) << pass.name;
        if (pass.name != "total") sum += pass.ms;
    }
    EXPECT_GT(frame.statistics.pass_ms("pass_1"), 0);
    EXPECT_GT(frame.statistics.pass_ms("pass_2"), 0);
    EXPECT_LE(sum, frame.statistics.pass_ms("total") * 1.001);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, FrameRendererScenes, testing::Values("primitives", "atrium"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST_P(FrameRendererScenes, TexelsFinerThanPixelsTakeTheirPixelsLightWhichIsThatOfFullResolution) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene(GetParam());
    FrameRenderer renderer(gpu, scene);
    const SizePx size{640, 360};
    const CameraView view = view_through(scene.cameras.front(), size);
    // So fine near the gaze that all that a pixel there reads is inside it.
    const RenderMethod fine = kfr({{"sigma", 0.5}, {"internal_filter", 0}});
    for (const PointPx gaze : {PointPx{400, 150}, PointPx{0, 359.5}}) {
        const Image full = renderer.render(size, view, {}, gaze).image;
        const RenderedFrame foveated = renderer.render(size, view, fine, gaze);
        // But for the rounding of the buffer between.
        EXPECT_LT(mean_difference(full, foveated.image, gaze, 2, 40), 0.05);
        EXPECT_TRUE(std::ranges::find(foveated.statistics.built, "pixels for fine texels",
                                      &FeatureNote::name) != foveated.statistics.built.end());
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(FrameRenderer, ComputeShadersLightScenesAsFragmentsDo) {
    Gpu gpu({.validation = true});
    for (const char* name : {"primitives", "atrium"}) {
        const Scene scene = load_scene(name);
        const SizePx size{160, 120};
        const CameraView view = view_through(scene.cameras.front(), size);
        FrameRenderer fragments(gpu, scene, {.shade_in_compute = false});
        FrameRenderer compute(gpu, scene, {.shade_in_compute = true});
        const RenderMethod method{"kfr", {{"sigma", 1.8}, {"alpha", 4}}, {}};
        EXPECT_TRUE(fragments.render(size, view, method, {70, 50}).image ==
                    compute.render(size, view, method, {70, 50}).image)
            << name;
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(FrameRenderer, RefusesSizesAndMethodsInOneLine) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene("primitives");
    FrameRenderer renderer(gpu, scene);
    const auto message = [&](SizePx size, const RenderMethod& method) {
        try {
            renderer.render(size, view_through(scene.cameras[0], SizePx{64, 64}), method, {});
        } catch (const std::runtime_error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(message({0, 10}, {}).find("at least 1"), std::string::npos);
    EXPECT_NE(message({1 << 20, 10}, {}).find("too large"), std::string::npos);
    EXPECT_NE(message({64, 64}, {"kfz", {}, {}}).find("unknown method"), std::string::npos);
    // A refusal leaves the renderer fit for the next frame.
    EXPECT_EQ(message({64, 64}, kfr()), "");
    EXPECT_TRUE(gpu.validation_messages().empty());
}

}  // namespace
}  // namespace parafovea
