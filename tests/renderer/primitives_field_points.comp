// Evaluates the field of the ray-marched scene on the device, one pair of points an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/primitives_field.glsl"

layout(local_size_x = 64) in;

// 2 per pair: p and q. Their w: how far the middle of a bundle of rays, which holds the one from q to p, is turned away.
layout(set = 0, binding = 0, std430) readonly buffer Points { vec4 points[]; };

struct Found {
    float at_p, at_q;
    vec2 span;
    vec2 bundle;
};

layout(set = 0, binding = 1, std430) writeonly buffer Results { Found results[]; };  // 3 per pair: one for each row

Found result(int row, vec3 p, vec3 q, vec2 turn) {
    vec3 direction = normalize(p - q);
    vec3 middle = normalize(direction + vec3(turn, 0.0));
    float apart = distance(direction, middle);
    // A wider bundle, so that the ray is not at its edge.
    BundleSpan bundle = bundle_span(row, q, middle, 1.2 * apart);
    return Found(row_field(row, p), row_field(row, q), row_span(row, q, direction, 0.0, 0.0),
                 ray_span(bundle, apart));
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (2 * i >= points.length()) return;
    vec3 p = points[2 * i].xyz;
    vec3 q = points[2 * i + 1].xyz;
    vec2 turn = vec2(points[2 * i].w, points[2 * i + 1].w);
    results[3 * i] = result(kFrontRow, p, q, turn);
    results[3 * i + 1] = result(kMiddleRow, p, q, turn);
    results[3 * i + 2] = result(kBackRow, p, q, turn);
}
