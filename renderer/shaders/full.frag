// The reference: one sample at every pixel's centre.
#version 460
#include "shade.glsl"

layout(location = 0) out vec4 color;

void main() { color = vec4(shade_sample(gl_FragCoord.xy, vec2(1.0)), 1.0); }
