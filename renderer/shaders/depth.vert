// Where a mesh lies: for shadow maps. Texture coordinates only for alpha masks.
#version 460

layout(push_constant) uniform Push { mat4 clip_from_mesh; };

layout(location = 0) in vec3 position;
#ifdef MASKED
layout(location = 2) in vec2 uv;
layout(location = 0) out vec2 uv_out;
#endif

void main() {
    gl_Position = clip_from_mesh * vec4(position, 1.0);
#ifdef MASKED
    uv_out = uv;
#endif
}
