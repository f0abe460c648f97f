// Every screen pixel reads the samples around it.
#version 460
#define METHOD_SET 0
#include "sample_grid.glsl"

layout(set = 0, binding = 3) uniform sampler2D samples;  // linear, clamped

layout(location = 0) out vec4 color;

vec3 read(vec2 texel) { return textureLod(samples, texel / grid.buffer_size, 0.0).rgb; }

// Along one ring; its row holds it with an overlap of a texel at either end.
vec3 read_ring(float row, float turns) {
    return read_along_row(samples, 1.0 + turns * samples_of_row[int(row)] - jitter.x, row);
}

vec3 read_rings() {
    vec2 away = gl_FragCoord.xy - grid.gaze;
    float row = ring_at(grid.slope, grid.start, length(away)) - grid.first_ring - jitter.y;
    row = clamp(row, 0.0, grid.rings - 1.0);
    float inner = floor(row);
    float turns = turns_of(away.x, away.y);
    return mix(read_ring(inner, turns), read_ring(min(inner + 1.0, grid.rings - 1.0), turns), row - inner);
}

vec3 read_smoothly(GridLayer layer) {
    vec2 texel = layer_to_buffer(layer, gl_FragCoord.xy) - jitter;
    return read(clamp(texel, layer.corner + 0.5, layer.corner + layer.size - 0.5));
}

vec3 read_nearest(GridLayer layer) {
    return texelFetch(samples, ivec2(floor(layer_to_buffer(layer, gl_FragCoord.xy))), 0).rgb;
}

// The finest layer is the screen's own pixels. Where a finer layer is all that is seen, a sample may be missing.
vec3 read_layers() {
    int coarsest = int(grid.layer_count) - 1;
    vec3 sum = vec3(0.0);
    float finer_share = 0.0;
    for (int i = coarsest; i > 0; --i) {
        finer_share = share_of_extent(grid.layers[i - 1], grid.gaze, gl_FragCoord.xy);
        float weight = i == coarsest ? 1.0 : layer_weight(grid.layers[i], share_of_extent(grid.layers[i], grid.gaze, gl_FragCoord.xy));
        if (weight > 0.0 && finer_share > grid.layers[i - 1].opaque) sum = mix(sum, read_smoothly(grid.layers[i]), weight);
    }
    float weight = layer_weight(grid.layers[0], finer_share);
    return weight > 0.0 ? mix(sum, read_nearest(grid.layers[0]), weight) : sum;
}

vec3 read_tiles() {
    GridLayer layer = grid.layers[layer_of_tile_at(gl_FragCoord.xy)];
    return kInterpolateTiles == 1u && !is_native(layer) ? read_smoothly(layer) : read_nearest(layer);
}

void main() {
    vec3 seen;
    if (kGrid == kGridRings) {
        seen = read_rings();
    } else if (axes_grid()) {
        seen = read(vec2(axis_to_buffer(kGrid, grid.axis_x, gl_FragCoord.x),
                         axis_to_buffer(kGrid, grid.axis_y, gl_FragCoord.y)) -
                    jitter);
    } else if (kGrid == kGridLayers) {
        seen = read_layers();
    } else {
        seen = read_tiles();
    }
    color = vec4(seen, 1.0);
}
