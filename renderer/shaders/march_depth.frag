// How far away a ray-marched scene is: reversed depth (near / distance along the view axis, 0 for the sky), as the depth
// image of a scene of meshes has it. Runs over a coarser picture of the screen.
#version 460
#include "shading.glsl"

layout(location = 0) out float depth;

// How many pixels of the screen a texel is wide and high.
layout(push_constant) uniform Push { vec2 pixels_per_texel; };

void main() {
    vec2 at = gl_FragCoord.xy * pixels_per_texel;
    vec3 ray = ray_at(at);
    float stretch = length(ray);
    vec3 direction = ray / stretch;
    float court = meet_court(camera.eye.xyz, direction).distance;
    float cone = length(camera.ray_per_px_x.xyz) * pixels_per_texel.x;
    RowSpans spans = row_spans(camera.eye.xyz, direction, 0.0);
    float distance = trace_solids(spans, camera.eye.xyz, direction, court > 0.0 ? court : kSky, max(0.35 * cone, 2e-4)).distance;
    depth = distance < kSky ? camera.eye.w * stretch / distance : 0.0;
}
