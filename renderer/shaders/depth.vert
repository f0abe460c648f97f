// Where a mesh lies: for the depth pass and the shadow map. Texture coordinates only for alpha masks.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../shared/scene_layout.h"

layout(push_constant) uniform Push { InstancePush instance; };
layout(location = 0) in vec3 position;
#ifdef MASKED
layout(location = 2) in vec2 uv;
layout(location = 0) out vec2 uv_out;
#endif

void main() {
    gl_Position = instance.clip_from_mesh * vec4(position, 1.0);
#ifdef MASKED
    uv_out = uv;
#endif
}
