// Cuts the holes of alpha-masked materials into depth and shadow.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/scene_layout.h"

layout(set = 0, binding = kBindMaterial, std140) uniform Material { MaterialBlock material; };
layout(set = 0, binding = kBindBaseColor) uniform sampler2D base_color_map;
layout(location = 0) in vec2 uv;

void main() {
    vec3 at = vec3(uv, 1.0);
    vec2 position = vec2(dot(material.transforms[0].xyz, at), dot(material.transforms[1].xyz, at));
    if (texture(base_color_map, position).a * material.base_color.a < material.factors.w) discard;
}
