// Pass I in fragments, for the texels of a list: each fragment takes one; see texel_list.vert.
#version 460
#include "pass_1_listed.glsl"

void main() {
    // Eight texels that follow each other in the list make a block of 4x2 fragments, which devices shade together.
    uvec2 at = uvec2(gl_FragCoord.xy);
    uint block = ((at.x >> 2) << (list.log2_rows - 1u)) + (at.y >> 1);
    uint index = block << 3 | (at.y & 1u) << 2 | at.x & 3u;
    if (index < list.count) shade_listed(index);
}
