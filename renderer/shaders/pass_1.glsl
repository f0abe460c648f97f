// Pass I: light only the samples of the reduced buffer (Meng et al. 2018, Algorithm 1 turned round: each texel asks
// where on the screen it lies). Where samples are finer than pixels, they have the light of theirs.
#define METHOD_SET 1
#include "sampled_position.glsl"
#include "shade.glsl"

vec4 pass_1(vec2 texel_centre) {
    vec2 position = sampled_position(texel_centre);
    vec2 spacing = sample_spacing(map, texel_centre + jitter);
    if (texel_centre.x < map.fine_columns) {
        position = floor(position) + 0.5 + jitter;
        spacing = vec2(1.0);
    }
    return vec4(shade_sample(position, spacing), 1.0);
}
