// Lays out the methods that shade the screen's own pixels at a rate: CPS, MRS, Patney's combination, AIS.
#include <algorithm>

#include "renderer/methods/grid_plan.h"

namespace parafovea {
namespace {

struct Falloff {
    double slope = 8.4;    // how fast the spacing grows, for each shorter side of the screen of distance
    double start = 0.036;  // from where on, share of that side
};

GridPlan on_screen(MethodParameters& parameters, SizePx screen, PointPx wanted_gaze,
                   const Falloff& otherwise) {
    GridPlan plan;
    const PointPx gaze = usable_gaze(screen, wanted_gaze);
    shared::SampleGrid& grid = plan.grid;
    grid.screen_size = {static_cast<float>(screen.width), static_cast<float>(screen.height)};
    grid.gaze = {static_cast<float>(gaze.x), static_cast<float>(gaze.y)};
    grid.slope = static_cast<float>(parameters.number("mar_slope", otherwise.slope, 0.1, 200) /
                                    shorter_side_px(screen));
    grid.start =
        static_cast<float>(parameters.number("mar_start", otherwise.start, 0, 2) * shorter_side_px(screen));
    plan.buffer = screen;
    grid.buffer_size = grid.screen_size;
    return plan;
}

// Three reductions of the whole screen, by 1, 2 and 4, of which every tile of the screen uses one.
GridPlan tiles(MethodParameters& parameters, SizePx screen, PointPx gaze, const Falloff& otherwise,
               bool interpolate) {
    GridPlan plan = on_screen(parameters, screen, gaze, otherwise);
    plan.kind = shared::kGridTiles;
    plan.interpolate_tiles = parameters.flag("interpolate", interpolate);
    plan.culling = parameters.flag("culling", true);
    plan.grid.layer_count = 3;
    int x = 0;
    for (int i = 0; i < 3; ++i) {
        const int step = 1 << i;
        const SizePx size{(screen.width + step - 1) / step, (screen.height + step - 1) / step};
        shared::GridLayer& layer = plan.grid.layers[i];
        layer.origin = {0, 0};
        layer.corner = {static_cast<float>(x), static_cast<float>(i == 0 ? 0 : screen.height)};
        layer.size = {static_cast<float>(size.width), static_cast<float>(size.height)};
        layer.extent = {1e9F, 1e9F};
        layer.step_px = static_cast<float>(step);
        layer.opaque = 1;
        if (i > 0) x += size.width;
        plan.buffer.width = std::max(plan.buffer.width, x);
        plan.buffer.height = std::max(plan.buffer.height, static_cast<int>(layer.corner.y) + size.height);
    }
    plan.grid.buffer_size = {static_cast<float>(plan.buffer.width), static_cast<float>(plan.buffer.height)};
    return plan;
}

}  // namespace

GridPlan plan_cps(MethodParameters& parameters, SizePx screen, PointPx gaze) {
    return tiles(parameters, screen, gaze, {}, false);
}

GridPlan plan_mrs(MethodParameters& parameters, SizePx screen, PointPx gaze) {
    GridPlan plan = tiles(parameters, screen, gaze, {.slope = 4.5, .start = 0.07}, true);
    plan.look_at_detail = true;
    plan.grid.detail = static_cast<float>(parameters.number("detail", 0.04, 0, 1));
    return plan;
}

GridPlan plan_patney(MethodParameters& parameters, SizePx screen, PointPx gaze) {
    return tiles(parameters, screen, gaze, {.slope = 14, .start = 0.036}, true);
}

GridPlan plan_ais(MethodParameters& parameters, SizePx screen, PointPx gaze) {
    GridPlan plan = on_screen(parameters, screen, gaze, {.slope = 4.5, .start = 0.09});
    plan.kind = shared::kGridScattered;
    return plan;
}

}  // namespace parafovea
