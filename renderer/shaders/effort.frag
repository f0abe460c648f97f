// A sample in every pixel, with less work in it the farther it is from the gaze.
#version 460
#include "jitter.glsl"
#include "shade.glsl"
#include "shared/effort.h"

layout(set = 1, binding = 0, std140) uniform EffortBlock { EffortFalloff falloff; };

layout(constant_id = 0) const uint kSaveOnSteps = 0u;  // 0: on occlusion

layout(location = 0) out vec4 color;

void main() {
    float effort = effort_at(falloff, length(gl_FragCoord.xy - falloff.gaze));
    if (kSaveOnSteps == 1u) {
        step_effort = effort;
    } else {
        occlusion_effort = effort;
    }
    color = vec4(shade_sample(gl_FragCoord.xy + jitter, vec2(1.0)), 1.0);
}
