// Pass I: light only the samples of the reduced buffer (Meng et al. 2018, Algorithm 1 turned round: each texel asks
// where on the screen it lies).
#define METHOD_SET 1
#include "sampled_position.glsl"
#include "shade.glsl"

vec4 pass_1(vec2 texel_centre) {
    return vec4(shade_sample(sampled_position(texel_centre), sample_spacing(map, texel_centre + jitter)), 1.0);
}
