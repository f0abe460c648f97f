// The needed texels of a reduced buffer, as a list. Define LIST_SET, and WRITE_LIST if it is being made.
#ifndef TEXEL_LIST_GLSL
#define TEXEL_LIST_GLSL

#include "shared/texel_list.h"

#ifdef WRITE_LIST

layout(set = LIST_SET, binding = 0, std430) restrict buffer HeaderBlock { TexelListHeader list; };
layout(set = LIST_SET, binding = 1) uniform restrict writeonly uimage2D listed;
// The words of one column after another.
layout(set = LIST_SET, binding = 2, std430) restrict buffer WordBlock { uint words[]; };
layout(set = LIST_SET, binding = 3, std430) restrict buffer RowBlock { uint first_of_row[]; };

uint words_of_row() { return (list.width + kTexelsPerWord - 1u) / kTexelsPerWord; }

#else

layout(set = LIST_SET, binding = 0, std140) uniform HeaderBlock { TexelListHeader list; };
layout(set = LIST_SET, binding = 1) uniform usampler2D listed;

#endif

// Where in the list's image the entry of a texel stands: column | row << 16.
ivec2 entry_at(uint index) { return ivec2(index % kListWidth, index / kListWidth); }

#ifndef WRITE_LIST
ivec2 listed_texel(uint index) {
    uint packed = texelFetch(listed, entry_at(index), 0).r;
    return ivec2(packed & 0xffffu, packed >> 16);
}
#endif

#endif
