// Pass I in compute shaders, for the texels of a list.
#version 460
#define LIST_SET 2
#include "pass_1.glsl"
#include "texel_list.glsl"

layout(local_size_x = kTexelsPerGroup) in;
layout(set = LIST_SET, binding = 2) uniform restrict writeonly image2D reduced;

void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint index = group * kTexelsPerGroup + gl_LocalInvocationIndex;
    if (index >= list.count) return;
    ivec2 texel = listed_texel(index);
    imageStore(reduced, texel, pass_1(vec2(texel) + 0.5));
}
