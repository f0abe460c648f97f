// The maps of sample grids: against the published formulas written once more, by round trip, and C++ against
// the device.
#include "renderer/shared/sample_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <vector>

#include "devices/random.h"
#include "renderer/gpu_pipeline.h"
#include "renderer/methods/grid_plan.h"
#include "shader_code/sample_grid_points.h"

namespace parafovea {
namespace {

using Real = long double;

GridPlan planned(GridPlanner planner, SizePx screen, PointPx gaze,
                 std::map<std::string, double> numbers = {}) {
    const RenderMethod method{"test", std::move(numbers), {}};
    MethodParameters parameters(method);
    return planner(parameters, screen, gaze);
}

// The place where a rising function reaches a value.
Real place_of(const std::function<Real(Real)>& f, Real value, Real low, Real high) {
    for (int i = 0; i < 100; ++i) {
        const Real middle = (low + high) / 2;
        (f(middle) < value ? low : high) = middle;
    }
    return (low + high) / 2;
}

struct Place {
    SizePx screen;
    PointPx gaze;
};
const std::vector<Place> kPlaces{{{1280, 720}, {640, 360}},      {{1280, 720}, {0, 720}},
                                 {{1281, 719}, {311.25, 517.5}}, {{3840, 2160}, {3839, 10}},
                                 {{1, 1}, {0.5, 0.5}},           {{2, 300}, {2, 20}}};

TEST(SampleGrid, RectangularAxisFollowsThePublishedFormula) {
    for (const Place& place : kPlaces) {
        for (const double sigma : {1.2, 1.8, 2.6, 4.0}) {
            for (const double focus : {0.0, 0.4}) {
                const GridPlan plan =
                    planned(plan_rmfr, place.screen, place.gaze, {{"sigma", sigma}, {"focus", focus}});
                // Ye et al. 2022 in shares of the screen and the buffer, both with the gaze at e.
                const Real w = place.screen.width, e = place.gaze.x / w, buffer = plan.buffer.width;
                for (int i = 0; i <= 50; ++i) {
                    const Real x = i / 50.0L;
                    const Real side = x < e ? e : 1 - e, d = std::abs(x - e);
                    if (side == 0) continue;
                    const Real f = focus > 0 ? Real{focus} : side / (Real{sigma} - 1);
                    const Real n = f * side / (f + side);
                    const Real image = f * d / (f + d) * side / n;
                    const Real u = (e + (x < e ? -image : image)) * buffer;
                    const float found = shared::axis_to_buffer(shared::kGridRectangular, plan.grid.axis_x,
                                                               static_cast<float>(x * w));
                    EXPECT_NEAR(found, static_cast<double>(u), 1e-3 + 1e-6 * place.screen.width) << i;
                }
            }
        }
    }
}

TEST(SampleGrid, RectangularAxisWithoutFocusIsNativeAtTheGaze) {
    for (const double sigma : {1.5, 2.6}) {
        const GridPlan plan = planned(plan_rmfr, {2600, 1300}, {900, 650}, {{"sigma", sigma}});
        const shared::GridAxis& axis = plan.grid.axis_x;
        for (const float side : {-1.0F, 1.0F}) {
            const float step = axis_to_screen(shared::kGridRectangular, axis, axis.centre + side) - axis.gaze;
            EXPECT_NEAR(std::abs(step), 1, 0.01);
        }
        // And sigma^2 at the edges.
        EXPECT_NEAR(axis_to_screen(shared::kGridRectangular, axis, plan.grid.buffer_size.x) -
                        axis_to_screen(shared::kGridRectangular, axis, plan.grid.buffer_size.x - 1),
                    sigma * sigma, 0.02 * sigma * sigma);
    }
}

TEST(SampleGrid, LogRectilinearAxisUndoesThePublishedFormula) {
    for (const Place& place : kPlaces) {
        for (const double sigma : {1.2, 1.8, 2.4}) {
            const GridPlan plan = planned(plan_log_rectilinear, place.screen, place.gaze, {{"sigma", sigma}});
            const Real w = place.screen.width, gaze = place.gaze.x, buffer = plan.buffer.width;
            const Real lambda = std::fmax(gaze, w - gaze) / (std::numbers::e_v<Real> - 1);
            // Li et al. 2021: |delta| = max(|U|, lambda (exp((2 |U| / w)^4) - 1)), U from the buffer's
            // middle.
            const auto distance_of = [&](Real u) {
                return std::fmax(u, lambda * (std::exp(std::pow(2 * u / buffer, 4)) - 1));
            };
            for (int i = 0; i <= 50; ++i) {
                const Real x = i / 50.0L * w, d = std::abs(x - gaze);
                const Real u = std::fmin(place_of(distance_of, d, 0, buffer), buffer / 2);
                const float found = shared::axis_to_buffer(shared::kGridLogRectilinear, plan.grid.axis_x,
                                                           static_cast<float>(x));
                EXPECT_NEAR(found, static_cast<double>(buffer / 2 + (x < gaze ? -u : u)),
                            1e-3 + 2e-6 * place.screen.width);
            }
        }
    }
}

TEST(SampleGrid, AxesReturnToThePixel) {
    for (const Place& place : kPlaces) {
        for (const shared::uint kind : {shared::kGridRectangular, shared::kGridLogRectilinear}) {
            const GridPlan plan = planned(kind == shared::kGridRectangular ? plan_rmfr : plan_log_rectilinear,
                                          place.screen, place.gaze);
            for (int i = 0; i <= 200; ++i) {
                const float x = static_cast<float>(place.screen.width * i / 200.0);
                const float u = shared::axis_to_buffer(kind, plan.grid.axis_x, x);
                EXPECT_GE(u, 0);
                EXPECT_LE(u, plan.grid.buffer_size.x * 1.00001F);
                EXPECT_NEAR(shared::axis_to_screen(kind, plan.grid.axis_x, u), x, 0.01);
            }
        }
    }
}

TEST(SampleGrid, RingsLieAsFarApartAsTheSpacingAsksFor) {
    for (const float slope : {0.002F, 0.0055F, 0.1F}) {
        for (const float start : {0.0F, 60.0F, 300.0F}) {
            // The number of rings up to a radius is the integral of one over the spacing.
            double sum = 0, r = start;
            for (const double to : {start + 10.0, start + 100.0, start + 1000.0, start + 3000.0}) {
                constexpr int kSteps = 4000;
                const double h = (to - r) / kSteps;
                for (int i = 0; i < kSteps; ++i) sum += h / (1 + slope * (r + (i + 0.5) * h - start));
                r = to;
                EXPECT_NEAR(shared::ring_at(slope, start, static_cast<float>(r)) + 0.5, sum,
                            2e-3 + 1e-5 * sum);
                const float back = shared::radius_of_ring(slope, start, static_cast<float>(sum - 0.5));
                EXPECT_NEAR(back, r, 1e-3 * r);
            }
        }
    }
}

TEST(SampleGrid, RingsOfAPlanHoldOneSampleForEachSpacingAround) {
    const GridPlan plan =
        planned(plan_rings, {2560, 1440}, {1280, 720}, {{"mar_slope", 7.92}, {"mar_start", 60.0 / 1440}});
    ASSERT_EQ(static_cast<float>(plan.samples_of_row.size()), plan.grid.rings);
    EXPECT_GE(shared::radius_of_ring(plan.grid.slope, plan.grid.start, plan.grid.rings - 1),
              std::hypot(2560, 1440));
    for (std::size_t i = 0; i < plan.samples_of_row.size(); ++i) {
        const double r = shared::radius_of_ring(plan.grid.slope, plan.grid.start, static_cast<float>(i));
        const double spacing = shared::spacing_at(plan.grid.slope, plan.grid.start, static_cast<float>(r));
        const double between = 2 * std::numbers::pi * r / plan.samples_of_row[i];
        EXPECT_LE(between, spacing * 1.0001);
        EXPECT_GE(between, spacing * (1 - 2 / plan.samples_of_row[i]));
        EXPECT_LE(plan.samples_of_row[i] + 2, static_cast<float>(plan.buffer.width));
    }
}

TEST(SampleGrid, BufferOfRingsIsAsLargeForEveryGazeAndReachesEveryPixel) {
    const SizePx screen{640, 360};
    const SizePx buffer = planned(plan_rings, screen, {320, 180}).buffer;
    for (const PointPx gaze :
         {PointPx{0, 0}, PointPx{-500, 700}, PointPx{1e6, -1e6}, PointPx{std::nan(""), 3}}) {
        const GridPlan plan = planned(plan_rings, screen, gaze);
        EXPECT_EQ(plan.buffer, buffer);
        for (const double x : {0.5, 639.5}) {
            for (const double y : {0.5, 359.5}) {
                const double r = std::hypot(x - plan.grid.gaze.x, y - plan.grid.gaze.y);
                const double row = shared::ring_at(plan.grid.slope, plan.grid.start, static_cast<float>(r)) -
                                   plan.grid.first_ring;
                EXPECT_GT(row, -0.6);
                EXPECT_LT(row, plan.grid.rings - 1);
            }
        }
    }
}

TEST(SampleGrid, LayersOfF3dAreTheCheapestThatThereAre) {
    const SizePx screen{1920, 1080};
    const AcuityModel model{.fov_deg = 60};
    const LayerRadii found = cheapest_layers(screen, model);
    // Guenter et al. 2012: D1^2 + D2^2 + D3 (H / W) D3, each side over its sampling factor.
    const double d_px = 960 / std::tan(30 * std::numbers::pi / 180);
    const double pixel_deg = std::atan(1 / d_px) * 180 / std::numbers::pi;
    const auto factor = [&](double deg) {
        return std::fmax(1, (model.mar_start + model.mar_slope * deg) / pixel_deg);
    };
    const auto cost = [&](double inner, double outer) {
        const double d1 = 2 * d_px * std::tan(inner * std::numbers::pi / 180);
        const double d2 = 2 * d_px * std::tan(outer * std::numbers::pi / 180) / factor(inner);
        const double d3 = 1920 / factor(outer);
        return d1 * d1 + d2 * d2 + d3 * d3 * 1080 / 1920;
    };
    EXPECT_NEAR(found.samples, cost(found.inner_deg, found.outer_deg), 1e-6 * found.samples);
    Random random(3);
    for (int i = 0; i < 500; ++i) {
        const double inner = 0.5 + 20 * random.uniform(), outer = inner + 0.5 + 15 * random.uniform();
        EXPECT_LE(found.samples, 1.02 * cost(inner, outer));
    }
    EXPECT_LT(found.samples, 0.25 * 1920 * 1080);
}

TEST(SampleGrid, DitherSpreadsEvenlyOverEveryNeighbourhood) {
    for (const double share : {0.5, 0.25, 0.1, 0.04}) {
        for (const auto& [left, top] : {std::pair{0, 0}, std::pair{1000, 333}, std::pair{15000, 8000}}) {
            int count = 0;
            for (int y = 0; y < 32; ++y) {
                for (int x = 0; x < 32; ++x) {
                    const float d =
                        shared::dither_at(static_cast<float>(left + x), static_cast<float>(top + y));
                    ASSERT_TRUE(d >= 0 && d < 1);
                    count += d < share;
                }
            }
            EXPECT_NEAR(count, 1024 * share, 14);
        }
    }
}

struct alignas(16) Vec4 {
    float x, y, z, w;
};

std::vector<Vec4> on_device(Gpu& gpu, const GridPlan& plan, const std::vector<Vec4>& points) {
    GpuBuffer grid(gpu, sizeof(shared::SampleGrid), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::upload);
    GpuBuffer in(gpu, points.size() * sizeof(Vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::upload);
    GpuBuffer out(gpu, points.size() * 2 * sizeof(Vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                  BufferPlace::readback);
    DescriptorSet set(gpu, {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                            {1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                            {2, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}});
    const OwnedPipelineLayout layout = make_pipeline_layout(gpu, {set.layout()});
    const OwnedPipeline pipeline =
        make_compute_pipeline(gpu, shader_code::sample_grid_points, layout.get(), {{0, plan.kind}});
    set.set_buffer(0, grid);
    set.set_buffer(1, in);
    set.set_buffer(2, out);
    grid.write(plan.grid);
    in.write(std::span<const Vec4>(points));
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        const VkDescriptorSet bound = set.get();
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout.get(), 0, 1, &bound, 0,
                                nullptr);
        vkCmdDispatch(commands, static_cast<std::uint32_t>(points.size() + 63) / 64, 1, 1);
        memory_barrier(commands, kUseComputeStorage, kUseHostRead);
    });
    std::vector<Vec4> results(2 * points.size());
    std::memcpy(results.data(), out.mapped(), results.size() * sizeof(Vec4));
    return results;
}

TEST(SampleGrid, DeviceAgreesWithCppPointByPoint) {
    Gpu gpu({.validation = true});
    Random random(5);
    for (const Place& place : kPlaces) {
        for (const GridPlanner planner : {plan_rings, plan_rmfr, plan_log_rectilinear, plan_f3d}) {
            const GridPlan plan = planned(planner, place.screen, place.gaze);
            std::vector<Vec4> points;
            for (int i = 0; i < 300; ++i) {
                points.push_back({static_cast<float>(random.uniform() * place.screen.width),
                                  static_cast<float>(random.uniform() * place.screen.height),
                                  static_cast<float>(random.uniform()) * plan.grid.buffer_size.x,
                                  static_cast<float>(random.uniform()) * plan.grid.buffer_size.y});
            }
            const std::vector<Vec4> found = on_device(gpu, plan, points);
            const double pixels = place.screen.width;
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Vec4& p = points[i];
                const Vec4& first = found[2 * i];
                const Vec4& second = found[2 * i + 1];
                const shared::SampleGrid& g = plan.grid;
                if (plan.kind == shared::kGridRings) {
                    EXPECT_NEAR(first.x, shared::ring_at(g.slope, g.start, first.y), 2e-3);
                    const float radius = shared::radius_of_ring(g.slope, g.start, p.w);
                    EXPECT_NEAR(first.z, radius, 1e-3 + 1e-5 * radius);
                    EXPECT_EQ(first.w, shared::dither_at(std::floor(p.x), std::floor(p.y)));
                } else if (plan.kind != shared::kGridLayers) {
                    EXPECT_NEAR(first.x, shared::axis_to_buffer(plan.kind, g.axis_x, p.x),
                                1e-3 + 1e-6 * pixels);
                    EXPECT_NEAR(first.y, shared::axis_to_buffer(plan.kind, g.axis_y, p.y),
                                1e-3 + 1e-6 * pixels);
                    EXPECT_NEAR(first.z, shared::axis_to_screen(plan.kind, g.axis_x, p.z),
                                1e-3 + 4e-6 * pixels);
                    EXPECT_NEAR(first.w, shared::axis_to_screen(plan.kind, g.axis_y, p.w),
                                1e-3 + 4e-6 * pixels);
                } else {
                    const shared::vec2 texel = shared::layer_to_buffer(g.layers[0], {p.x, p.y});
                    EXPECT_NEAR(second.x, texel.x, 1e-3);
                    EXPECT_NEAR(second.y, texel.y, 1e-3);
                    const float share = shared::share_of_extent(g.layers[0], g.gaze, {p.x, p.y});
                    EXPECT_NEAR(second.w, shared::layer_weight(g.layers[0], share), 1e-4);
                }
            }
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

}  // namespace
}  // namespace parafovea
