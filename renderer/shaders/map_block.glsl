// The kernel log-polar map of this frame, binding 0 of the method's descriptor set. Define METHOD_SET before.
#ifndef MAP_BLOCK_GLSL
#define MAP_BLOCK_GLSL

#include "shared/kernel_map.h"

layout(set = METHOD_SET, binding = 0, std140) uniform KernelMapBlock { KernelMap map; };

#endif
