// Full resolution around the gaze, fading into what lies below at the rim.
#version 460
#define METHOD_SET 1
#include "jitter.glsl"
#include "shade.glsl"
#include "map_block.glsl"

layout(location = 0) out vec4 color;

void main() {
    float inside = clamp((map.inset_px - length(gl_FragCoord.xy - map.gaze)) / map.inset_rim_px, 0.0, 1.0);
    color = vec4(shade_sample(gl_FragCoord.xy + jitter, vec2(1.0)), inside);
}
