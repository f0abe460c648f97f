// Second half of the mean, along columns, and the contrast around it: times 1 + f_e |sigma|, exactly 1 in the fovea
// (the supplement's code; its printed formula would not be 1 there).
#version 460
#include "contrast.glsl"

layout(set = 0, binding = 2) uniform sampler2D mean_of_rows;
layout(push_constant) uniform Push { float gain_per_px; };

layout(location = 0) out vec4 color;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 seen = texelFetch(picture, pixel, 0).rgb;
    float degree = length(foveation_at(gl_FragCoord.xy));
    if (degree > 0.0) {
        vec3 mean = mean_along(mean_of_rows, pixel, ivec2(0, 1), degree);
        seen = clamp(mean + (seen - mean) * (1.0 + degree * gain_per_px), vec3(0.0), vec3(1.0));
    }
    color = vec4(seen, 1.0);
}
