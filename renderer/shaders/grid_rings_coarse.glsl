// Rings by detail: the first round shades every other sample of every other ring, into a buffer of its own. Include
// after sample_grid.glsl.
#ifndef GRID_RINGS_COARSE_GLSL
#define GRID_RINGS_COARSE_GLSL

layout(set = METHOD_SET, binding = 3) uniform sampler2D coarse;

// The column of a coarse row at a direction.
float column_at(int coarse_row, float turns) {
    return coarse_column(fract(turns), samples_of_row[2 * coarse_row]);
}

int last_coarse_row() { return int(grid.rings) / 2; }

// Along one coarse ring; its row holds it with an overlap of a texel at either end.
vec3 read_coarse(int coarse_row, float turns) {
    return read_along_row(coarse, column_at(coarse_row, turns) + 0.5, float(coarse_row));
}

// Whether a texel of the rings is one that the first round shades.
bool is_coarse(ivec2 texel) { return texel.x % 2 == 1 && texel.y % 2 == 0; }

float turns_of_texel(vec2 texel) { return (texel.x - 1.0) / samples_of_row[int(texel.y)]; }

#endif
