// Which texels of a reduced buffer are shaded one by one; the list of them is an image (see
// renderer/methods/texel_list.h and shaders/texel_list.glsl).
#ifndef PARAFOVEA_TEXEL_LIST_H
#define PARAFOVEA_TEXEL_LIST_H

#include "bridge.h"

SHARED_BEGIN

const uint kTexelsPerGroup = 64u;  // of a compute shader that runs over the list
const uint kMostGroups = 32768u;   // side by side; what is more goes into further rows of groups
const uint kListWidth = 4096u;     // of the list's image
const uint kTexelsPerWord = 32u;   // of a row of the buffer; a bit each

// A storage block while the list is made, then a uniform block.
struct TexelListHeader {
    uint groups_x;  // for vkCmdDispatchIndirect
    uint groups_y;
    uint groups_z;
    uint count;
    uint width;  // of the reduced buffer
    uint height;
};

SHARED_END

#endif
