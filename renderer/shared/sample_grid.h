// Where the samples of a foveated picture lie, for every method but the kernel log-polar map; the one place
// where their mathematics stands. A grid is a buffer of texels: each has a position on the screen, a spacing
// to its neighbours, and pixels that read it.
//
// Warped grids bend the whole screen into the buffer:
//   rings              a row of the buffer is a ring around the gaze with as many samples as its length asks
//   rectangular        one smooth map for each axis (Ye et al. 2022)
//   log-rectilinear    one map for each axis with an exact fovea (Li et al. 2021)
// Layered grids are reductions of the screen that lie beside each other in the buffer:
//   layers             windows around the gaze, blended where they overlap (Guenter et al. 2012)
//   tiles              every tile of the screen is in one of three reductions (Vaidyanathan et al. 2014)
// The scattered grid is the screen itself, of which only some pixels are shaded (Stengel et al. 2016).
//
// Screen positions are pixels from the top left corner, pixel (i, j) centred at (i + 0.5, j + 0.5). Buffer
// positions are texels, texel (a, b) centred at (a + 0.5, b + 0.5).
#ifndef PARAFOVEA_SAMPLE_GRID_H
#define PARAFOVEA_SAMPLE_GRID_H

#include "bridge.h"
#include "kernel_map.h"

SHARED_BEGIN

const uint kGridRings = 0u;
const uint kGridRectangular = 1u;
const uint kGridLogRectilinear = 2u;
const uint kGridLayers = 3u;
const uint kGridTiles = 4u;
const uint kGridScattered = 5u;

const uint kMostLayers = 3u;
const float kTilePx = 16.0f;  // side of a tile of kGridTiles, pixels

// One axis of a rectangular or log-rectilinear grid. Lengths on the screen in pixels, in the buffer in
// texels.
struct GridAxis {
    float gaze;        // on the screen, between 0 and its size
    float centre;      // where the gaze is in the buffer
    float screen_low;  // from the gaze to the screen's two edges; log-rectilinear: to the end of the map
    float screen_high;
    float buffer_low;  // and in the buffer
    float buffer_high;
    float curve_low;  // rectangular: the focal length f of each side; log-rectilinear: lambda
    float curve_high;
};

// A reduction of the screen, or of a window of it.
struct GridLayer {
    vec2 origin;  // the screen position of the buffer position `corner`
    vec2 corner;  // its first texel
    vec2 size;    // in texels
    vec2 extent;  // half the sides of the part of the screen it is for, around the gaze
    float step_px;
    float opaque;  // the share of `extent` within which it is all that is seen
    float pad_0;
    float pad_1;
};

// Uniform block; std140.
struct SampleGrid {
    vec2 screen_size;
    vec2 buffer_size;
    vec2 gaze;
    float slope;       // spacing grows by this for each pixel of distance ...
    float start;       // ... from here on; rings begin here. Both in pixels
    float first_ring;  // number of the ring in the buffer's first row
    float rings;       // rows of the buffer
    float inset_px;    // radius of the disc that is drawn at full resolution; 0: none
    float inset_rim_px;
    float layer_count;
    // Tiles and rings: contrast, of square roots of light, below which no finer samples are needed, for each
    // pixel of spacing; 0: contrast is not looked at.
    float detail;
    float pad_0;
    float pad_1;
    GridAxis axis_x;
    GridAxis axis_y;
    GridLayer layers[3];  // the finest first
};

// The spacing of samples in pixels that is asked for at a distance from the gaze: linear, as the eye's
// smallest resolvable angle is.
SHARED_FUNCTION float spacing_at(float slope, float start, float distance_px) {
    return 1.0f + slope * max(distance_px - start, 0.0f);
}

// Rings: the number of the ring (whole numbers are rings) at a distance from the gaze, and back. Neighbouring
// rings are spacing_at() apart.
SHARED_FUNCTION float ring_at(float slope, float start, float distance_px) {
    return natural_log(1.0f + slope * max(distance_px - start, 0.0f)) / slope - 0.5f;
}
SHARED_FUNCTION float radius_of_ring(float slope, float start, float ring) {
    return start + (natural_exp(slope * (ring + 0.5f)) - 1.0f) / slope;
}

// Rings by detail: a buffer of every other sample of every other ring. Where one of its texels, told by the
// whole numbers of its column and row, is among all samples; and which of its columns, whole numbers being
// texels, lies in a direction, for a ring of `count` samples.
SHARED_FUNCTION vec2 texel_of_coarse(float column, float row) {
    return vec2(2.0f * column - 0.5f, 2.0f * row + 0.5f);
}
SHARED_FUNCTION float coarse_column(float turns, float count) {
    return 0.5f * turns * count + 0.75f;
}

// One axis: screen to buffer, for a position between the screen's edges. Rectangular: with d the distance
// from the gaze, D the edge's and B its image's, B d (f + D) / (D (f + d)). Log-rectilinear: with h half the
// buffer, the smaller of d and h ln(1 + d / lambda)^(1/4).
SHARED_FUNCTION float axis_to_buffer(uint kind, GridAxis a, float position) {
    float signed_distance = position - a.gaze;
    bool low = signed_distance < 0.0f;
    float d = abs(signed_distance);
    float reach = low ? a.screen_low : a.screen_high;
    float image = low ? a.buffer_low : a.buffer_high;
    float curve = low ? a.curve_low : a.curve_high;
    float b = 0.0f;
    if (kind == kGridRectangular) {
        if (reach > 0.0f) b = image * min(d / reach * ((curve + reach) / (curve + d)), 1.0f);
    } else {
        b = min(min(d, image * sqrt(sqrt(natural_log(1.0f + d / curve)))), image);
    }
    return a.centre + (low ? -b : b);
}

// And back; positions beyond the buffer count as its edge.
SHARED_FUNCTION float axis_to_screen(uint kind, GridAxis a, float texel) {
    float signed_distance = texel - a.centre;
    bool low = signed_distance < 0.0f;
    float b = abs(signed_distance);
    float reach = low ? a.screen_low : a.screen_high;
    float image = low ? a.buffer_low : a.buffer_high;
    float curve = low ? a.curve_low : a.curve_high;
    float share = image > 0.0f ? min(b / image, 1.0f) : 0.0f;
    float d = 0.0f;
    if (kind == kGridRectangular) {
        d = share * reach * (curve / (curve + (1.0f - share) * reach));
    } else {
        float fourth = share * share * share * share;
        d = max(share * image, curve * (natural_exp(fourth) - 1.0f));
    }
    return a.gaze + (low ? -d : d);
}

SHARED_FUNCTION vec2 layer_to_screen(GridLayer layer, vec2 texel) {
    return vec2(layer.origin.x + (texel.x - layer.corner.x) * layer.step_px,
                layer.origin.y + (texel.y - layer.corner.y) * layer.step_px);
}
SHARED_FUNCTION vec2 layer_to_buffer(GridLayer layer, vec2 position) {
    return vec2(layer.corner.x + (position.x - layer.origin.x) / layer.step_px,
                layer.corner.y + (position.y - layer.origin.y) / layer.step_px);
}

// How far out of a layer's part of the screen a position is: 0 at the gaze, 1 at the edge (a rectangle).
SHARED_FUNCTION float share_of_extent(GridLayer layer, vec2 gaze, vec2 position) {
    return max(abs(position.x - gaze.x) / layer.extent.x, abs(position.y - gaze.y) / layer.extent.y);
}

// What of a layer is seen there, over the coarser ones: 1 inside, 0 outside, smooth between.
SHARED_FUNCTION float layer_weight(GridLayer layer, float share) {
    float t = clamp((1.0f - share) / max(1.0f - layer.opaque, 1e-6f), 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

// Tiles: the layer whose step is the largest power of two that is no more than the spacing asked for in the
// tile's middle.
SHARED_FUNCTION float tile_layer(float slope, float start, float distance_px) {
    float spacing = spacing_at(slope, start, distance_px);
    return spacing >= 4.0f ? 2.0f : spacing >= 2.0f ? 1.0f : 0.0f;
}

// Scattered: a number in [0, 1) for each pixel, spread evenly over every neighbourhood (the R2 sequence read
// as a dither mask, Roberts 2018). A pixel is shaded if it is below the probability.
SHARED_FUNCTION float dither_at(float column, float row) {
    // In whole numbers modulo 2^24, so that every device finds the same: 0.7548776662 and 0.5698402910 times
    // 2^24.
    uint sum = uint(column) * 12664745u + uint(row) * 9560334u;
    return float(sum & 16777215u) * (1.0f / 16777216.0f);
}

SHARED_END

#ifdef __cplusplus
#include <cstddef>
static_assert(sizeof(parafovea::shared::GridAxis) == 32);
static_assert(sizeof(parafovea::shared::GridLayer) == 48);
static_assert(offsetof(parafovea::shared::SampleGrid, slope) == 24);
static_assert(offsetof(parafovea::shared::SampleGrid, axis_x) == 64);
static_assert(offsetof(parafovea::shared::SampleGrid, layers) == 128);
static_assert(sizeof(parafovea::shared::SampleGrid) == 272);
#endif

#endif
