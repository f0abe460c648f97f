// The kernel log-polar map: against the oracle, by round trip, at its extremes, and C++ against the device.
#include "renderer/shared/kernel_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "devices/random.h"
#include "renderer/gpu_pipeline.h"
#include "renderer/kernel_setting.h"
#include "shader_code/kernel_map_points.h"
#include "tests/renderer/kernel_map_oracle.h"

namespace parafovea {
namespace {

using shared::KernelMap;
using shared::vec2;

std::vector<KernelSetting> every_kernel() {
    std::vector<KernelSetting> settings;
    for (const bool as_printed : {false, true}) {
        for (const double alpha : {0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
            settings.push_back({.alpha = alpha, .as_printed = as_printed});
        }
        settings.push_back(
            {.kind = KernelKind::polynomial, .betas = {0.2, 0.3, 0, 0.5}, .as_printed = as_printed});
        settings.push_back({.kind = KernelKind::polynomial,
                            .betas = {0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.3},
                            .as_printed = as_printed});
        settings.push_back({.kind = KernelKind::sine, .as_printed = as_printed});
        settings.push_back({.kind = KernelKind::exponential, .as_printed = as_printed});
    }
    settings.push_back({.kind = KernelKind::linear_mar});
    settings.push_back({.kind = KernelKind::linear_mar,
                        .width_scale = 0.31,
                        .height_scale = 1.4,
                        .mar_slope = 40,
                        .mar_start = 0});
    return settings;
}

struct Place {
    const char* name;
    SizePx screen;
    PointPx gaze;
};

std::vector<Place> places() {
    return {{"centre, on a pixel corner", {1280, 720}, {640, 360}},
            {"on a pixel centre", {1280, 720}, {640.5, 360.5}},
            {"anywhere", {1281, 719}, {311.25, 517.875}},
            {"top left corner", {1280, 720}, {0, 0}},
            {"bottom right corner", {1280, 720}, {1280, 720}},
            {"left edge", {1280, 720}, {0, 360.5}},
            {"500 px to the left", {1280, 720}, {-500, 360}},
            {"500 px below", {1280, 720}, {640, 1220}},
            {"4K", {3840, 2160}, {1920, 1080}},
            {"one pixel", {1, 1}, {0.5, 0.5}},
            {"one column", {1, 300}, {0.5, 20}}};
}

std::string describe(const Place& place, const KernelSetting& setting) {
    return std::string(place.name) + ", " + name_of(setting.kind) + " alpha " +
           std::to_string(setting.alpha) + (setting.as_printed ? " as printed" : "");
}

// Points all over the screen and around the gaze, pixel centres and others.
std::vector<vec2> screen_points(const Place& place, int count) {
    Random random(7);
    std::vector<vec2> points{{0.5f, 0.5f},
                             {static_cast<float>(place.gaze.x), static_cast<float>(place.gaze.y)}};
    for (int i = 0; i < count; ++i) {
        const double x = random.uniform() * place.screen.width, y = random.uniform() * place.screen.height;
        points.push_back({static_cast<float>(std::floor(x) + 0.5), static_cast<float>(std::floor(y) + 0.5)});
        points.push_back({static_cast<float>(x), static_cast<float>(y)});
        // Near the gaze, at every order of magnitude.
        const double r = std::exp(random.uniform() * 8 - 3), turn = random.uniform() * 6.2831853;
        points.push_back({static_cast<float>(place.gaze.x + r * std::cos(turn)),
                          static_cast<float>(place.gaze.y + r * std::sin(turn))});
    }
    return points;
}

std::vector<vec2> buffer_points(const KernelMap& map, int count) {
    Random random(8);
    std::vector<vec2> points{{0, 0}, {map.buffer_size.x, map.buffer_size.y}, {0.5f, 0.5f}};
    for (int i = 0; i < count; ++i) {
        const float u = static_cast<float>(random.uniform()) * map.buffer_size.x;
        const float v = static_cast<float>(random.uniform()) * map.buffer_size.y;
        points.push_back({std::floor(u) + 0.5f, std::floor(v) + 0.5f});
        points.push_back({u, v});
    }
    return points;
}

// How far the map may carry an error of a few units in the last place: where a kernel is steep (the fovea of
// the printed direction, small alpha), more.
double tolerance_texels(const oracle::Map& truth, oracle::Position p) {
    const double step =
        4e-7 * std::hypot(truth.gaze.x, truth.gaze.y) + 4e-7 * std::hypot(truth.screen.width, 1.0);
    double most = 0;
    const oracle::Position here = truth.to_buffer(p);
    for (const oracle::Position q : {oracle::Position{p.x + step, p.y}, oracle::Position{p.x - step, p.y},
                                     oracle::Position{p.x, p.y + step}, oracle::Position{p.x, p.y - step}}) {
        const oracle::Position there = truth.to_buffer(q);
        most = std::fmax(most, std::abs(static_cast<double>(there.x - here.x)));
        most = std::fmax(most, static_cast<double>(oracle::wrapped_difference(there.y, here.y, truth.h())));
    }
    return most;
}

TEST(KernelMap, ScreenToBufferFollowsTheEquations) {
    for (const Place& place : places()) {
        for (const KernelSetting& setting : every_kernel()) {
            SCOPED_TRACE(describe(place, setting));
            const KernelMap map = make_kernel_map(place.screen, place.gaze, setting);
            const oracle::Map truth{place.screen, place.gaze, setting};
            ASSERT_EQ(map.buffer_size.x, static_cast<float>(truth.w()));
            ASSERT_EQ(map.buffer_size.y, static_cast<float>(truth.h()));
            EXPECT_NEAR(map.log_max_radius, static_cast<double>(truth.log_radius), 1e-6);
            for (const vec2 p : screen_points(place, 40)) {
                const vec2 found = buffer_from_screen(map, p);
                const oracle::Position wanted = truth.to_buffer({p.x, p.y});
                double tolerance = 2e-3 * std::fmax(1.0, setting.alpha);
                const double off =
                    std::fmax(std::abs(found.x - static_cast<double>(wanted.x)),
                              static_cast<double>(oracle::wrapped_difference(found.y, wanted.y, truth.h())));
                if (off > tolerance) tolerance += 4 * tolerance_texels(truth, {p.x, p.y});
                EXPECT_LE(off, tolerance) << p.x << ", " << p.y;
            }
        }
    }
}

TEST(KernelMap, BufferToScreenFollowsTheEquations) {
    for (const Place& place : places()) {
        for (const KernelSetting& setting : every_kernel()) {
            SCOPED_TRACE(describe(place, setting));
            const KernelMap map = make_kernel_map(place.screen, place.gaze, setting);
            const oracle::Map truth{place.screen, place.gaze, setting};
            for (const vec2 p : buffer_points(map, 40)) {
                const vec2 found = screen_from_buffer(map, p);
                const oracle::Position wanted = truth.to_screen({p.x, p.y});
                const double radius = std::hypot(static_cast<double>(wanted.x) - place.gaze.x,
                                                 static_cast<double>(wanted.y) - place.gaze.y);
                const double tolerance = 1e-3 + 4e-6 * radius;
                EXPECT_NEAR(found.x, static_cast<double>(wanted.x), tolerance) << p.x << ", " << p.y;
                EXPECT_NEAR(found.y, static_cast<double>(wanted.y), tolerance) << p.x << ", " << p.y;
            }
        }
    }
}

TEST(KernelMap, RoundTripReturnsToThePixel) {
    for (const Place& place : places()) {
        for (const KernelSetting& setting : every_kernel()) {
            SCOPED_TRACE(describe(place, setting));
            const KernelMap map = make_kernel_map(place.screen, place.gaze, setting);
            for (const vec2 p : screen_points(place, 25)) {
                if (std::hypot(p.x - place.gaze.x, p.y - place.gaze.y) < 1.5 + map.mar_start) continue;
                if (p.x < 0 || p.y < 0 || p.x > map.screen_size.x || p.y > map.screen_size.y) continue;
                const vec2 back = screen_from_buffer(map, buffer_from_screen(map, p));
                // What a few units in the last place of u are worth here: much where the sine kernel is flat.
                const oracle::Map truth{place.screen, place.gaze, setting};
                const oracle::Position b = truth.to_buffer({p.x, p.y});
                const oracle::Real unit = truth.w() * 3e-7L;
                const oracle::Position left = truth.to_screen({b.x - unit, b.y});
                const oracle::Position right = truth.to_screen({std::fmin(b.x + unit, truth.w()), b.y});
                const double coarse = static_cast<double>(std::hypot(right.x - left.x, right.y - left.y));
                EXPECT_LE(std::hypot(back.x - p.x, back.y - p.y), 0.02 + coarse) << p.x << ", " << p.y;
            }
        }
    }
}

TEST(KernelMap, EveryKernelRisesFromZeroToOneAndItsInverseUndoesIt) {
    for (const KernelSetting& setting : every_kernel()) {
        if (setting.kind == KernelKind::linear_mar) continue;  // not a function of ln r / L
        SCOPED_TRACE(describe({"", {}, {}}, setting));
        const KernelMap map = make_kernel_map({1280, 720}, {640, 360}, setting);
        EXPECT_NEAR(shared::kernel(map, 0.0f), 0, 1e-7);
        EXPECT_NEAR(shared::kernel(map, 1.0f), 1, 1e-6);
        EXPECT_NEAR(shared::inverse_kernel(map, 0.0f), 0, 1e-7);
        EXPECT_NEAR(shared::inverse_kernel(map, 1.0f), 1, 4e-4);  // the sine's slope is 0 there
        float before = 0;
        for (int i = 1; i <= 1000; ++i) {
            const float x = static_cast<float>(i) / 1000;
            const float y = shared::kernel(map, x);
            EXPECT_GE(y, before) << x;
            before = y;
            if (x < 0.99f) {
                EXPECT_NEAR(shared::inverse_kernel(map, y), x, 2e-5) << x;
            }
        }
    }
}

TEST(KernelMap, SeamHasNoGap) {
    const KernelMap map = make_kernel_map({1280, 720}, {640, 360}, {});
    for (const float distance : {1.5f, 10.0f, 100.0f, 600.0f}) {
        const vec2 above = buffer_from_screen(map, {640 + distance, 360 - 1e-4f * distance});
        const vec2 on = buffer_from_screen(map, {640 + distance, 360});
        const vec2 below = buffer_from_screen(map, {640 + distance, 360 + 1e-4f * distance});
        EXPECT_EQ(on.y, 0);
        EXPECT_GT(below.y, 0);
        EXPECT_LT(below.y, 0.02f);
        EXPECT_LT(above.y, map.buffer_size.y);
        EXPECT_GT(above.y, map.buffer_size.y - 0.02f);
        EXPECT_NEAR(above.x, below.x, 1e-2);
    }
}

TEST(KernelMap, AnglesGrowFromRightDownwards) {
    const KernelMap map = make_kernel_map({1280, 720}, {640, 360}, {});
    EXPECT_EQ(buffer_from_screen(map, {740, 360}).y, 0);
    EXPECT_FLOAT_EQ(buffer_from_screen(map, {640, 460}).y, map.buffer_size.y / 4);
    EXPECT_FLOAT_EQ(buffer_from_screen(map, {540, 360}).y, map.buffer_size.y / 2);
    EXPECT_FLOAT_EQ(buffer_from_screen(map, {640, 260}).y, map.buffer_size.y * 3 / 4);
}

TEST(KernelMap, WithinOnePixelOfTheGazeIsColumnZero) {
    for (const KernelSetting& setting : every_kernel()) {
        if (setting.kind == KernelKind::linear_mar && setting.mar_start == 0)
            continue;  // begins at the gaze itself
        const KernelMap map = make_kernel_map({1280, 720}, {640.5, 360.5}, setting);
        for (const float distance : {0.0f, 0.25f, 0.5f, 0.999f}) {
            const vec2 p = buffer_from_screen(map, {640.5f - distance, 360.5f + distance * 1e-3f});
            EXPECT_NEAR(p.x, 0, 1e-4);
            EXPECT_TRUE(std::isfinite(p.y));
        }
    }
}

TEST(KernelMap, LargerAlphaMovesColumnsToThePeriphery) {
    double before = 0;
    for (const double alpha : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) {
        const KernelMap map = make_kernel_map({2560, 1440}, {1280, 720}, {.alpha = alpha});
        // Samples in the outer half of the radius.
        const double outer = map.buffer_size.x - buffer_from_screen(map, {1280 + 734, 720}).x;
        EXPECT_GT(outer, before);
        before = outer;
    }
}

TEST(KernelMap, SpacingAtThePapersSettingIsAsAnalysed) {
    const KernelMap map = make_kernel_map({2560, 1440}, {1280, 720}, {});
    const auto at = [&](float r) { return sample_spacing(map, buffer_from_screen(map, {1280 + r, 720})); };
    EXPECT_NEAR(at(480).x, 1.01, 0.01);
    EXPECT_NEAR(at(480).y, 3.77, 0.01);
    EXPECT_NEAR(at(1000).x, 1.5, 0.05);
    EXPECT_NEAR(at(1000).y, 7.85, 0.01);
}

TEST(KernelSetting, GazeThatIsNoNumberCountsAsTheCentre) {
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 infinity = std::numeric_limits<double>::infinity();
    for (const PointPx gaze :
         {PointPx{nan, 100}, PointPx{100, nan}, PointPx{infinity, 3}, PointPx{3, -infinity}}) {
        const KernelMap map = make_kernel_map({1280, 720}, gaze, {});
        EXPECT_EQ(map.gaze.x, 640);
        EXPECT_EQ(map.gaze.y, 360);
        EXPECT_TRUE(std::isfinite(map.log_max_radius));
    }
}

TEST(KernelSetting, GazeVeryFarAwayKeepsItsDirectionAndEverythingFinite) {
    for (const double distance : {1e5, 1e6, 1e12, 1e300, std::numeric_limits<double>::max()}) {
        for (const KernelSetting& setting : every_kernel()) {
            const KernelMap map = make_kernel_map({1280, 720}, {-distance, 0.8 * distance}, setting);
            EXPECT_LE(std::hypot(map.gaze.x - 640, map.gaze.y - 360), 1.0001e6);
            EXPECT_LT(map.gaze.x, -7e4);
            EXPECT_GT(map.gaze.y, 5e4);
            for (const vec2 p : {vec2{0.5f, 0.5f}, vec2{1279.5f, 719.5f}}) {
                const vec2 b = buffer_from_screen(map, p);
                EXPECT_TRUE(std::isfinite(b.x) && std::isfinite(b.y));
                EXPECT_GE(b.x, 0);
                EXPECT_LE(b.x, map.buffer_size.x);
                const vec2 back = screen_from_buffer(map, b);
                EXPECT_TRUE(std::isfinite(back.x) && std::isfinite(back.y));
                if (setting.kind == KernelKind::sine) continue;  // flat there
                EXPECT_LE(std::hypot(back.x - p.x, back.y - p.y),
                          8 * 1e-6 * std::hypot(map.gaze.x, map.gaze.y));
            }
        }
    }
}

TEST(KernelSetting, RefusesWhatIsOutOfRangeInOneLine) {
    const auto refused = [](const KernelSetting& setting) {
        try {
            check(setting);
        } catch (const std::runtime_error& error) {
            return std::string(error.what()).find('\n') == std::string::npos;
        }
        return false;
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NO_THROW(check({}));
    EXPECT_TRUE(refused({.sigma = 0}));
    EXPECT_TRUE(refused({.sigma = -1.8}));
    EXPECT_TRUE(refused({.sigma = nan}));
    EXPECT_TRUE(refused({.alpha = 0}));
    EXPECT_TRUE(refused({.alpha = nan}));
    EXPECT_TRUE(refused({.kind = KernelKind::polynomial}));
    EXPECT_TRUE(refused({.kind = KernelKind::polynomial, .betas = {0.5, 0.4}}));
    EXPECT_TRUE(refused({.kind = KernelKind::polynomial, .betas = {nan, 1}}));
    EXPECT_TRUE(refused({.kind = KernelKind::polynomial, .betas = {4, -7, 4}}));  // adds up to 1, but falls
    EXPECT_TRUE(refused({.kind = KernelKind::polynomial, .betas = std::vector<double>(9, 1.0 / 9)}));
    EXPECT_TRUE(refused({.width_scale = 0}));
    EXPECT_TRUE(refused({.height_scale = nan}));
    EXPECT_TRUE(refused({.kind = KernelKind::linear_mar, .mar_slope = 0}));
    EXPECT_TRUE(refused({.kind = KernelKind::linear_mar, .as_printed = true}));
    EXPECT_NO_THROW(check({.kind = KernelKind::polynomial, .betas = {0.25, 0.25, 0.5}}));
}

TEST(KernelSetting, NamesOfKernelsReadBack) {
    for (const KernelKind kind : all_kernel_kinds()) EXPECT_EQ(kernel_kind_from_name(name_of(kind)), kind);
    EXPECT_EQ(kernel_kind_from_name("sin"), KernelKind::sine);
    EXPECT_EQ(kernel_kind_from_name("exp"), KernelKind::exponential);
    EXPECT_THROW(kernel_kind_from_name("cosine"), std::runtime_error);
}

struct alignas(16) Vec4 {
    float x, y, z, w;
};

// Runs the map on the device.
class KernelMapOnDevice {
  public:
    KernelMapOnDevice(Gpu& gpu, std::size_t most_points)
        : gpu_(gpu),
          map_(gpu, sizeof(KernelMap), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::upload),
          points_(gpu, most_points * sizeof(Vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::upload),
          results_(gpu, most_points * 2 * sizeof(Vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                   BufferPlace::readback),
          set_(gpu, {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                     {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                     {2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}}),
          layout_(make_pipeline_layout(gpu, {set_.layout()})),
          pipeline_(make_compute_pipeline(gpu, shader_code::kernel_map_points, layout_.get())) {
        set_.set_buffer(0, map_);
        set_.set_buffer(1, points_);
        set_.set_buffer(2, results_);
    }

    std::vector<Vec4> evaluate(const KernelMap& map, const std::vector<Vec4>& points) {
        map_.write(map);
        points_.write(std::span<const Vec4>(points));
        gpu_.submit_and_wait([&](VkCommandBuffer commands) {
            const VkDescriptorSet set = set_.get();
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout_.get(), 0, 1, &set, 0,
                                    nullptr);
            vkCmdDispatch(commands, static_cast<std::uint32_t>(points.size() + 63) / 64, 1, 1);
            memory_barrier(commands, kUseComputeStorage, kUseHostRead);
        });
        std::vector<Vec4> results(2 * points.size());
        std::memcpy(results.data(), results_.mapped(), results.size() * sizeof(Vec4));
        return results;
    }

  private:
    Gpu& gpu_;
    GpuBuffer map_;
    GpuBuffer points_;
    GpuBuffer results_;
    DescriptorSet set_;
    OwnedPipelineLayout layout_;
    OwnedPipeline pipeline_;
};

TEST(KernelMap, DeviceAgreesWithCppPointByPoint) {
    Gpu gpu({.validation = true});
    constexpr std::size_t kPoints = 1000;
    KernelMapOnDevice device(gpu, kPoints);
    for (const Place& place : places()) {
        const std::vector<vec2> on_screen = screen_points(place, 400);
        for (const KernelSetting& setting : every_kernel()) {
            SCOPED_TRACE(describe(place, setting));
            const KernelMap map = make_kernel_map(place.screen, place.gaze, setting);
            const std::vector<vec2> in_buffer = buffer_points(map, 600);
            std::vector<Vec4> points;
            for (std::size_t i = 0; i < kPoints; ++i) {
                points.push_back({on_screen[i].x, on_screen[i].y, in_buffer[i].x, in_buffer[i].y});
            }
            const std::vector<Vec4> results = device.evaluate(map, points);
            const oracle::Map truth{place.screen, place.gaze, setting};
            for (std::size_t i = 0; i < kPoints; ++i) {
                const vec2 buffer = buffer_from_screen(map, on_screen[i]);
                double tolerance = 4e-3 * std::fmax(1.0, setting.alpha);
                if (std::abs(results[2 * i].x - buffer.x) > tolerance) {
                    tolerance += 4 * tolerance_texels(truth, {on_screen[i].x, on_screen[i].y});
                }
                EXPECT_NEAR(results[2 * i].x, buffer.x, tolerance);
                EXPECT_LE(oracle::wrapped_difference(results[2 * i].y, buffer.y, map.buffer_size.y), 1e-3);
                const vec2 screen = screen_from_buffer(map, in_buffer[i]);
                const double radius = shared::radius_of_column(map, in_buffer[i].x);
                EXPECT_NEAR(results[2 * i].z, screen.x, 1e-3 + 1e-5 * radius);
                EXPECT_NEAR(results[2 * i].w, screen.y, 1e-3 + 1e-5 * radius);
                EXPECT_NEAR(results[2 * i + 1].z, radius, 1e-4 + 1e-5 * radius);
                const vec2 spacing = sample_spacing(map, in_buffer[i]);
                EXPECT_NEAR(results[2 * i + 1].x, spacing.x, 1e-3 + 2e-5 * radius);
                EXPECT_NEAR(results[2 * i + 1].y, spacing.y, 1e-4 + 1e-5 * radius);
            }
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

}  // namespace
}  // namespace parafovea
