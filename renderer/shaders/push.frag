// Pull-push, the way up: a texel that is not known takes its value from the coarser level, which is filled.
#version 460

layout(set = 0, binding = 0) uniform sampler2D fine;
layout(set = 0, binding = 1) uniform sampler2D coarse;  // linear, clamped

layout(location = 0) out vec4 color;

void main() {
    vec4 known = texelFetch(fine, ivec2(gl_FragCoord.xy), 0);
    vec3 filled = textureLod(coarse, 0.5 * gl_FragCoord.xy / vec2(textureSize(coarse, 0)), 0.0).rgb;
    color = vec4(mix(filled, known.rgb, known.a), 1.0);
}
