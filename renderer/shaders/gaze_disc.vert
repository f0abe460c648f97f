// A disc around the gaze as large as the inset, or as where texels are finer than pixels, drawn as sectors: three
// vertices a sector.
#version 460
#define METHOD_SET 1
#include "map_block.glsl"

const int kSectors = 64;

void main() {
    int corner = gl_VertexIndex % 3;
    vec2 position = map.gaze;
    if (corner != 0) {
        float turns = float((gl_VertexIndex / 3 + corner - 1) % kSectors) / float(kSectors);
        // The sides of the polygon lie outside the circle.
        position += unit_vector(turns) * ((max(map.inset_px, map.fine_px) + 1.0) / unit_vector(0.5 / float(kSectors)).x);
    }
    gl_Position = vec4(position / map.screen_size * 2.0 - 1.0, 0.0, 1.0);
}
