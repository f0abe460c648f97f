// Which layer each tile is drawn in: the one that its distance from the gaze asks for, or a coarser one where the
// coarsest layer, already drawn, shows too little contrast to be worth more samples (after He et al. 2014). Runs over
// the tiles.
#version 460
#define METHOD_SET 0
#include "sample_grid.glsl"

layout(set = 0, binding = 3) uniform sampler2D samples;

layout(location = 0) out uint tile_layer_number;

void main() {
    vec2 middle = floor(gl_FragCoord.xy) * kTilePx + 0.5 * kTilePx;
    float distance_px = length(middle - grid.gaze);
    int wanted = int(tile_layer(grid.slope, grid.start, distance_px));

    // The darkest and the brightest of the tile and a margin, brightness as the eye's response to it goes.
    GridLayer coarse = grid.layers[int(grid.layer_count) - 1];
    int reach = int(0.5 * kTilePx / coarse.step_px) + 1;
    ivec2 first = ivec2(coarse.corner);
    ivec2 last = first + ivec2(coarse.size) - 1;
    ivec2 centre = ivec2(floor(layer_to_buffer(coarse, middle)));
    float darkest = 1.0;
    float brightest = 0.0;
    for (int y = -reach; y < reach; ++y) {
        for (int x = -reach; x < reach; ++x) {
            vec3 seen = texelFetch(samples, clamp(centre + ivec2(x, y), first, last), 0).rgb;
            float response = sqrt(dot(seen, vec3(0.2126, 0.7152, 0.0722)));
            darkest = min(darkest, response);
            brightest = max(brightest, response);
        }
    }
    float contrast = brightest - darkest;
    // A finer layer must be worth more, the coarser the eye sees there.
    float threshold = grid.detail * spacing_at(grid.slope, grid.start, distance_px);
    int enough = contrast < threshold ? 2 : contrast < 2.0 * threshold ? 1 : 0;
    bool fovea = distance_px <= grid.start + kTilePx;
    tile_layer_number = uint(fovea ? wanted : max(wanted, enough));
}
