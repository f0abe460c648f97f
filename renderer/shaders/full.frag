// The reference: one sample in every pixel, at its centre but for the jitter.
#version 460
#include "jitter.glsl"
#include "shade.glsl"

layout(location = 0) out vec4 color;

void main() { color = vec4(shade_sample(gl_FragCoord.xy + jitter, vec2(1.0)), 1.0); }
