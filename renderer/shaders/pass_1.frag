// Pass I in fragments.
#version 460
#define MAP_HANDED_ON
#include "pass_1.glsl"

layout(location = 0) out vec4 color;

void main() { color = pass_1(gl_FragCoord.xy); }
