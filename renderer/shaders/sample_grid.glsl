// The sample grid of this frame: bindings 0 to 2 of the method's descriptor set. Define METHOD_SET before, and
// LOOK_AT_DETAIL if the tiles' layers stand in an image because they follow the picture's detail.
#ifndef SAMPLE_GRID_GLSL
#define SAMPLE_GRID_GLSL

#include "jitter.glsl"
#include "shared/sample_grid.h"

layout(set = METHOD_SET, binding = 0, std140) uniform SampleGridBlock { SampleGrid grid; };
layout(set = METHOD_SET, binding = 1, std430) readonly buffer RingBlock { float samples_of_row[]; };
#ifdef LOOK_AT_DETAIL
layout(set = METHOD_SET, binding = 2) uniform usampler2D layer_of_tile;
#endif

layout(constant_id = 0) const uint kGrid = kGridRings;
layout(constant_id = 1) const uint kInterpolateTiles = 0u;

bool axes_grid() { return kGrid == kGridRectangular || kGrid == kGridLogRectilinear; }

// The layer whose part of the buffer a texel is in; -1: none.
int layer_of_texel(vec2 texel) {
    for (int i = 0; i < int(grid.layer_count); ++i) {
        vec2 inside = texel - grid.layers[i].corner;
        if (inside.x >= 0.0 && inside.y >= 0.0 && inside.x < grid.layers[i].size.x && inside.y < grid.layers[i].size.y)
            return i;
    }
    return -1;
}

// Between two texels of a row, at a column position. Not through a sampler, which rounding might let touch the rows
// beside it, where texels that no pixel needs hold anything.
vec3 read_along_row(sampler2D image, float column, float row) {
    float low = floor(column - 0.5);
    ivec2 texel = ivec2(low, row);
    vec3 before = texelFetch(image, texel, 0).rgb;
    vec3 after = texelFetch(image, texel + ivec2(1, 0), 0).rgb;
    return mix(before, after, column - 0.5 - low);
}

// A layer without reduction is read pixel by pixel.
bool is_native(GridLayer layer) { return layer.step_px == 1.0; }

int layer_of_tile_at(vec2 position) {
    ivec2 tile = ivec2(floor(clamp(position, vec2(0.5), grid.screen_size - 0.5) / kTilePx));
#ifdef LOOK_AT_DETAIL
    return int(texelFetch(layer_of_tile, tile, 0).r);
#else
    vec2 middle = (vec2(tile) + 0.5) * kTilePx;
    return int(tile_layer(grid.slope, grid.start, length(middle - grid.gaze)));
#endif
}

#endif
