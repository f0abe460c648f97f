// Pass I around the gaze, in pixels: where texels are finer, light them once for all texels in them. Runs over the square
// of fine_corner().
#version 460
#define METHOD_SET 1
#include "map_block.glsl"
#include "shade.glsl"

layout(location = 0) out vec4 color;

void main() { color = vec4(shade_sample(fine_corner(map) + gl_FragCoord.xy, vec2(1.0)), 1.0); }
