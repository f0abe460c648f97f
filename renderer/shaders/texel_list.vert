// Two triangles over as many columns of the list's image as it fills.
#version 460
#define LIST_SET 2
#include "texel_list.glsl"

void main() {
    // Columns in fours; see pass_1_listed.frag.
    uint columns = 4u * ((list.count + (4u << list.log2_rows) - 1u) >> (list.log2_rows + 2u));
    const int kCorners[6] = int[](0, 1, 2, 2, 1, 3);
    int number = kCorners[gl_VertexIndex];
    vec2 corner = vec2(float(number & 1) * float(columns) / float(list.image_width), number >> 1);
    gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);
}
