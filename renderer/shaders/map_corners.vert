// One triangle that covers the whole target and hands the map on to fragments (see map_block.glsl).
#version 460
#include "jitter.glsl"
#include "shared/kernel_map.h"

layout(set = METHOD_SET, binding = 0, std140) uniform KernelMapBlock { vec4 vectors[kMapVectors]; };

layout(location = 0) flat out vec4 handed_map[kMapVectors];
layout(location = kMapVectors) flat out vec2 jitter_share;

void main() {
    vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
    handed_map = vectors;
    jitter_share = jitter / vectors[0].zw;
}
