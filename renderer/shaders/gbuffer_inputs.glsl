// What gbuffer.vert hands on, as the fragment shaders of the G-buffer read it.
#ifndef GBUFFER_INPUTS_GLSL
#define GBUFFER_INPUTS_GLSL

layout(location = 0) in vec4 normal_u;
#ifdef TANGENTS
layout(location = 1) in vec4 tangent_v;
#else
layout(location = 1) in float v;
#endif

#ifdef TANGENTS
vec2 uv() { return vec2(normal_u.w, tangent_v.w); }

// Of any length; w: handedness. Interpolating shortens, but by less than what separates the two lengths.
vec4 tangent() {
    vec3 t = tangent_v.xyz;
    return vec4(t, dot(t, t) > kLeftHandedLength ? -1.0 : 1.0);
}
#else
vec2 uv() { return vec2(normal_u.w, v); }
#endif

#endif
