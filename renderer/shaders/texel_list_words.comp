// Gathers what the mask of needed texels (see read_mask.frag) says into words.
#version 460
#define LIST_SET 0
#define WRITE_LIST
#include "texel_list.glsl"

layout(local_size_x = 64) in;
layout(set = LIST_SET, binding = 4) uniform sampler2D needed;

void main() {
    uint row = gl_GlobalInvocationID.x;
    uint word = gl_GlobalInvocationID.y;
    if (row >= list.height) return;
    uint first = kTexelsPerWord * word;
    uint last = min(first + kTexelsPerWord, list.width);
    uint bits = 0u;
    for (uint column = first; column < last; ++column)
        bits |= (texelFetch(needed, ivec2(column, row), 0).r > 0.0 ? 1u : 0u) << (column - first);
    words[word * list.height + row] = bits;
}
