// What can be told from a plan without a device.
#include "renderer/methods/grid_plan.h"

#include <algorithm>
#include <cmath>

namespace parafovea {
namespace {

double axis_spacing(shared::uint kind, const shared::GridAxis& axis, double position) {
    const float texel = axis_to_buffer(kind, axis, static_cast<float>(position));
    const double spacing =
        axis_to_screen(kind, axis, texel + 0.5F) - axis_to_screen(kind, axis, texel - 0.5F);
    // At an edge one half of the texel lies beyond the map.
    return std::max(spacing, 1e-3);
}

double layer_spacing(const shared::SampleGrid& grid, shared::vec2 at) {
    const int coarsest = static_cast<int>(grid.layer_count) - 1;
    for (int i = 0; i < coarsest; ++i) {
        if (layer_weight(grid.layers[i], share_of_extent(grid.layers[i], grid.gaze, at)) >= 0.5F)
            return grid.layers[i].step_px;
    }
    return grid.layers[coarsest].step_px;
}

}  // namespace

SampleSpacing spacing_of(const GridPlan& plan, PointPx position) {
    const shared::SampleGrid& grid = plan.grid;
    const shared::vec2 at{static_cast<float>(position.x), static_cast<float>(position.y)};
    const float distance = std::hypot(at.x - grid.gaze.x, at.y - grid.gaze.y);
    const double asked_for = shared::spacing_at(grid.slope, grid.start, distance);
    switch (plan.kind) {
        case shared::kGridRectangular:
        case shared::kGridLogRectilinear:
            return {axis_spacing(plan.kind, grid.axis_x, position.x),
                    axis_spacing(plan.kind, grid.axis_y, position.y)};
        case shared::kGridLayers: {
            const double step = layer_spacing(grid, at);
            return {step, step};
        }
        case shared::kGridTiles: {
            const float tile = shared::kTilePx;
            const float x = (std::floor(at.x / tile) + 0.5F) * tile,
                        y = (std::floor(at.y / tile) + 0.5F) * tile;
            const float layer =
                shared::tile_layer(grid.slope, grid.start, std::hypot(x - grid.gaze.x, y - grid.gaze.y));
            const double step = std::exp2(layer);
            return {step, step};
        }
        default:
            return distance < grid.inset_px ? SampleSpacing{} : SampleSpacing{asked_for, asked_for};
    }
}

}  // namespace parafovea
