// Pass II: every screen pixel reads the reduced buffer where the map puts it, bilinearly (Meng et al. 2018, Section
// 3.2). The buffer goes round in v and ends in u. With EXACT_BILINEAR the weights are full floats.
#version 460
#define MAP_HANDED_ON
#include "map_block.glsl"

layout(set = 0, binding = 1) uniform sampler2D reduced;

layout(location = 0) out vec4 color;

#ifdef EXACT_BILINEAR

vec4 read(vec2 share) {
    vec2 position = share * map.buffer_size;
    ivec2 size = textureSize(reduced, 0);
    vec2 corner = floor(position - 0.5);
    vec2 weight = position - 0.5 - corner;
    ivec2 low = ivec2(corner);
    int left = clamp(low.x, 0, size.x - 1);
    int right = clamp(low.x + 1, 0, size.x - 1);
    int top = (low.y + size.y) % size.y;
    int bottom = (low.y + 1 + size.y) % size.y;
    vec4 above = mix(texelFetch(reduced, ivec2(left, top), 0), texelFetch(reduced, ivec2(right, top), 0), weight.x);
    vec4 below =
        mix(texelFetch(reduced, ivec2(left, bottom), 0), texelFetch(reduced, ivec2(right, bottom), 0), weight.x);
    return mix(above, below, weight.y);
}

#else

vec4 read(vec2 share) { return textureLod(reduced, share, 0.0); }

#endif

void main() { color = vec4(read(share_from_screen(map, gl_FragCoord.xy) - jitter_share).rgb, 1.0); }
