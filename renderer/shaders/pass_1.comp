// Pass I in compute shaders: the texels that the mask says are needed.
#version 460
#include "pass_1.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 2, binding = 0) uniform writeonly image2D reduced;
layout(set = 2, binding = 1) uniform sampler2D needed;

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(reduced))) || texelFetch(needed, texel, 0).r == 0.0) return;
    imageStore(reduced, texel, pass_1(vec2(texel) + 0.5));
}
