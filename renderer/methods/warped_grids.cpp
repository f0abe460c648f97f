// Lays out the methods that bend the whole screen into one buffer: rings, RMFR, log-rectilinear.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/methods/grid_plan.h"

namespace parafovea {
namespace {

constexpr double kInsetRimPx = 8;  // over which the native disc fades into the rings

shared::SampleGrid empty_grid(SizePx screen, SizePx buffer, PointPx gaze) {
    shared::SampleGrid grid{};
    grid.screen_size = {static_cast<float>(screen.width), static_cast<float>(screen.height)};
    grid.buffer_size = {static_cast<float>(buffer.width), static_cast<float>(buffer.height)};
    grid.gaze = {static_cast<float>(gaze.x), static_cast<float>(gaze.y)};
    return grid;
}

int reduced(int pixels, double sigma) {
    return std::max(1, static_cast<int>(std::lround(pixels / sigma)));
}

// The map is told for positions on the screen: a gaze beyond it counts as the nearest place on its edge.
PointPx gaze_on_screen(SizePx screen, PointPx gaze) {
    const PointPx usable = usable_gaze(screen, gaze);
    return {std::clamp(usable.x, 0.0, static_cast<double>(screen.width)),
            std::clamp(usable.y, 0.0, static_cast<double>(screen.height))};
}

shared::GridAxis rectangular_axis(double screen, double buffer, double gaze, double sigma, double focus) {
    // A focal length of D / (sigma - 1) makes the spacing one pixel at the gaze, whatever D is.
    const auto curve = [&](double reach) {
        return static_cast<float>(std::max(focus > 0 ? focus * screen : reach / (sigma - 1), 1e-3));
    };
    const double low = gaze, high = screen - gaze;
    return {.gaze = static_cast<float>(gaze),
            .centre = static_cast<float>(gaze / screen * buffer),
            .screen_low = static_cast<float>(low),
            .screen_high = static_cast<float>(high),
            .buffer_low = static_cast<float>(low / screen * buffer),
            .buffer_high = static_cast<float>(high / screen * buffer),
            .curve_low = curve(low),
            .curve_high = curve(high)};
}

shared::GridAxis log_axis(double screen, double buffer, double gaze) {
    const double reach = std::max(gaze, screen - gaze);
    const auto half = static_cast<float>(buffer / 2), far = static_cast<float>(reach);
    const auto lambda = static_cast<float>(reach / (std::numbers::e - 1));
    return {.gaze = static_cast<float>(gaze),
            .centre = half,
            .screen_low = far,
            .screen_high = far,
            .buffer_low = half,
            .buffer_high = half,
            .curve_low = lambda,
            .curve_high = lambda};
}

}  // namespace

GridPlan plan_rings(MethodParameters& parameters, SizePx screen, PointPx wanted_gaze) {
    const double slope = parameters.number("mar_slope", 5.7, 0.5, 200) / shorter_side_px(screen);
    const double start = parameters.number("mar_start", 0, 0, 0.7) * shorter_side_px(screen);
    const bool adaptive = parameters.flag("adaptive", false);
    const double detail = parameters.number("detail", 0.03, 0, 1);
    GridPlan plan;
    plan.kind = shared::kGridRings;
    plan.culling = parameters.flag("culling", true);

    const PointPx gaze = usable_gaze(screen, wanted_gaze);
    const double diagonal = std::hypot(screen.width, screen.height);
    const double outside_x = std::max({-gaze.x, gaze.x - screen.width, 0.0});
    const double outside_y = std::max({-gaze.y, gaze.y - screen.height, 0.0});
    const double nearest = std::hypot(outside_x, outside_y);
    const auto ring_at = [&](double r) { return std::log1p(slope * std::max(r - start, 0.0)) / slope - 0.5; };
    const auto samples_of = [&](double ring) {
        const double r = start + std::expm1(slope * (ring + 0.5)) / slope;
        const double around = 2 * std::numbers::pi * r / (1 + slope * std::max(r - start, 0.0));
        // In pairs, of which the first round takes one.
        return adaptive ? 2 * std::max(std::ceil(around / 2), 2.0) : std::max(std::ceil(around), 3.0);
    };

    // As many rings as the farthest a gaze on the screen can ask for; one beyond the screen asks for fewer,
    // but farther ones.
    int rows = static_cast<int>(std::ceil(ring_at(diagonal))) + 4;
    if (adaptive) rows |= 1;  // the first and the last are coarse ones
    const double first = std::max(std::floor(ring_at(nearest)) - 1, 0.0);
    const double most = std::max(2 * std::numbers::pi * start, 2 * std::numbers::pi / slope);
    plan.buffer = {static_cast<int>(std::ceil(most)) + 4, rows};
    plan.look_at_detail = adaptive;
    if (adaptive) plan.coarse = {plan.buffer.width / 2 + 2, rows / 2 + 1};
    for (int row = 0; row < rows; ++row)
        plan.samples_of_row.push_back(static_cast<float>(samples_of(first + row)));

    plan.grid = empty_grid(screen, plan.buffer, gaze);
    plan.grid.slope = static_cast<float>(slope);
    plan.grid.start = static_cast<float>(start);
    plan.grid.first_ring = static_cast<float>(first);
    plan.grid.rings = static_cast<float>(rows);
    plan.grid.detail = adaptive ? static_cast<float>(detail) : 0;
    plan.grid.inset_px = static_cast<float>(start + kInsetRimPx);
    plan.grid.inset_rim_px = static_cast<float>(kInsetRimPx);
    return plan;
}

GridPlan plan_rmfr(MethodParameters& parameters, SizePx screen, PointPx wanted_gaze) {
    const double sigma = parameters.number("sigma", 2.6, 1.01, 50);
    const double focus = parameters.number("focus", 0, 0, 10);
    GridPlan plan;
    plan.kind = shared::kGridRectangular;
    plan.culling = parameters.flag("culling", true);
    const PointPx gaze = gaze_on_screen(screen, wanted_gaze);
    plan.buffer = {reduced(screen.width, sigma), reduced(screen.height, sigma)};
    plan.grid = empty_grid(screen, plan.buffer, gaze);
    plan.grid.axis_x = rectangular_axis(screen.width, plan.buffer.width, gaze.x, sigma, focus);
    plan.grid.axis_y = rectangular_axis(screen.height, plan.buffer.height, gaze.y, sigma, focus);
    return plan;
}

GridPlan plan_log_rectilinear(MethodParameters& parameters, SizePx screen, PointPx wanted_gaze) {
    const double sigma = parameters.number("sigma", 1.8, 1.01, 50);
    GridPlan plan;
    plan.kind = shared::kGridLogRectilinear;
    plan.culling = parameters.flag("culling", true);
    const PointPx gaze = gaze_on_screen(screen, wanted_gaze);
    plan.buffer = {reduced(screen.width, sigma), reduced(screen.height, sigma)};
    plan.grid = empty_grid(screen, plan.buffer, gaze);
    plan.grid.axis_x = log_axis(screen.width, plan.buffer.width, gaze.x);
    plan.grid.axis_y = log_axis(screen.height, plan.buffer.height, gaze.y);
    return plan;
}

}  // namespace parafovea
