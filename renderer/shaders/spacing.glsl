// The spacing of a method's samples anywhere on the screen. Define SPACING_BINDING (in set 0) before.
#ifndef SPACING_GLSL
#define SPACING_GLSL

#include "shared/spacing.h"

layout(set = 0, binding = SPACING_BINDING, std430) readonly buffer SpacingBlock { vec2 spacing_cells[]; };

// Radial and tangential, in pixels, at least 1; `place` is the position as a share of the screen. Grids lie one after
// the other in the buffer.
vec2 spacing_of_grid(uint grid, vec2 place) {
    uvec2 most = uvec2(kSpacingColumns - 1u, kSpacingRows - 1u);
    vec2 at = clamp(place * vec2(kSpacingColumns, kSpacingRows) - 0.5, vec2(0.0), vec2(most));
    uvec2 low = uvec2(at);
    uvec2 high = min(low + 1u, most);
    vec2 weight = at - vec2(low);
    uint first = grid * kSpacingColumns * kSpacingRows;
    vec2 above = mix(spacing_cells[first + low.y * kSpacingColumns + low.x],
                     spacing_cells[first + low.y * kSpacingColumns + high.x], weight.x);
    vec2 below = mix(spacing_cells[first + high.y * kSpacingColumns + low.x],
                     spacing_cells[first + high.y * kSpacingColumns + high.x], weight.x);
    return mix(above, below, weight.y);
}

#endif
