// Pass I in compute shaders.
#version 460
#include "pass_1_listed.glsl"

layout(local_size_x = kTexelsPerGroup) in;

void main() {
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint index = group * kTexelsPerGroup + gl_LocalInvocationIndex;
    if (index < list.count) shade_listed(index);
}
