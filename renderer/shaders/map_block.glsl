// The kernel log-polar map of this frame, binding 0 of the method's descriptor set. Define METHOD_SET before, or
// MAP_HANDED_ON in fragment shaders behind map_corners.vert: lavapipe reads a uniform block for each sample anew, what is
// handed on once for many.
#ifndef MAP_BLOCK_GLSL
#define MAP_BLOCK_GLSL

#include "shared/kernel_map.h"

#ifdef MAP_HANDED_ON

layout(location = 0) flat in vec4 handed_map[kMapVectors];
layout(location = kMapVectors) flat in vec2 jitter_share;  // this frame's jitter, in widths and heights of the buffer

KernelMap map_of_frame() {
    KernelMap m;
    m.screen_size = handed_map[0].xy;
    m.buffer_size = handed_map[0].zw;
    m.gaze = handed_map[1].xy;
    m.log_max_radius = handed_map[1].z;
    m.alpha = handed_map[1].w;
    m.inset_px = handed_map[2].z;
    m.inset_rim_px = handed_map[2].w;
    m.beta_low = handed_map[3];
    m.beta_high = handed_map[4];
    m.mar_slope = handed_map[5].x;
    m.mar_start = handed_map[5].y;
    m.fine_columns = handed_map[5].w;
    m.fine_corner = handed_map[6].xy;
    return m;
}

#else

layout(set = METHOD_SET, binding = 0, std140) uniform KernelMapBlock { KernelMap map_block; };

KernelMap map_of_frame() { return map_block; }

#endif

// Which kernel is known when the pipeline is built, because some devices run every branch of a choice.
layout(constant_id = 0) const uint kMapKernel = 0u;
layout(constant_id = 1) const uint kMapAsPrinted = 0u;
layout(constant_id = 3) const uint kMapDoublings = 99u;

KernelMap specialized_map() {
    KernelMap m = map_of_frame();
    m.kernel = kMapKernel;
    m.as_printed = kMapAsPrinted;
    m.doublings = kMapDoublings;
    return m;
}
#define map specialized_map()

#endif
