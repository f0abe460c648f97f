// Puts a mesh on the picture and its normal, tangent frame and texture coordinates at its vertices.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/scene_layout.h"
#include "surface_packing.glsl"

layout(push_constant) uniform Push { InstancePush instance; };
layout(constant_id = kConstNormalTexture) const uint kNormalTexture = 0u;

layout(location = 0) in vec3 position;
layout(location = 1) in vec4 frame;  // octahedral normal; the tangent's angle around it in half turns; handedness
layout(location = 2) in vec2 uv;
layout(location = 3) in vec4 color;

layout(location = 0) out vec3 normal_out;
layout(location = 1) out vec2 uv_out;
layout(location = 2) out vec4 tangent_out;
layout(location = 3) out vec4 color_out;

vec3 turned(vec3 v) {
    return instance.normal_x.xyz * v.x + instance.normal_y.xyz * v.y + instance.normal_z.xyz * v.z;
}

void main() {
    gl_Position = instance.clip_from_mesh * vec4(position, 1.0);
    vec3 normal = from_octahedral(frame.xy);
    normal_out = turned(normal);
    uv_out = uv;
    color_out = color;
    tangent_out = vec4(0.0);
    if (kNormalTexture == 1u) {
        // The same axes as perpendicular_axes() in scene_resources.cpp.
        vec3 axis = abs(normal.x) < 0.9 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
        vec3 a = normalize(cross(normal, axis));
        vec3 b = cross(normal, a);
        float angle = frame.z * 3.14159265;
        tangent_out = vec4(turned(cos(angle) * a + sin(angle) * b), frame.w * instance.normal_x.w);
    }
}
