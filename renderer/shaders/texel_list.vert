// Two triangles over as many rows of the list's image as it fills.
#version 460
#define LIST_SET 2
#include "texel_list.glsl"

void main() {
    // Rows in twos; see pass_1_listed.frag.
    uint rows = 2u * ((list.count + (2u << list.log2_row) - 1u) >> (list.log2_row + 1u));
    const int kCorners[6] = int[](0, 1, 2, 2, 1, 3);
    int number = kCorners[gl_VertexIndex];
    vec2 corner = vec2(number & 1, float(number >> 1) * float(rows) / float(list.image_height));
    gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);
}
