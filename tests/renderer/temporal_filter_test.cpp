// Anti-aliasing over time: a still picture is the mean of its frames, a moving one is followed, nothing
// broken is remembered.
#include "renderer/temporal_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "renderer/eye_dominance.h"
#include "renderer/frame_stages.h"
#include "renderer/methods/method_list.h"
#include "renderer/scene_catalog.h"
#include "renderer/temporal_view.h"
#include "tests/renderer/picture_method.h"

namespace parafovea {
namespace {

constexpr SizePx kSmall{96, 54};

RenderMethod with_taa(const std::string& name, double frames) {
    return {name, {{"taa", frames}}, {}};
}

double linear(double srgb) {
    const double v = srgb / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}
double srgb(double linear) {
    return 255 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055);
}

// Mean absolute difference of the colour values of pixels within a distance of a point.
double mean_difference(const Image& a, const Image& b, PointPx centre = {}, double radius_px = 1e9) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < a.size.height; ++y) {
        for (int x = 0; x < a.size.width; ++x) {
            if (std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y) > radius_px) continue;
            const std::size_t i = static_cast<std::size_t>(y * a.size.width + x) * 4;
            for (std::size_t c = 0; c < 3; ++c, ++count) sum += std::abs(a.rgba[i + c] - b.rgba[i + c]);
        }
    }
    return sum / count;
}

TEST(FrameStages, AreEveryMethodsAndRefuseWhatIsOutOfRange) {
    const auto refusal = [](const RenderMethod& method) {
        try {
            check(method);
        } catch (const std::runtime_error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    for (const MethodName& method : method_names()) {
        EXPECT_EQ(refusal({method.name, {{"taa", 8}, {"taa_alpha", 0.2}, {"contrast", 0.2}}, {}}), "");
        EXPECT_NE(refusal({method.name, {{"taa", 65}}, {}}).find("taa = 65"), std::string::npos);
        EXPECT_NE(refusal({method.name, {{"taa", 2.5}}, {}}).find("number of frames"), std::string::npos);
        EXPECT_NE(refusal({method.name, {{"taa_alpha", 0}}, {}}).find("taa_alpha"), std::string::npos);
        EXPECT_NE(refusal({method.name, {{"contrast", NAN}}, {}}).find("contrast"), std::string::npos);
    }
}

TEST(FrameStages, JitterVisitsEveryEighthAndEveryNinthOnceAndStaysInItsPixel) {
    std::set<int> eighths, ninths;
    for (int i = 0; i < 8; ++i) eighths.insert(static_cast<int>(std::floor((halton_jitter(i).x + 0.5) * 8)));
    // The radical inverse of 9 starts the next round.
    ninths.insert(0);
    for (int i = 0; i < 8; ++i)
        ninths.insert(static_cast<int>(std::floor((halton_jitter(i).y + 0.5) * 9 + 1e-4)));
    EXPECT_EQ(eighths.size(), 8U);
    EXPECT_EQ(ninths.size(), 9U);
    for (int i = 0; i < 64; ++i) {
        const Jitter jitter = halton_jitter(i);
        EXPECT_TRUE(jitter.x >= -0.5f && jitter.x < 0.5f && jitter.y >= -0.5f && jitter.y < 0.5f) << i;
    }
}

TEST(EyeDominance, OtherEyeGetsItsSigmaAndTheLeadingOneItsOwn) {
    const RenderMethod method{"kfr", {{"sigma", 2}, {"sigma_other_eye", 3}}, {{"dominant_eye", "left"}}};
    EXPECT_EQ(method_for_eye(method, Eye::left), (RenderMethod{"kfr", {{"sigma", 2}}, {}}));
    EXPECT_EQ(method_for_eye(method, Eye::right), (RenderMethod{"kfr", {{"sigma", 3}}, {}}));
    EXPECT_EQ(method_for_dominant_eye(method), method_for_eye(method, Eye::left));
    const RenderMethod right{"kfr", {{"sigma_other_eye", 3}}, {}};
    EXPECT_EQ(method_for_eye(right, Eye::left).numbers.at("sigma"), 3);
    EXPECT_EQ(method_for_eye(right, Eye::right).numbers.at("sigma"), 1.8);
    EXPECT_EQ(method_for_eye(with_taa("kfr", 8), Eye::left), with_taa("kfr", 8));
    check(method);
    EXPECT_THROW(check({"kfr", {{"sigma", 2}, {"sigma_other_eye", 1.5}}, {}}), std::runtime_error);
    EXPECT_THROW(check({"kfr", {}, {{"dominant_eye", "middle"}}}), std::runtime_error);
    EXPECT_THROW(check({"full", {{"sigma_other_eye", 3}}, {}}), std::runtime_error);
}

// Feeds a filter pictures of floats, which may hold anything.
class FilterOfFloats {
  public:
    explicit FilterOfFloats(Gpu& gpu)
        : gpu_(gpu),
          frame_(image(VK_FORMAT_R32G32B32A32_SFLOAT,
                       VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT)),
          target_(image(VK_FORMAT_R32G32B32A32_SFLOAT,
                        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT)),
          filter_(gpu, VK_FORMAT_R32G32B32A32_SFLOAT),
          spacing_(std::size_t{shared::kSpacingColumns} * shared::kSpacingRows, shared::vec2(1, 1)) {}

    std::vector<float> next(const std::vector<float>& rgba, const CameraView& view = {}) {
        upload(gpu_, frame_, std::as_bytes(std::span(rgba)));
        gpu_.submit_and_wait([&](VkCommandBuffer commands) {
            image_barrier(commands, target_, kUseNone, kUseColorTarget);
            filter_.record(commands,
                           {.frame = &frame_, .view = view, .spacing = &spacing_, .target = &target_});
        });
        const std::vector<std::byte> bytes = read_back(gpu_, target_, kUseColorTarget);
        std::vector<float> result(bytes.size() / sizeof(float));
        std::memcpy(result.data(), bytes.data(), bytes.size());
        return result;
    }

  private:
    GpuImage image(VkFormat format, VkImageUsageFlags usage) {
        return GpuImage(gpu_, {.format = format, .width = 16, .height = 16, .usage = usage});
    }

    Gpu& gpu_;
    GpuImage frame_, target_;
    TemporalFilter filter_;
    SpacingGrid spacing_;
};

TEST(TemporalFilter, WhatIsNotANumberNeverOutlivesItsFrame) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Gpu gpu({.validation = true});
    std::vector<float> clean(16 * 16 * 4, 0.25f);
    std::vector<float> broken = clean;
    for (const std::size_t pixel : {0, 17, 100, 101, 116, 117, 255}) {
        broken[pixel * 4] = kInfinity;
        broken[pixel * 4 + 1] = -kInfinity;
        broken[pixel * 4 + 2] = kNan;
    }
    std::vector<float> all_broken(clean.size(), kNan);
    CameraView turned;
    turned.world_from_eye[3] = glm::vec4(0.1f, 0, 0, 1);
    FilterOfFloats filter(gpu);
    // Broken at first, in the middle, wholly, while standing and while moving.
    EXPECT_TRUE(std::ranges::all_of(filter.next(all_broken), [](float v) { return std::isfinite(v); }));
    for (const CameraView& view : {CameraView{}, turned}) {
        for (const std::vector<float>* frame : {&broken, &clean, &broken, &broken, &all_broken, &clean}) {
            for (const float v : filter.next(*frame, view)) EXPECT_TRUE(std::isfinite(v));
        }
        const std::vector<float> after = filter.next(clean, view);
        for (std::size_t i = 0; i < after.size(); ++i) {
            if (i % 4 != 3) {
                EXPECT_NEAR(after[i], 0.25f, 1e-3f);
            }
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(TemporalFilter, StandingHistoryIsTheMeanUntilItsLengthAndThenForgetsExponentially) {
    Gpu gpu({.validation = true});
    FilterOfFloats filter(gpu);
    double mean = 0;
    for (int i = 0; i < 24; ++i) {
        const float value = i % 3 == 0 ? 0.9f : 0.1f;
        const double weight = std::max(1.0 / (i + 1), 0.1);
        mean += weight * (value - mean);
        EXPECT_NEAR(filter.next(std::vector<float>(16 * 16 * 4, value))[340], mean, 2e-3) << i;
    }
}

TEST(MovingView, StandingStillIsTheStillPictureBitForBitAndACutStartsAgain) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene("primitives");
    FrameRenderer renderer(gpu, scene);
    const CameraView view = view_through(scene.cameras[0], kSmall);
    const PointPx gaze{40, 20};
    for (const char* name : {"full", "kfr"}) {
        MovingView moving(renderer);
        Image third;
        for (int i = 0; i < 3; ++i) third = moving.render(kSmall, view, with_taa(name, 3), gaze).image;
        const Image still = renderer.render(kSmall, view, with_taa(name, 3), gaze).image;
        EXPECT_TRUE(third == still) << name;
        EXPECT_FALSE(renderer.render(kSmall, view, {name, {}, {}}, gaze).image == still);
        moving.cut();
        EXPECT_TRUE(moving.render(kSmall, view, with_taa(name, 3), gaze).image ==
                    renderer.render(kSmall, view, with_taa(name, 1), gaze).image);
        // Whatever was drawn before.
        EXPECT_TRUE(renderer.render(kSmall, view, with_taa(name, 3), gaze).image == still);
    }
    const FrameStatistics once = renderer.render(kSmall, view, {"kfr", {}, {}}, gaze).statistics;
    const FrameStatistics often = renderer.render(kSmall, view, with_taa("kfr", 4), gaze).statistics;
    EXPECT_NEAR(static_cast<double>(often.shaded_samples), 4.0 * static_cast<double>(once.shaded_samples),
                0.1 * static_cast<double>(once.shaded_samples));
    EXPECT_GT(often.pass_ms("post"), 0);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(FrameRenderer, StillPictureIsTheMeanOfItsJitteredFrames) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene("primitives");
    FrameRenderer renderer(gpu, scene);
    const CameraView view = view_through(scene.cameras[0], kSmall);
    const int frames = 5;
    std::vector<double> sum(static_cast<std::size_t>(kSmall.width) * kSmall.height * 4);
    for (int i = 0; i < frames; ++i) {
        CameraView shifted = view;
        shifted.jitter_px = {halton_jitter(i).x, halton_jitter(i).y};
        const Image frame = renderer.render(kSmall, shifted, {}, {}).image;
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += linear(frame.rgba[k]) / frames;
    }
    const Image mean = renderer.render(kSmall, view, with_taa("full", frames), {}).image;
    for (std::size_t k = 0; k < sum.size(); ++k) {
        if (k % 4 != 3) {
            EXPECT_NEAR(mean.rgba[k], srgb(sum[k]), 1.01) << k;
        }
    }
}

class MovingScenes : public testing::TestWithParam<const char*> {};

TEST_P(MovingScenes, HistoryFollowsTheCamera) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene(GetParam());
    FrameRenderer renderer(gpu, scene);
    const SizePx size{160, 90};
    MovingView moving(renderer);
    CameraView view;
    Image last;
    for (int i = 0; i < 6; ++i) {
        view = view_through(camera_on_path(scene, 1 + 0.02f * static_cast<float>(i)), size);
        last = moving.render(size, view, with_taa("full", 8), {}).image;
    }
    const Image wanted = renderer.render(size, view, {"full", {{"taa", 10}}, {}}, {}).image;
    const Image aliased = renderer.render(size, view, {}, {}).image;
    EXPECT_LT(mean_difference(last, wanted), 0.75 * mean_difference(aliased, wanted));
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, MovingScenes, testing::Values("primitives", "atrium"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(MovingView, AfterASaccadeTheNewFoveaIsSharpAtOnce) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene("primitives");
    FrameRenderer renderer(gpu, scene);
    const SizePx size{320, 180};
    const CameraView view = view_through(scene.cameras[0], size);
    const RenderMethod method{"kfr", {{"taa", 8}, {"sigma", 3}}, {}};
    const PointPx from{30, 90}, to{230, 110};
    MovingView moving(renderer);
    Image before;
    for (int i = 0; i < 8; ++i) before = moving.render(size, view, method, from).image;
    moving.render(size, view, method, to);
    const Image after = moving.render(size, view, method, to).image;
    const Image settled = renderer.render(size, view, method, to).image;
    const double stale = mean_difference(before, settled, to, 25);
    EXPECT_GT(stale, 2);
    EXPECT_LT(mean_difference(after, settled, to, 25), 0.5 * stale);
}

}  // namespace
}  // namespace parafovea
