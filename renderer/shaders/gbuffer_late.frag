// Writes into the G-buffer where shading is to read a surface's textures, instead of reading them here: word 0 normal
// (octahedral, 12 + 12 bits) and material (8), word 1 texture coordinates (16 + 16), word 2 the tangent and the texture
// level of one pixel (see late_frame() in surface_packing.glsl).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/scene_layout.h"
#include "surface_packing.glsl"

layout(set = 0, binding = kBindMaterial, std140) uniform Material { MaterialBlock material; };
layout(set = 0, binding = kBindBaseColor) uniform sampler2D base_color_map;

layout(constant_id = kConstBaseColorTexture) const uint kBaseColorTexture = 0u;
layout(constant_id = kConstNormalTexture) const uint kNormalTexture = 0u;
layout(constant_id = kConstMask) const uint kMask = 0u;

layout(location = 0) in vec3 normal_in;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 tangent_in;
layout(location = 0) out uvec4 words;

void main() {
    if (kMask == 1u) {
        float alpha = material.base_color.a;
        if (kBaseColorTexture == 1u) alpha *= texture(base_color_map, uv).a;
        if (alpha < material.factors.w) discard;
    }
    vec2 along_x = dFdx(uv);
    vec2 along_y = dFdy(uv);
    float level = 0.5 * log2(max(max(dot(along_x, along_x), dot(along_y, along_y)), 1e-14));

    float facing = gl_FrontFacing ? 1.0 : -1.0;
    uint normal_word = packed_normal_metallic(facing * normalize(normal_in), 0.0) | uint(material.glass.z) << 24;
    vec4 tangent = vec4(0.0, 0.0, 0.0, 1.0);
    // Seen from behind, the whole frame turns over.
    if (kNormalTexture == 1u) tangent = facing * tangent_in;
    words = uvec4(normal_word, packed_position(uv), packed_frame(unpacked_normal(normal_word), tangent, level), 0u);
}
