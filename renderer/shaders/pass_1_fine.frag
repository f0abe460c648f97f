// Pass I for the columns that are finer than pixels: each texel takes the light of the pixel that it lies in, which
// pass_1_pixels.frag found.
#version 460
#define MAP_HANDED_ON
#include "sampled_position.glsl"

layout(set = 0, binding = 1) uniform sampler2D pixels;

layout(location = 0) out vec4 color;

void main() { color = texelFetch(pixels, ivec2(floor(sampled_position(gl_FragCoord.xy)) - map.fine_corner), 0); }
