// Surfaces as words of the G-buffer. Word 0: normal (octahedral, 12 + 12 bits), metallic (8). Word 1: base colour
// (square root, 3 x 8), roughness (8). Words 2 and 3, only where a scene needs them: emitted radiance (shared exponent)
// and occlusion, opacity, transmission, index of refraction (8 bits each).
#ifndef SURFACE_PACKING_GLSL
#define SURFACE_PACKING_GLSL

// Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit Vectors".
vec2 octahedral(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return n.z < 0.0 ? folded : p;
}

vec3 from_octahedral(vec2 p) {
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float under = max(-n.z, 0.0);
    n.xy += vec2(n.x >= 0.0 ? -under : under, n.y >= 0.0 ? -under : under);
    return normalize(n);
}

// Of any length but 0; 12 + 12 bits.
uint packed_normal(vec3 normal) {
    uvec2 p = uvec2(octahedral(normal) * 2047.5 + 2048.0);
    return p.x | (p.y << 12);
}

uint packed_normal_metallic(vec3 normal, float metallic) {
    return packed_normal(normal) | (uint(clamp(metallic, 0.0, 1.0) * 255.0 + 0.5) << 24);
}

vec3 unpacked_normal(uint word) {
    return from_octahedral(vec2(uvec2(word & 0xfffu, (word >> 12) & 0xfffu)) * (2.0 / 4095.0) - 1.0);
}

uint packed_color_roughness(vec3 color, float roughness) {
    uvec4 q = uvec4(clamp(vec4(sqrt(max(color, 0.0)), roughness), 0.0, 1.0) * 255.0 + 0.5);
    return q.r | (q.g << 8) | (q.b << 16) | (q.a << 24);
}

vec4 bytes_of(uint word) {
    return vec4(uvec4(word & 0xffu, (word >> 8) & 0xffu, (word >> 16) & 0xffu, word >> 24)) * (1.0 / 255.0);
}

uint packed_bytes(vec4 v) {
    uvec4 q = uvec4(clamp(v, 0.0, 1.0) * 255.0 + 0.5);
    return q.r | (q.g << 8) | (q.b << 16) | (q.a << 24);
}

// Bounds of a squared change of texture coordinates per pixel: 2^-48 and just below 2^16.
const float kLeastSquare = 3.5527136788005009e-15;
const float kMostSquare = 65000.0;

// 9 bits for each channel, 5 for the exponent.
uint packed_radiance(vec3 radiance) {
    vec3 c = clamp(radiance, 0.0, 60000.0);
    float largest = max(max(c.r, c.g), max(c.b, 1e-6));
    float exponent = clamp(ceil(log2(largest)), -15.0, 16.0);
    uvec3 q = min(uvec3(c * exp2(9.0 - exponent) + 0.5), uvec3(511u));
    return q.r | (q.g << 9) | (q.b << 18) | (uint(exponent + 15.0) << 27);
}

vec3 unpacked_radiance(uint word) {
    float scale = exp2(float(word >> 27) - 15.0 - 9.0);
    return vec3(uvec3(word & 511u, (word >> 9) & 511u, (word >> 18) & 511u)) * scale;
}

// Texture coordinates that repeat, 16 + 16 bits.
uint packed_position(vec2 uv) {
    uvec2 q = uvec2(fract(uv) * 65536.0 + 0.5) & 0xffffu;
    return q.x | (q.y << 16);
}

vec2 unpacked_position(uint word) { return vec2(uvec2(word & 0xffffu, word >> 16)) * (1.0 / 65536.0); }

// log2 of the texture coordinates' change per pixel, given their derivatives: the upper bits of a float are nearly its
// logarithm. 11 bits, to 0.03 levels.
uint packed_level(vec2 along_x, vec2 along_y) {
    float square = max(dot(along_x, along_x), dot(along_y, along_y));
    return (floatBitsToUint(clamp(square, kLeastSquare, kMostSquare)) - floatBitsToUint(kLeastSquare)) >> 18;
}

float unpacked_level(uint word) { return float(word & 0x7ffu) * (1.0 / 64.0) - 23.97; }

// A tangent of any length but 0 (octahedral, 10 + 10 bits) and the handedness of the bitangent (1).
uint packed_tangent(vec4 tangent) {
    uvec2 p = uvec2(octahedral(tangent.xyz) * 511.5 + 512.0);
    return (p.x << 11) | (p.y << 21) | (tangent.w < 0.0 ? 1u << 31 : 0u);
}

// xyz: the unit tangent, across the normal; w: handedness.
vec4 unpacked_tangent(vec3 normal, uint word) {
    vec3 t = from_octahedral(vec2(uvec2((word >> 11) & 0x3ffu, (word >> 21) & 0x3ffu)) * (2.0 / 1023.0) - 1.0);
    t -= normal * dot(normal, t);
    return vec4(t * inversesqrt(max(dot(t, t), 1e-6)), (word & (1u << 31)) != 0u ? -1.0 : 1.0);
}

#endif
