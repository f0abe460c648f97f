// Lights the samples of a grid that the mask lets through.
#version 460
#define METHOD_SET 1
#include "shade.glsl"
#include "sample_grid.glsl"

// Rings by detail: 1: the coarse samples, in a buffer of their own.
layout(constant_id = 4) const uint kCoarse = 0u;

layout(location = 0) out vec4 color;

void main() {
    vec2 texel = kCoarse == 1u ? texel_of_coarse(floor(gl_FragCoord.x), floor(gl_FragCoord.y)) : gl_FragCoord.xy;
    vec2 position = texel + jitter;
    vec2 spacing = vec2(1.0);
    if (kGrid == kGridRings) {
        int row = int(texel.y);
        float count = samples_of_row[row];
        float ring = grid.first_ring + float(row) + jitter.y;
        float radius = radius_of_ring(grid.slope, grid.start, ring);
        // The first and the last texel of a row are each other's neighbours once more.
        position = grid.gaze + radius * unit_vector((texel.x - 1.0 + jitter.x) / count);
        spacing = vec2(spacing_at(grid.slope, grid.start, radius), radius * 6.28318530718 / count);
    } else if (axes_grid()) {
        vec2 at = texel + jitter;
        position = vec2(axis_to_screen(kGrid, grid.axis_x, at.x), axis_to_screen(kGrid, grid.axis_y, at.y));
        spacing = vec2(axis_to_screen(kGrid, grid.axis_x, at.x + 0.5) - axis_to_screen(kGrid, grid.axis_x, at.x - 0.5),
                       axis_to_screen(kGrid, grid.axis_y, at.y + 0.5) - axis_to_screen(kGrid, grid.axis_y, at.y - 0.5));
        spacing = max(spacing, vec2(1e-3));
    } else if (kGrid == kGridScattered) {
        spacing = vec2(spacing_at(grid.slope, grid.start, length(texel - grid.gaze)));
    } else {
        int layer = max(layer_of_texel(texel), 0);
        position = layer_to_screen(grid.layers[layer], texel + jitter);
        spacing = vec2(grid.layers[layer].step_px);
        // Where finer samples are to be had, the coarsest ones must see what those would show.
        if (grid.detail > 0.0 && layer > 0 && layer_of_tile_at(position) < layer) spacing *= 0.5;
    }
    color = vec4(shade_sample(clamp(position, vec2(0.5), grid.screen_size - 0.5), spacing), 1.0);
}
