// Rings by detail: what every sample would be if it were but what its coarse neighbours say. The second round shades
// over it where they differ.
#version 460
#define METHOD_SET 0
#include "sample_grid.glsl"
#include "grid_rings_coarse.glsl"

layout(location = 0) out vec4 color;

void main() {
    vec2 texel = gl_FragCoord.xy;
    float turns = turns_of_texel(texel);
    int row = int(texel.y) / 2;
    vec3 inner = read_coarse(row, turns);
    bool between = int(texel.y) % 2 == 1;
    color = vec4(between ? 0.5 * (inner + read_coarse(min(row + 1, last_coarse_row()), turns)) : inner, 1.0);
}
