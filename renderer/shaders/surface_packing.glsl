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

uint packed_normal_metallic(vec3 normal, float metallic) {
    uvec2 p = uvec2(clamp(octahedral(normal) * 0.5 + 0.5, 0.0, 1.0) * 4095.0 + 0.5);
    return p.x | (p.y << 12) | (uint(clamp(metallic, 0.0, 1.0) * 255.0 + 0.5) << 24);
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

// Two axes that stand on a normal and on each other.
mat2x3 axes_around(vec3 normal) {
    vec3 axis = abs(normal.x) < 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 a = normalize(cross(normal, axis));
    return mat2x3(a, cross(normal, a));
}

// A tangent around a normal that is packed already (13 bits: its first coordinate of the two that add up to 1; the sign
// of the second), the handedness of the bitangent, and log2 of the texture coordinates' change per pixel (16 bits).
uint packed_frame(vec3 normal, vec4 tangent, float level) {
    mat2x3 axes = axes_around(normal);
    vec2 t = vec2(dot(tangent.xyz, axes[0]), dot(tangent.xyz, axes[1]));
    float along = t.x / max(abs(t.x) + abs(t.y), 1e-12);
    uint q = uint(clamp(level + 24.0, 0.0, 31.99) * 2048.0 + 0.5) & 0xffffu;
    return q | (uint(along * 4095.0 + 4095.5) << 16) | (t.y < 0.0 ? 1u << 29 : 0u) | (tangent.w < 0.0 ? 1u << 30 : 0u);
}

float unpacked_level(uint word) { return float(word & 0xffffu) * (1.0 / 2048.0) - 24.0; }

// xyz: the unit tangent; w: handedness.
vec4 unpacked_tangent(vec3 normal, uint word) {
    mat2x3 axes = axes_around(normal);
    vec2 t = vec2(float((word >> 16) & 0x1fffu) * (1.0 / 4095.0) - 1.0, 0.0);
    t.y = (1.0 - abs(t.x)) * ((word & (1u << 29)) != 0u ? -1.0 : 1.0);
    return vec4(axes * (t * inversesqrt(dot(t, t))), (word & (1u << 30)) != 0u ? -1.0 : 1.0);
}

#endif
