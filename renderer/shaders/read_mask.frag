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
// A texel with more pixels to look at than this is taken as needed.
const int kMostPixels = 1024;

// Whether the footprint of a pixel, widened by `reach` - 1 texels, holds the texel with this sample.
bool reads(ivec2 pixel, vec2 texel, float reach) {
    vec2 position = vec2(pixel) + 0.5;
    // Under the opaque part of the inset nothing is seen.
    if (length(position - map.gaze) < map.inset_px - map.inset_rim_px - 0.01) return false;
    vec2 distance = buffer_from_screen(map, position) - texel;
    distance.y -= map.buffer_size.y * floor(distance.y / map.buffer_size.y + 0.5);
    return abs(distance.x) < reach && abs(distance.y) < reach;
}

bool needed(vec2 texel, float reach) {
    ivec2 last = ivec2(map.screen_size) - 1;

    // Look at the pixel that is nearest to the sample: enough wherever samples are sparse.
    vec2 position = screen_from_buffer(map, texel);
    ivec2 nearest = clamp(ivec2(floor(position)), ivec2(0), last);
    if (reads(nearest, texel, reach)) return true;

    // Bound the part of a ring from which the texel can be read.
    float inner = texel.x - reach <= 0.0 ? 0.0 : radius_of_column(map, texel.x - reach);
    float outer = radius_of_column(map, texel.x + reach) + 0.01;
    float half_turns = reach / map.buffer_size.y;
    vec2 low = -vec2(outer);
    vec2 high = vec2(outer);
    if (half_turns < 0.125) {
        vec2 from = unit_vector((texel.y - reach) / map.buffer_size.y);
        vec2 to = unit_vector((texel.y + reach) / map.buffer_size.y);
        float bulge = outer * (1.0 - unit_vector(half_turns).x) + 0.01;
        low = min(min(from, to) * inner, min(from, to) * outer) - bulge;
        high = max(max(from, to) * inner, max(from, to) * outer) + bulge;
    }
    ivec2 first_pixel = max(ivec2(ceil(max(map.gaze + low - 0.5, vec2(-1.0)))), ivec2(0));
    ivec2 last_pixel = min(ivec2(floor(min(map.gaze + high - 0.5, map.screen_size))), last);
    ivec2 count = last_pixel - first_pixel + 1;
    if (count.x <= 0 || count.y <= 0) return false;
    if (count.x > kMostPixels || count.y > kMostPixels || count.x * count.y > kMostPixels) return true;

    // Look at every pixel there.
    bool found = false;
    for (int i = 0; i < count.x * count.y && !found; ++i) {
        found = reads(first_pixel + ivec2(i % count.x, i / count.x), texel, reach);
    }
    return found;
}

void main() {
    vec2 texel = gl_FragCoord.xy + jitter;
    bool filtered = kInternalFilter != 0u && gl_FragCoord.x + 1.0 >= 0.5 * map.buffer_size.x;
    if (!needed(texel, (filtered ? 2.0 : 1.0) + kSlack)) discard;
    gl_FragDepth = 1.0;
}
