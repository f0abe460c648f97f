// Evaluates the kernel log-polar map on the device, one point an invocation.
#version 460
#include "shared/kernel_map.h"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, std140) uniform MapBlock { KernelMap map; };
layout(set = 0, binding = 1, std430) readonly buffer Points { vec4 points[]; };    // xy: on the screen, zw: in the buffer
layout(set = 0, binding = 2, std430) writeonly buffer Results { vec4 results[]; };  // 2 per point

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= points.length()) return;
    vec4 p = points[i];
    results[2 * i] = vec4(buffer_from_screen(map, p.xy), screen_from_buffer(map, p.zw));
    results[2 * i + 1] = vec4(sample_spacing(map, p.zw), radius_of_column(map, p.z), 0.0);
}
