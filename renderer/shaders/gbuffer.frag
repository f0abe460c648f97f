// Writes what a surface is made of into the G-buffer. TANGENTS: for a normal map; COLORS: with vertex colours.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/scene_layout.h"
#include "averaged_normal.glsl"
#include "gbuffer_inputs.glsl"
#include "surface_packing.glsl"

layout(set = 0, binding = kBindMaterial, std140) uniform Material { MaterialBlock material; };
layout(set = 0, binding = kBindBaseColor) uniform sampler2D base_color_map;
layout(set = 0, binding = kBindMetallicRoughness) uniform sampler2D metallic_roughness_map;
layout(set = 0, binding = kBindNormal) uniform sampler2D normal_map;
layout(set = 0, binding = kBindOcclusion) uniform sampler2D occlusion_map;
layout(set = 0, binding = kBindEmissive) uniform sampler2D emissive_map;

layout(constant_id = kConstBaseColorTexture) const uint kBaseColorTexture = 0u;
layout(constant_id = kConstMetallicRoughnessTexture) const uint kMetallicRoughnessTexture = 0u;
layout(constant_id = kConstOcclusionTexture) const uint kOcclusionTexture = 0u;
layout(constant_id = kConstEmissiveTexture) const uint kEmissiveTexture = 0u;
layout(constant_id = kConstMask) const uint kMask = 0u;
layout(constant_id = kConstTextureTransforms) const uint kTextureTransforms = 0u;
layout(constant_id = kConstBlendedLayer) const uint kBlendedLayer = 0u;

#ifdef COLORS
layout(location = 2) in vec4 color;
#endif
layout(location = 0) out uvec4 words;

vec2 position_in(uint texture_index) {
    if (kTextureTransforms == 0u) return uv();
    vec3 at = vec3(uv(), 1.0);
    return vec2(dot(material.transforms[2u * texture_index].xyz, at),
                dot(material.transforms[2u * texture_index + 1u].xyz, at));
}

void main() {
    vec4 base = material.base_color;
#ifdef COLORS
    base *= color;
#endif
    if (kBaseColorTexture == 1u) base *= texture(base_color_map, position_in(0u));
    if (kMask == 1u && base.a < material.factors.w) discard;

    float metallic = material.factors.x;
    float roughness = material.factors.y;
    if (kMetallicRoughnessTexture == 1u) {
        vec2 m = texture(metallic_roughness_map, position_in(1u)).bg;
        metallic *= m.x;
        roughness *= m.y;
    }

    vec3 normal = normalize(normal_u.xyz);
#ifdef TANGENTS
    vec4 given = tangent();
    vec3 t = given.xyz - normal * dot(normal, given.xyz);
    t *= inversesqrt(max(dot(t, t), 1e-12));
    vec3 bitangent = cross(normal, t) * given.w;
    vec3 sampled = texture(normal_map, position_in(2u)).xyz * 2.0 - 1.0;
    roughness = toksvig_roughness(roughness, sampled);
    sampled.xy *= material.emissive.w;
    normal = normalize(t * sampled.x + bitangent * sampled.y + normal * sampled.z);
#endif
    if (!gl_FrontFacing) normal = -normal;

    words = uvec4(packed_normal_metallic(normal, metallic), packed_color_roughness(base.rgb, roughness), 0u, 0u);
    vec3 emitted = material.emissive.rgb;
    if (kEmissiveTexture == 1u) emitted *= texture(emissive_map, position_in(4u)).rgb;
    float occlusion = 1.0;
    if (kOcclusionTexture == 1u)
        occlusion = 1.0 + material.factors.z * (texture(occlusion_map, position_in(3u)).r - 1.0);
    words.z = packed_radiance(emitted);
    words.w = packed_bytes(vec4(occlusion, kBlendedLayer == 1u ? base.a : 1.0, material.glass.x,
                                (material.glass.y - 1.0) * 0.5));
}
