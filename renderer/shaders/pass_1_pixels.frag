// Pass I around the gaze, in pixels: where texels are finer, light is found once for all texels in a pixel. Runs over the
// square of KernelMap::fine_corner.
#version 460
#define METHOD_SET 1
#include "jitter.glsl"
#include "map_block.glsl"
#include "shade.glsl"

layout(location = 0) out vec4 color;

void main() { color = vec4(shade_sample(map.fine_corner + gl_FragCoord.xy + jitter, vec2(1.0)), 1.0); }
