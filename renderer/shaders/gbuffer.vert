// Puts a mesh on the picture and its normal and texture coordinates at its vertices; TANGENTS: its tangents, for normal
// maps; COLORS: its vertex colours.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/scene_layout.h"

layout(push_constant) uniform Push { InstancePush instance; };

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;
layout(location = 0) out vec3 normal_out;
layout(location = 1) out vec2 uv_out;
#ifdef TANGENTS
layout(location = 3) in vec4 tangent;  // w: handedness
layout(location = 2) out vec4 tangent_out;
#endif
#ifdef COLORS
layout(location = 4) in vec4 color;
layout(location = 3) out vec4 color_out;
#endif

vec3 turned(vec3 v) {
    return instance.normal_x.xyz * v.x + instance.normal_y.xyz * v.y + instance.normal_z.xyz * v.z;
}

void main() {
    gl_Position = instance.clip_from_mesh * vec4(position, 1.0);
    normal_out = turned(normal);
    uv_out = uv;
#ifdef TANGENTS
    tangent_out = vec4(turned(tangent.xyz), tangent.w * instance.normal_x.w);
#endif
#ifdef COLORS
    color_out = color;
#endif
}
