// Where on the screen a texel of the reduced buffer is sampled. One off the screen takes the nearest edge.
#ifndef SAMPLED_POSITION_GLSL
#define SAMPLED_POSITION_GLSL

#include "jitter.glsl"
#include "map_block.glsl"

vec2 sampled_position(vec2 texel_centre) {
    return clamp(screen_from_buffer(map, texel_centre + jitter), vec2(0.5), map.screen_size - 0.5);
}

#endif
