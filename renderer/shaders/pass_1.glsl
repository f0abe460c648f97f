// Pass I: light only the samples of the reduced buffer (Meng et al. 2018, Algorithm 1 turned round: each texel asks
// where on the screen it lies). A texel off the screen takes the nearest edge.
#define METHOD_SET 1
#include "jitter.glsl"
#include "shade.glsl"
#include "map_block.glsl"

vec4 pass_1(vec2 texel_centre) {
    vec2 texel = texel_centre + jitter;
    vec2 position = clamp(screen_from_buffer(map, texel), vec2(0.5), map.screen_size - 0.5);
    return vec4(shade_sample(position, sample_spacing(map, texel)), 1.0);
}
