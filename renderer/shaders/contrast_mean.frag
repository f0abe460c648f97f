// First half of the mean around each pixel: along rows.
#version 460
#include "contrast.glsl"

layout(location = 0) out vec4 mean;

void main() {
    mean = vec4(mean_along(picture, ivec2(gl_FragCoord.xy), ivec2(1, 0), length(foveation_at(gl_FragCoord.xy))), 1.0);
}
