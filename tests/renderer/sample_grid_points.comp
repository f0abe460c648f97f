// Evaluates the maps of sample grids on the device, one point an invocation.
#version 460
#include "shared/sample_grid.h"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, std140) uniform GridBlock { SampleGrid grid; };
layout(set = 0, binding = 1, std430) readonly buffer Points { vec4 points[]; };    // xy: screen, zw: buffer
layout(set = 0, binding = 2, std430) writeonly buffer Results { vec4 results[]; };  // 2 per point
layout(constant_id = 0) const uint kGrid = 0u;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= points.length()) return;
    vec4 p = points[i];
    float r = length(p.xy - grid.gaze);
    if (kGrid == kGridRings) {
        results[2 * i] = vec4(ring_at(grid.slope, grid.start, r), r, radius_of_ring(grid.slope, grid.start, p.w),
                              dither_at(floor(p.x), floor(p.y)));
    } else {
        results[2 * i] = vec4(axis_to_buffer(kGrid, grid.axis_x, p.x), axis_to_buffer(kGrid, grid.axis_y, p.y),
                              axis_to_screen(kGrid, grid.axis_x, p.z), axis_to_screen(kGrid, grid.axis_y, p.w));
    }
    results[2 * i + 1] = vec4(layer_to_buffer(grid.layers[0], p.xy), tile_layer(grid.slope, grid.start, r),
                              layer_weight(grid.layers[0], share_of_extent(grid.layers[0], grid.gaze, p.xy)));
}
