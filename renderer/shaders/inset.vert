// A disc around the gaze as large as the inset, drawn as sectors: three vertices a sector, kInsetSectors sectors.
#version 460
#define METHOD_SET 1
#include "map_block.glsl"

const int kInsetSectors = 64;

void main() {
    int corner = gl_VertexIndex % 3;
    vec2 position = map.gaze;
    if (corner != 0) {
        float turns = float((gl_VertexIndex / 3 + corner - 1) % kInsetSectors) / float(kInsetSectors);
        // The sides of the polygon lie outside the circle.
        position += unit_vector(turns) * ((map.inset_px + 1.0) / unit_vector(0.5 / float(kInsetSectors)).x);
    }
    gl_Position = vec4(position / map.screen_size * 2.0 - 1.0, 0.0, 1.0);
}
