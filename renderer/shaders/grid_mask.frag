// Which texels of a grid are needed: those that some pixel reads. Runs over the buffer; writes depth 1 for a needed
// texel and nothing for the others. Errs on the side of needing a texel.
#version 460
#define METHOD_SET 0
#include "sample_grid.glsl"
#ifdef REFINE_RINGS
#include "grid_rings_coarse.glsl"
#endif

layout(constant_id = 2) const uint kCulling = 1u;
// With detail: 1: only the coarsest samples, by which the detail is judged; 2: only the finer ones. Else 0.
layout(constant_id = 3) const uint kRound = 0u;

// Rounding may differ between this shader and the one that reads: a footprint counts as a little larger.
const float kReach = 1.0 + 1.0 / 128.0;
const int kMostPixels = 1024;
// How many samples around a coarse ring's one ask it whether they are needed and what they are; generously.
const float kCoarseReach = 5.0;
// Around the gaze, where samples are no farther apart than this, all are needed.
const float kAlwaysBelow = 1.25;
const float kReachOfRound = kRound == 1u ? kCoarseReach : kReach;

// Rings: whether a pixel reads a texel.
bool reads_ring(ivec2 pixel, vec2 texel, float count) {
    vec2 away = vec2(pixel) + 0.5 - grid.gaze;
    float distance_px = length(away);
    // Under the opaque part of the inset nothing is seen.
    if (distance_px < grid.inset_px - grid.inset_rim_px - 0.01) return false;
    float row = ring_at(grid.slope, grid.start, distance_px) - grid.first_ring - jitter.y;
    float column = 1.0 + turns_of(away.x, away.y) * count - jitter.x;
    float apart = column - texel.x;
    // Coarse rows overlap by less than what is asked.
    if (kRound == 1u) apart -= count * round(apart / count);
    return abs(clamp(row, 0.0, grid.rings - 1.0) - (texel.y - 0.5)) < kReachOfRound && abs(apart) < kReachOfRound;
}

bool needed_ring(vec2 texel) {
    float count = samples_of_row[int(texel.y)];
    if (texel.x > count + 2.0) return false;
    if (kCulling == 0u) return true;
    ivec2 last = ivec2(grid.screen_size) - 1;
    float ring = grid.first_ring + texel.y - 0.5 + jitter.y;
    float turns = (texel.x - 1.0 + jitter.x) / count;

    // Look at the pixel that is nearest to the sample.
    vec2 position = grid.gaze + radius_of_ring(grid.slope, grid.start, ring) * unit_vector(turns);
    if (reads_ring(clamp(ivec2(floor(position)), ivec2(0), last), texel, count)) return true;

    // Bound the part of the plane from which the texel can be read.
    float inner = texel.y < kReachOfRound ? 0.0 : max(radius_of_ring(grid.slope, grid.start, ring - kReachOfRound), 0.0);
    float outer = radius_of_ring(grid.slope, grid.start, ring + kReachOfRound) + 0.01;
    float half_turns = kReachOfRound / count;
    vec2 low = -vec2(outer);
    vec2 high = vec2(outer);
    if (half_turns < 0.125) {
        vec2 from = unit_vector(turns - half_turns);
        vec2 to = unit_vector(turns + half_turns);
        float bulge = outer * (1.0 - unit_vector(half_turns).x) + 0.01;
        low = min(min(from, to) * inner, min(from, to) * outer) - bulge;
        high = max(max(from, to) * inner, max(from, to) * outer) + bulge;
    }
    ivec2 first_pixel = max(ivec2(ceil(max(grid.gaze + low - 0.5, vec2(-1.0)))), ivec2(0));
    ivec2 last_pixel = min(ivec2(floor(min(grid.gaze + high - 0.5, grid.screen_size))), last);
    ivec2 size = last_pixel - first_pixel + 1;
    if (size.x <= 0 || size.y <= 0) return false;
    if (size.x > kMostPixels || size.y > kMostPixels || size.x * size.y > kMostPixels) return true;
    bool found = false;
    for (int i = 0; i < size.x * size.y && !found; ++i) {
        found = reads_ring(first_pixel + ivec2(i % size.x, i / size.x), texel, count);
    }
    return found;
}

#ifdef REFINE_RINGS
// Whether the coarse samples around a texel show more contrast than passes unseen there.
bool shows_detail(vec2 texel) {
    float spacing = spacing_at(grid.slope, grid.start, radius_of_ring(grid.slope, grid.start, grid.first_ring + texel.y - 0.5));
    if (spacing < kAlwaysBelow) return true;
    float turns = turns_of_texel(texel);
    int middle = int(texel.y) / 2;
    int first = int(texel.y) % 2 == 1 ? middle : max(middle - 1, 0);
    int last = min(middle + 1, last_coarse_row());
    vec3 darkest = vec3(1.0);
    vec3 brightest = vec3(0.0);
    for (int row = first; row <= last; ++row) {
        int column = int(floor(column_at(row, turns)));
        vec3 a = sqrt(texelFetch(coarse, ivec2(column, row), 0).rgb);
        vec3 b = sqrt(texelFetch(coarse, ivec2(column + 1, row), 0).rgb);
        darkest = min(darkest, min(a, b));
        brightest = max(brightest, max(a, b));
    }
    return dot(brightest - darkest, vec3(0.2126, 0.7152, 0.0722)) > grid.detail * spacing;
}
#endif

// Whether some pixel of a row or column of the screen reads a texel of an axis.
bool needed_axis(GridAxis axis, float texel, float screen) {
    float low = axis_to_screen(kGrid, axis, texel - kReach);
    float high = axis_to_screen(kGrid, axis, texel + kReach);
    // Beyond the map's ends its last texel is all there is.
    int first = texel - kReach <= axis.centre - axis.buffer_low ? 0 : int(max(ceil(low - 0.51), 0.0));
    int last = texel + kReach >= axis.centre + axis.buffer_high ? int(screen) - 1
                                                                : int(min(floor(high - 0.49), screen - 1.0));
    if (last - first > 64) return true;
    bool found = false;
    for (int i = first; i <= last && !found; ++i) {
        found = abs(axis_to_buffer(kGrid, axis, float(i) + 0.5) - texel) < kReach;
    }
    return found;
}

// Whether some pixel between two positions sees a layer: is inside its part of the screen, and not all below a finer
// layer.
bool seen_layer(int layer, vec2 low, vec2 high) {
    vec2 nearest = clamp(grid.gaze, low, high);
    if (share_of_extent(grid.layers[layer], grid.gaze, nearest) >= 1.0) return false;
    if (kCulling == 0u || layer == 0) return true;
    vec2 farthest = mix(low, high, greaterThan(abs(high - grid.gaze), abs(low - grid.gaze)));
    GridLayer finer = grid.layers[layer - 1];
    return share_of_extent(finer, grid.gaze, farthest) > finer.opaque - 1e-4;
}

bool needed_layered(vec2 texel) {
    int layer = layer_of_texel(texel);
    if (layer < 0) return false;
    GridLayer l = grid.layers[layer];
    bool one_block = kGrid == kGridLayers ? layer == 0 : is_native(l) || kInterpolateTiles == 0u;
    // Which pixels may read it.
    vec2 middle = layer_to_screen(l, one_block ? texel : texel + jitter);
    float reach = one_block ? 0.5 * l.step_px - 0.5 : l.step_px * kReach;
    vec2 low = ceil(middle - reach - 0.5 - 1e-3) + 0.5;
    vec2 high = floor(middle + reach - 0.5 + 1e-3) + 0.5;
    low = max(low, vec2(0.5));
    high = min(high, grid.screen_size - 0.5);
    if (low.x > high.x || low.y > high.y) return false;
    if (kGrid == kGridLayers) return seen_layer(layer, low, high);
    bool coarsest = layer == int(grid.layer_count) - 1;
    if (kRound == 1u) return coarsest;
    if (kRound == 2u && coarsest) return false;
    if (kCulling == 0u) return true;
    return layer_of_tile_at(low) == layer || layer_of_tile_at(high) == layer ||
           layer_of_tile_at(vec2(low.x, high.y)) == layer || layer_of_tile_at(vec2(high.x, low.y)) == layer;
}

void main() {
    vec2 texel = gl_FragCoord.xy;
    bool needed = true;
    if (kGrid == kGridRings) {
#ifdef REFINE_RINGS
        needed = !is_coarse(ivec2(texel)) && texel.x < samples_of_row[int(texel.y)] + 2.0 && shows_detail(texel) && needed_ring(texel);
#else
        needed = needed_ring(kRound == 1u ? texel_of_coarse(floor(texel.x), floor(texel.y)) : texel);
#endif
    } else if (axes_grid()) {
        needed = kCulling == 0u || (needed_axis(grid.axis_x, texel.x + jitter.x, grid.screen_size.x) &&
                                    needed_axis(grid.axis_y, texel.y + jitter.y, grid.screen_size.y));
    } else if (kGrid == kGridScattered) {
        float spacing = spacing_at(grid.slope, grid.start, length(texel - grid.gaze));
        // The jitter chooses other pixels in every frame.
        float dither = fract(dither_at(floor(texel.x), floor(texel.y)) + jitter.x + 0.618034 * jitter.y);
        // Whatever the gaze, there is a sample to fill the screen with.
        needed = dither * spacing * spacing < 1.0 || max(texel.x, texel.y) < 1.0;
    } else {
        needed = needed_layered(texel);
    }
    if (!needed) discard;
    gl_FragDepth = 1.0;
}
