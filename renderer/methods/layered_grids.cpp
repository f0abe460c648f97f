// Lays out the methods that draw a few reductions of the screen: F3D, quad views, lower peripheral
// resolution.
#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/methods/grid_plan.h"

namespace parafovea {
namespace {

struct LayerWish {
    double half_width_px = 0;
    double half_height_px = 0;
    double step_px = 1;
};

// The buffer of a window: as large as the part of the screen that it may show, and a texel around it.
SizePx buffer_of(SizePx screen, const LayerWish& wish) {
    const auto texels = [&](int pixels, double half_px) {
        return static_cast<int>(std::ceil(std::min<double>(pixels, 2 * half_px) / wish.step_px)) + 3;
    };
    return {texels(screen.width, wish.half_width_px), texels(screen.height, wish.half_height_px)};
}

// Where a window begins, a multiple of its step, so that its samples stand still while the gaze moves.
double beginning(double gaze, double half_px, double step_px) {
    return std::floor(std::max(gaze - half_px, 0.0) / step_px - 1) * step_px;
}

GridPlan lay_out(SizePx screen, PointPx wanted_gaze, const std::vector<LayerWish>& wishes, double blend) {
    const PointPx gaze = usable_gaze(screen, wanted_gaze);
    GridPlan plan;
    plan.kind = shared::kGridLayers;
    shared::SampleGrid& grid = plan.grid;
    grid.screen_size = {static_cast<float>(screen.width), static_cast<float>(screen.height)};
    grid.gaze = {static_cast<float>(gaze.x), static_cast<float>(gaze.y)};
    grid.layer_count = static_cast<float>(wishes.size());
    // The first layer stands above the others, which stand beside each other.
    int x = 0, below = 0;
    for (std::size_t i = 0; i < wishes.size(); ++i) {
        const LayerWish& wish = wishes[i];
        const SizePx size = buffer_of(screen, wish);
        shared::GridLayer& layer = grid.layers[i];
        const int y = i == 0 ? 0 : below;
        layer.corner = {static_cast<float>(i == 0 ? 0 : x), static_cast<float>(y)};
        layer.size = {static_cast<float>(size.width), static_cast<float>(size.height)};
        layer.origin = {static_cast<float>(beginning(gaze.x, wish.half_width_px, wish.step_px)),
                        static_cast<float>(beginning(gaze.y, wish.half_height_px, wish.step_px))};
        layer.extent = {static_cast<float>(wish.half_width_px), static_cast<float>(wish.half_height_px)};
        layer.step_px = static_cast<float>(wish.step_px);
        layer.opaque = static_cast<float>(1 - blend);
        if (i == 0)
            below = size.height;
        else
            x += size.width;
        plan.buffer.width = std::max({plan.buffer.width, x, size.width});
        plan.buffer.height = std::max(plan.buffer.height, y + size.height);
    }
    grid.buffer_size = {static_cast<float>(plan.buffer.width), static_cast<float>(plan.buffer.height)};
    return plan;
}

// A window that no position on the screen is outside of.
LayerWish whole_screen(double step_px) {
    return {1e9, 1e9, step_px};
}

double distance_px(SizePx screen, double fov_deg) {
    return 0.5 * screen.width / std::tan(rad_from_deg(fov_deg) / 2);
}

// How many pixels a sample may span at an eccentricity (Guenter et al. 2012, Section 4).
double step_at(const AcuityModel& model, double eccentricity_deg, double pixel_deg) {
    return std::max(1.0, (model.mar_start + model.mar_slope * eccentricity_deg) / pixel_deg);
}

}  // namespace

LayerRadii cheapest_layers(SizePx screen, const AcuityModel& model) {
    const double d_px = distance_px(screen, model.fov_deg);
    const double pixel_deg = deg_from_rad(std::atan(1 / d_px));
    const double half_diagonal = std::hypot(screen.width, screen.height) / 2;
    const double edge_deg = deg_from_rad(std::atan(half_diagonal / d_px));
    constexpr int kSteps = 80;
    const auto side = [&](double from_deg, double to_deg) {
        return 2 * d_px * std::tan(rad_from_deg(to_deg)) / step_at(model, from_deg, pixel_deg);
    };
    const double aspect = static_cast<double>(screen.height) / screen.width;
    LayerRadii best{.samples = std::numeric_limits<double>::infinity()};
    for (int i = 1; i < kSteps; ++i) {
        for (int j = i + 1; j <= kSteps; ++j) {
            const double inner = edge_deg * i / kSteps, outer = edge_deg * j / kSteps;
            const double first = side(0, inner), second = side(inner, outer);
            const double third = screen.width / step_at(model, outer, pixel_deg);
            const double samples = first * first + second * second + aspect * third * third;
            if (samples < best.samples) best = {inner, outer, samples};
        }
    }
    return best;
}

GridPlan plan_f3d(MethodParameters& parameters, SizePx screen, PointPx gaze) {
    AcuityModel model;
    model.fov_deg = parameters.number("fov_deg", model.fov_deg, 1, 170);
    model.mar_slope = parameters.number("mar_slope", model.mar_slope, 0.001, 1);
    model.mar_start = parameters.number("mar_start", model.mar_start, 0.001, 1);
    const double blend = parameters.number("blend", 0.2, 0.01, 1);
    const bool culling = parameters.flag("culling", true);
    const LayerRadii radii = cheapest_layers(screen, model);
    const double d_px = distance_px(screen, model.fov_deg);
    const double pixel_deg = deg_from_rad(std::atan(1 / d_px));
    const auto half_px = [&](double deg) { return std::max(d_px * std::tan(rad_from_deg(deg)), 1.0); };
    GridPlan plan = lay_out(
        screen, gaze,
        {{half_px(radii.inner_deg), half_px(radii.inner_deg), 1},
         {half_px(radii.outer_deg), half_px(radii.outer_deg), step_at(model, radii.inner_deg, pixel_deg)},
         whole_screen(step_at(model, radii.outer_deg, pixel_deg))},
        blend);
    plan.culling = culling;
    return plan;
}

GridPlan plan_quad_views(MethodParameters& parameters, SizePx screen, PointPx gaze) {
    const double width = parameters.number("focus_width", 0.35, 0.01, 1);
    const double height = parameters.number("focus_height", 0.35, 0.01, 1);
    const double density = parameters.number("density", 0.4, 0.02, 1);
    const double blend = parameters.number("blend", 0.2, 0.01, 1);
    const bool culling = parameters.flag("culling", true);
    GridPlan plan = lay_out(
        screen, gaze,
        {{0.5 * width * screen.width, 0.5 * height * screen.height, 1}, whole_screen(1 / density)}, blend);
    plan.culling = culling;
    return plan;
}

GridPlan plan_swafford_resolution(MethodParameters& parameters, SizePx screen, PointPx gaze) {
    const double radius = parameters.number("radius", 0.27, 0.01, 2) * shorter_side_px(screen);
    const double density = parameters.number("density", 0.5, 0.02, 1);
    const double blend = parameters.number("blend", 0.2, 0.01, 1);
    const bool culling = parameters.flag("culling", true);
    GridPlan plan = lay_out(screen, gaze, {{radius, radius, 1}, whole_screen(1 / density)}, blend);
    plan.culling = culling;
    return plan;
}

}  // namespace parafovea
