// Evaluates the field of the ray-marched scene on the device, one pair of points an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/primitives_field.glsl"

layout(local_size_x = 64) in;

layout(set = 0, binding = 0, std430) readonly buffer Points { vec4 points[]; };      // 2 per pair: p and q
layout(set = 0, binding = 1, std430) writeonly buffer Results { vec4 results[]; };  // 3 per pair: one for each row

vec4 result(int row, vec3 p, vec3 q) {
    return vec4(row_field(row, p), row_field(row, q), row_span(row, q, normalize(p - q), 0.0));
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (2 * i >= points.length()) return;
    vec3 p = points[2 * i].xyz;
    vec3 q = points[2 * i + 1].xyz;
    results[3 * i] = result(kFrontRow, p, q);
    results[3 * i + 1] = result(kMiddleRow, p, q);
    results[3 * i + 2] = result(kBackRow, p, q);
}
