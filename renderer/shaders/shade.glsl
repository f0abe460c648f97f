// What is shaded: a scene of meshes, the ray-marched scene, or a picture. Every variant gives
//   vec3 shade_sample(vec2 position_px, vec2 spacing_px)
// and declares descriptor set 0.
#ifndef SHADE_GLSL
#define SHADE_GLSL

#ifdef SHADE_PICTURE

layout(set = 0, binding = 0) uniform sampler2D picture;

// The picture at a position in pixels: bilinear in full float precision (samplers may keep 8 bits of the weights),
// clamped to its edges.
vec3 shade_sample(vec2 position_px, vec2 spacing_px) {
    ivec2 last = textureSize(picture, 0) - 1;
    vec2 corner = floor(position_px - 0.5);
    vec2 weight = position_px - 0.5 - corner;
    ivec2 low = clamp(ivec2(corner), ivec2(0), last);
    ivec2 high = clamp(ivec2(corner) + 1, ivec2(0), last);
    vec3 above = mix(texelFetch(picture, low, 0).rgb, texelFetch(picture, ivec2(high.x, low.y), 0).rgb, weight.x);
    vec3 below = mix(texelFetch(picture, ivec2(low.x, high.y), 0).rgb, texelFetch(picture, high, 0).rgb, weight.x);
    return mix(above, below, weight.y);
}

#else

#include "shading.glsl"

#endif

#endif
