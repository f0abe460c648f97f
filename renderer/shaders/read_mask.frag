// Which texels of the reduced buffer are needed: those in the bilinear footprint of some screen pixel and, where the
// internal filter reads them, their neighbours. Runs over the buffer; writes depth 1 for a needed texel and nothing
// for the others. Errs on the side of needing a texel.
#version 460
#define METHOD_SET 0
#include "jitter.glsl"
#include "map_block.glsl"

layout(constant_id = 2) const uint kInternalFilter = 0u;

// Rounding may differ between this shader and the one that reads: a footprint counts as a little larger.
const float kSlack = 1.0 / 128.0;
// Where a kernel is level, many columns have radii that differ by less than a float tells.
const float kRounding = 1.0 - 1e-6;
// A texel with more pixels to look at than this is taken as needed.
const int kMostPixels = 1024;

// The pixels that read a texel have their centres in a part of a ring around the gaze.
struct Cell {
    float inner;  // radii, pixels; inner below 0: up to the gaze itself
    float outer;
    vec2 direction;    // of its middle
    float half_turns;  // half of the angle that it spans
    float sine_squared;
};

Cell cell_of(vec2 texel, float reach) {
    Cell cell;
    // The first column holds everything nearer to the gaze, the last everything farther.
    cell.inner = texel.x - reach <= 0.0 ? -1.0 : kRounding * radius_of_column(map, texel.x - reach);
    cell.outer = texel.x + reach >= map.buffer_size.x ? 1e9 : radius_of_column(map, texel.x + reach) / kRounding;
    // Under the opaque part of the inset nothing is seen.
    if (map.inset_px > 0.0) cell.inner = max(cell.inner, map.inset_px - map.inset_rim_px - 0.01);
    cell.direction = unit_vector(texel.y / map.buffer_size.y);
    cell.half_turns = reach / map.buffer_size.y;
    float sine = unit_vector(cell.half_turns).y;
    cell.sine_squared = sine * sine;
    return cell;
}

bool holds(Cell cell, ivec2 pixel) {
    vec2 d = vec2(pixel) + 0.5 - map.gaze;
    float squared = dot(d, d);
    // The map takes pixels nearer than one pixel for that far away.
    float read_at = max(squared, 1.0);
    bool in_ring = (cell.inner < 0.0 || read_at > cell.inner * cell.inner) && read_at < cell.outer * cell.outer;
    // The sine of the angle between the two directions, times the distance.
    float across = cell.direction.x * d.y - cell.direction.y * d.x;
    bool in_angle = dot(cell.direction, d) > 0.0 && across * across < squared * cell.sine_squared;
    // Very few rows are all around; and at the gaze itself there is no direction.
    return in_ring && (in_angle || cell.half_turns >= 0.2 || squared < 1e-4);
}

void main() {
    vec2 texel = gl_FragCoord.xy + jitter;
    bool filtered = kInternalFilter != 0u && gl_FragCoord.x + 1.0 >= 0.5 * map.buffer_size.x;
    Cell cell = cell_of(texel, (filtered ? 2.0 : 1.0) + kSlack);
    ivec2 last = ivec2(map.screen_size) - 1;

    // Look at the pixel that is nearest to the sample: enough wherever samples are sparse.
    float outer = min(cell.outer, radius_of_column(map, map.buffer_size.x));
    vec2 position = map.gaze + radius_of_column(map, texel.x) * cell.direction;
    bool found = holds(cell, clamp(ivec2(floor(position)), ivec2(0), last));
    // The cell's farthest point is at most this far from the sample.
    float extent = outer - max(cell.inner, 0.0) + outer * 2.0 * kMapPi * cell.half_turns;
    vec2 outside = max(-position, position - map.screen_size);
    int undecided = !found && max(outside.x, outside.y) <= extent ? 1 : 0;

    // A loop, because some devices run both sides of a branch; nearly all texels are decided before it.
    for (int turn = 0; turn < undecided; ++turn) {
        float inner = max(cell.inner, 0.0);
        vec2 low = -vec2(outer + 0.01);
        vec2 high = vec2(outer + 0.01);
        if (cell.half_turns < 0.125) {
            vec2 side = unit_vector(cell.half_turns);
            vec2 along = cell.direction * side.x;
            vec2 across = vec2(-cell.direction.y, cell.direction.x) * side.y;
            vec2 from = along - across;
            vec2 to = along + across;
            float bulge = outer * (1.0 - side.x) + 0.01;
            low = min(min(from, to) * inner, min(from, to) * outer) - bulge;
            high = max(max(from, to) * inner, max(from, to) * outer) + bulge;
        }
        ivec2 first_pixel = max(ivec2(ceil(max(map.gaze + low - 0.5, vec2(-1.0)))), ivec2(0));
        ivec2 last_pixel = min(ivec2(floor(min(map.gaze + high - 0.5, map.screen_size))), last);
        ivec2 count = max(last_pixel - first_pixel + 1, ivec2(0));
        // Look at every pixel there, row by row.
        found = count.x > kMostPixels || count.y > kMostPixels || count.x * count.y > kMostPixels;
        ivec2 pixel = first_pixel;
        while (!found && pixel.x <= last_pixel.x && pixel.y <= last_pixel.y) {
            found = holds(cell, pixel);
            pixel = pixel.x < last_pixel.x ? ivec2(pixel.x + 1, pixel.y) : ivec2(first_pixel.x, pixel.y + 1);
        }
    }
    if (!found) discard;
    gl_FragDepth = 1.0;
}
