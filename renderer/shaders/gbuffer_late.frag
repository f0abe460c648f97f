// Writes into the G-buffer where shading is to read a surface's textures, instead of reading them here: word 0 normal
// (octahedral, 12 + 12 bits) and material (8), word 1 texture coordinates (16 + 16), word 2 the tangent and the texture
// level of one pixel (see packed_frame() in surface_packing.glsl). TANGENTS: for a normal map.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/scene_layout.h"
#include "gbuffer_inputs.glsl"
#include "surface_packing.glsl"

layout(set = 0, binding = kBindMaterial, std140) uniform Material { MaterialBlock material; };
layout(set = 0, binding = kBindBaseColor) uniform sampler2D base_color_map;

layout(constant_id = kConstBaseColorTexture) const uint kBaseColorTexture = 0u;
layout(constant_id = kConstMask) const uint kMask = 0u;

layout(location = 0) out uvec4 words;

void main() {
    if (kMask == 1u) {
        float alpha = material.base_color.a;
        if (kBaseColorTexture == 1u) alpha *= texture(base_color_map, uv()).a;
        if (alpha < material.factors.w) discard;
    }
    // Seen from behind, the whole frame turns over.
    float facing = gl_FrontFacing ? 1.0 : -1.0;
    words.x = packed_normal(facing * normal_u.xyz) | uint(material.glass.z) << 24;
    words.y = packed_position(uv());
    words.z = packed_level(dFdx(uv()), dFdy(uv()));
#ifdef TANGENTS
    words.z |= packed_tangent(facing * tangent());
#endif
    words.w = 0u;
}
