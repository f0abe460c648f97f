// Puts a mesh on the picture and its normal and texture coordinates at its vertices; TANGENTS: its tangents, for normal
// maps; COLORS: its vertex colours. They share vectors (see gbuffer_inputs.glsl): software devices pay for each vector at
// each vertex and at each triangle.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/scene_layout.h"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
// An InstanceRecord.
layout(location = kInstanceLocation) in mat4 clip_from_mesh;
layout(location = kInstanceLocation + 4) in vec4 normal_x;
layout(location = kInstanceLocation + 5) in vec4 normal_y;
layout(location = kInstanceLocation + 6) in vec4 normal_z;

layout(location = 0) out vec4 normal_u;
#ifdef TANGENTS
layout(location = 3) in vec4 tangent;  // w: handedness
layout(location = 1) out vec4 tangent_v;
#else
layout(location = 1) out float v;
#endif
#ifdef COLORS
layout(location = 4) in vec4 color;
layout(location = 2) out vec4 color_out;
#endif

vec3 turned(vec3 v) {
    return normal_x.xyz * v.x + normal_y.xyz * v.y + normal_z.xyz * v.z;
}

void main() {
    gl_Position = clip_from_mesh * vec4(position, 1.0);
    normal_u = vec4(turned(normal), uv.x);
#ifdef TANGENTS
    vec3 t = turned(tangent.xyz);
    float length_out = tangent.w * normal_x.w < 0.0 ? kLeftHandedLength : 1.0;
    tangent_v = vec4(t * (length_out * inversesqrt(max(dot(t, t), 1e-30))), uv.y);
#else
    v = uv.y;
#endif
#ifdef COLORS
    color_out = color;
#endif
}
