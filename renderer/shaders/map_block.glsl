// The kernel log-polar map of this frame, binding 0 of the method's descriptor set. Define METHOD_SET before.
#ifndef MAP_BLOCK_GLSL
#define MAP_BLOCK_GLSL

#include "shared/kernel_map.h"

layout(set = METHOD_SET, binding = 0, std140) uniform KernelMapBlock { KernelMap map_block; };

// Which kernel is known when the pipeline is built, because some devices run every branch of a choice.
layout(constant_id = 0) const uint kMapKernel = 0u;
layout(constant_id = 1) const uint kMapAsPrinted = 0u;
layout(constant_id = 3) const uint kMapDoublings = 99u;

KernelMap specialized_map() {
    KernelMap m = map_block;
    m.kernel = kMapKernel;
    m.as_printed = kMapAsPrinted;
    m.doublings = kMapDoublings;
    return m;
}
#define map specialized_map()

#endif
