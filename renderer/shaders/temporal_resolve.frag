// Anti-aliasing over time: the frame is blended into a history that is moved along with the view.
// Karis 2014, "High-quality temporal supersampling" (reprojection along the nearest surface, neighbourhood in YCoCg,
// weights by luminance); Salvi 2016, "An excursion in temporal supersampling" (variance clipping); Catmull-Rom history.
#version 460
#define SPACING_BINDING 4
#include "shared/temporal.h"
#include "spacing.glsl"

layout(set = 0, binding = 0, std140) uniform TemporalBlock { Temporal temporal; };
layout(set = 0, binding = 1) uniform sampler2D frame;
layout(set = 0, binding = 2) uniform sampler2D history;  // display-linear colour; how many frames it is the mean of
layout(set = 0, binding = 3) uniform sampler2D depth_image;

layout(constant_id = 0) const uint kHasDepth = 0u;

layout(location = 0) out vec4 history_out;
layout(location = 1) out vec4 color;

// By the bits: a compiler may take for granted that there are no infinities.
bool finite(vec3 c) { return all(notEqual(floatBitsToUint(c) & 0x7f800000u, uvec3(0x7f800000u))); }

vec3 ycocg(vec3 c) {
    return vec3(dot(c, vec3(0.25, 0.5, 0.25)), dot(c, vec3(0.5, 0.0, -0.5)), dot(c, vec3(-0.25, 0.5, -0.25)));
}
vec3 rgb_of(vec3 c) { return vec3(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z); }

// Values are tone-mapped already, so that only what exceeds white must not outweigh the rest.
float trust(vec3 c) { return 1.0 / (1.0 + max(dot(c, vec3(0.25, 0.5, 0.25)) - 1.0, 0.0)); }

// Where what a pixel shows was in the last frame, in pixels; far away if it was behind the eye. Of the sky, only the
// view's turning is followed.
vec2 previous_position(vec2 position, float depth, vec2 size) {
    Camera camera = temporal.camera;
    vec3 ray = camera.ray_origin.xyz + position.x * camera.ray_per_px_x.xyz + position.y * camera.ray_per_px_y.xyz;
    vec4 world = depth > 0.0 ? vec4(camera.eye.xyz + ray * (camera.eye.w / depth), 1.0) : vec4(ray, 0.0);
    vec4 clip = temporal.previous_clip_from_world * world;
    if (clip.w <= 0.0) return vec2(-1e6);
    return (clip.xy / clip.w * 0.5 + 0.5) * size;
}

vec3 history_at(vec2 position, vec2 size) {
    vec2 centre = floor(position - 0.5) + 0.5;
    vec2 f = position - centre;
    vec2 w0 = f * (-0.5 + f * (1.0 - 0.5 * f));
    vec2 w1 = 1.0 + f * f * (-2.5 + 1.5 * f);
    vec2 w2 = f * (0.5 + f * (2.0 - 1.5 * f));
    vec2 w3 = f * f * (-0.5 + 0.5 * f);
    vec2 w12 = w1 + w2;
    vec2 low = (centre - 1.0) / size;
    vec2 middle = (centre + w2 / w12) / size;
    vec2 high = (centre + 2.0) / size;
    // The corners weigh next to nothing.
    vec4 sum = vec4(textureLod(history, middle, 0.0).rgb, 1.0) * (w12.x * w12.y);
    sum += vec4(textureLod(history, vec2(middle.x, low.y), 0.0).rgb, 1.0) * (w12.x * w0.y);
    sum += vec4(textureLod(history, vec2(low.x, middle.y), 0.0).rgb, 1.0) * (w0.x * w12.y);
    sum += vec4(textureLod(history, vec2(high.x, middle.y), 0.0).rgb, 1.0) * (w3.x * w12.y);
    sum += vec4(textureLod(history, vec2(middle.x, high.y), 0.0).rgb, 1.0) * (w12.x * w3.y);
    return max(sum.rgb / sum.a, vec3(0.0));
}

void main() {
    ivec2 last = textureSize(frame, 0) - 1;
    vec2 size = vec2(last + 1);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 spacing_now = spacing_of_grid(0u, gl_FragCoord.xy / size);

    // The surroundings, as far away as this pixel's neighbouring samples are.
    int reach = max(int(sqrt(spacing_now.x * spacing_now.y) + 0.5), 1);
    vec3 sum = vec3(0.0);
    vec3 squares = vec3(0.0);
    float count = 0.0;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            vec3 c = texelFetch(frame, clamp(pixel + reach * ivec2(x, y), ivec2(0), last), 0).rgb;
            bool counts = finite(c);
            c = counts ? ycocg(c) : vec3(0.0);
            sum += c;
            squares += c * c;
            count += counts ? 1.0 : 0.0;
        }
    }
    vec3 mean = sum / max(count, 1.0);
    vec3 deviation = sqrt(max(squares / max(count, 1.0) - mean * mean, vec3(0.0)));

    // The nearest surface around, so that edges move with what they belong to; as it is where the depth image is coarser.
    float nearest = 0.0;
    if (kHasDepth == 1u && temporal.still == 0u) {
        ivec2 most = textureSize(depth_image, 0) - 1;
        ivec2 at = ivec2(gl_FragCoord.xy * (vec2(most + 1) / size));
        int around = most == last ? 1 : 0;
        for (int y = -around; y <= around; ++y) {
            for (int x = -around; x <= around; ++x)
                nearest = max(nearest, texelFetch(depth_image, clamp(at + ivec2(x, y), ivec2(0), most), 0).r);
        }
    }

    vec3 before = vec3(0.0);
    float frames = 0.0;
    if (temporal.fresh == 0u) {
        bool still = temporal.still == 1u;
        vec2 was_at = gl_FragCoord.xy;
        if (!still) was_at = previous_position(gl_FragCoord.xy, nearest, size);
        if (all(greaterThanEqual(was_at, vec2(0.0))) && all(lessThan(was_at, size))) {
            vec4 there = texelFetch(history, ivec2(was_at), 0);
            before = still ? there.rgb : history_at(was_at, size);
            // What was drawn with samples farther apart counts for less: a gaze that arrives drops what it finds.
            vec2 spacing_then = spacing_of_grid(1u, was_at / size);
            float finer = (spacing_now.x * spacing_now.y) / (spacing_then.x * spacing_then.y);
            frames = there.a * min(finer, 1.0);
            if (!still || abs(finer - 1.0) > 1e-3) {
                vec3 off = ycocg(before) - mean;
                vec3 units = abs(off) / max(temporal.clip * deviation, vec3(1.0 / 512.0));
                float most = max(units.x, max(units.y, units.z));
                if (most > 1.0) before = max(rgb_of(mean + off / most), vec3(0.0));
            }
        }
    }

    vec3 now = texelFetch(frame, pixel, 0).rgb;
    vec3 result = before;
    if (finite(now)) {
        frames = min(frames + 1.0, 1.0 / temporal.least_weight);
        float share_now = trust(now) / frames;
        float share_before = trust(before) * (1.0 - 1.0 / frames);
        result = (now * share_now + before * share_before) / (share_now + share_before);
    } else if (frames <= 0.0) {
        result = max(rgb_of(mean), vec3(0.0));  // gone with the next frame
    }
    history_out = vec4(result, frames);
    color = vec4(result, 1.0);
}
