// What a method on a sample grid asks to be drawn: where its samples lie on this screen with this gaze.
#pragma once

#include <vector>

#include "devices/geometry.h"
#include "renderer/methods/foveation_method.h"
#include "renderer/methods/method_parameters.h"
#include "renderer/shared/sample_grid.h"

namespace parafovea {

struct GridPlan {
    shared::uint kind = shared::kGridRings;  // one of the kGrid* constants
    shared::SampleGrid grid{};
    std::vector<float> samples_of_row;  // rings: how many samples each row of the buffer holds
    SizePx buffer;                      // the same for every gaze
    SizePx coarse;                      // rings by detail: of the first round's buffer; empty otherwise
    bool culling = true;                // only samples that a pixel reads are shaded
    bool interpolate_tiles = false;     // tiles: smooth instead of blocks
    bool look_at_detail = false;        // finer samples only where there is something to see
};

// Reads a method's parameters (all that it knows) and lays out its samples. Throws std::runtime_error with
// one line if a parameter is out of range. The screen is at least 1 x 1; the gaze may be anywhere.
using GridPlanner = GridPlan (*)(MethodParameters& parameters, SizePx screen, PointPx gaze);

// How far apart samples lie at a screen position; of tiles that follow the detail, as if there were detail
// everywhere.
SampleSpacing spacing_of(const GridPlan& plan, PointPx position);

// Warped grids. Parameters of rings: mar_slope, mar_start (as the kernel linear_mar has them), adaptive and
// detail (a first round of every other sample of every other ring; the others only where it shows contrast
// of more than `detail` for each pixel of spacing, between square roots of light), culling; of the others:
// sigma, culling, and focus of rmfr (0: no coarser than a pixel at the gaze).
GridPlan plan_rings(MethodParameters& parameters, SizePx screen, PointPx gaze);
GridPlan plan_rmfr(MethodParameters& parameters, SizePx screen, PointPx gaze);
GridPlan plan_log_rectilinear(MethodParameters& parameters, SizePx screen, PointPx gaze);

// Layered grids. f3d: fov_deg, mar_slope (degrees by degree), mar_start (degrees), blend, culling;
// quad_views: focus_width, focus_height, density, blend, culling; swafford_resolution: radius, density,
// blend, culling.
GridPlan plan_f3d(MethodParameters& parameters, SizePx screen, PointPx gaze);
GridPlan plan_quad_views(MethodParameters& parameters, SizePx screen, PointPx gaze);
GridPlan plan_swafford_resolution(MethodParameters& parameters, SizePx screen, PointPx gaze);

// Tiles. mar_slope, mar_start, interpolate, culling; mrs: detail, too.
GridPlan plan_cps(MethodParameters& parameters, SizePx screen, PointPx gaze);
GridPlan plan_mrs(MethodParameters& parameters, SizePx screen, PointPx gaze);
GridPlan plan_patney(MethodParameters& parameters, SizePx screen, PointPx gaze);

// Scattered. mar_slope, mar_start.
GridPlan plan_ais(MethodParameters& parameters, SizePx screen, PointPx gaze);

// The two layers' radii of Guenter et al. 2012, in degrees, that ask for the fewest samples: found by trying
// all.
struct LayerRadii {
    double inner_deg = 0;
    double outer_deg = 0;
    double samples = 0;
};
struct AcuityModel {
    double fov_deg = 100;         // horizontal field of view of the whole screen
    double mar_slope = 0.022;     // smallest resolvable angle, degrees for each degree of eccentricity
    double mar_start = 1.0 / 48;  // and at the gaze, degrees
};
LayerRadii cheapest_layers(SizePx screen, const AcuityModel& model);

}  // namespace parafovea
