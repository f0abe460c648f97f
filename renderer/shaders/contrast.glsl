// Contrast preservation (Patney et al. 2016, supplement, "enhanceContrast"): the degree of foveation and the local
// mean around it. The picture is at binding 1 of set 0, its samples' spacing at binding 0.
#ifndef CONTRAST_GLSL
#define CONTRAST_GLSL

#define SPACING_BINDING 0
#include "spacing.glsl"

layout(set = 0, binding = 1) uniform sampler2D picture;

// The blur of samples that far apart, radial and tangential, as a standard deviation in pixels; 0 in the fovea.
vec2 foveation_at(vec2 position) {
    vec2 sigma = 0.5 * max(spacing_of_grid(0u, position / vec2(textureSize(picture, 0))) - 1.0, vec2(0.0));
    return length(sigma) < 1.0 / 64.0 ? vec2(0.0) : sigma;
}

// A Gaussian along one axis, twice as wide as the blur.
vec3 mean_along(sampler2D image, ivec2 pixel, ivec2 axis, float degree) {
    ivec2 last = textureSize(image, 0) - 1;
    float width = min(2.0 * degree, 8.0);
    int reach = int(ceil(2.0 * width));
    vec3 sum = texelFetch(image, pixel, 0).rgb;
    float weights = 1.0;
    for (int i = 1; i <= reach; ++i) {
        float weight = exp(-0.5 * float(i * i) / (width * width));
        sum += weight * (texelFetch(image, clamp(pixel + i * axis, ivec2(0), last), 0).rgb +
                         texelFetch(image, clamp(pixel - i * axis, ivec2(0), last), 0).rgb);
        weights += 2.0 * weight;
    }
    return sum / weights;
}

#endif
