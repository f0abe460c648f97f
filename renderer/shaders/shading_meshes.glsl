// shade_sample() of scenes made of meshes: fetches the G-buffer and lights what it finds there.
#ifndef SHADING_MESHES_GLSL
#define SHADING_MESHES_GLSL

#include "averaged_normal.glsl"
#include "surface_packing.glsl"

layout(set = 0, binding = kBindGBuffer) uniform usampler2D gbuffer;
layout(set = 0, binding = kBindDepth) uniform sampler2D depth_image;
layout(set = 0, binding = kBindShadow) uniform sampler2DShadow shadow_map;
layout(set = 0, binding = kBindBlended) uniform usampler2D blended;
layout(set = 0, binding = kBindBlendedDepth) uniform sampler2D blended_depth;
layout(set = 0, binding = kBindIrradiance) uniform sampler2DArray irradiance_volume;
layout(set = 0, binding = kBindLightGrid) uniform usampler2D light_grid;
layout(set = 0, binding = kBindLampShadow) uniform sampler2DArrayShadow lamp_shadows;

layout(set = 0, binding = kBindSurfaces, std430) readonly buffer Surfaces { SurfaceMaterial surfaces[]; };
layout(set = 0, binding = kBindColors) uniform sampler2DArray surface_colors;
layout(set = 0, binding = kBindData) uniform sampler2DArray surface_data;

layout(constant_id = kConstSun) const uint kSun = 1u;
layout(constant_id = kConstSunShadow) const uint kSunShadow = 1u;
layout(constant_id = kConstBlend) const uint kBlend = 1u;
layout(constant_id = kConstEmission) const uint kEmission = 1u;
layout(constant_id = kConstLights) const uint kLights = 0u;
layout(constant_id = kConstLampShadow) const uint kLampShadow = 0u;
layout(constant_id = kConstIrradiance) const uint kIrradiance = 0u;
layout(constant_id = kConstFootprint) const uint kUseFootprint = 1u;
layout(constant_id = kConstLate) const uint kLate = 0u;
layout(constant_id = kConstLateUses) const uint kLateUses = 0u;

struct Sample {
    Surface surface;
    vec3 emitted;
    float occlusion;
};

Sample sample_of(uvec4 words) {
    Sample s;
    vec4 color_roughness = bytes_of(words.y);
    s.surface.normal = unpacked_normal(words.x);
    s.surface.metallic = float(words.x >> 24) * (1.0 / 255.0);
    s.surface.base_color = color_roughness.rgb * color_roughness.rgb;
    s.surface.roughness = color_roughness.a;
    s.emitted = vec3(0.0);
    s.occlusion = 1.0;
    return s;
}

bool any_has(uint texture_binding) { return (kLateUses & (1u << (texture_binding - 1u))) != 0u; }

// The surface whose textures the G-buffer left to be read here, filtered over reach_px. Its normal is still the
// geometry's; frame_word and `tilt` (the averaged normal in tangent space) give the textured one.
Sample late_sample(uvec4 words, float reach_px, out vec3 tilt) {
    Sample s;
    SurfaceMaterial m = surfaces[words.x >> 24];
    vec2 uv = unpacked_position(words.y);
    float level = unpacked_level(words.z) + log2(max(reach_px, 1.0)) + m.base_color.w;
    s.surface.normal = unpacked_normal(words.x);
    s.surface.base_color = m.base_color.rgb;
    s.surface.metallic = m.factors.x;
    s.surface.roughness = m.factors.y;
    s.emitted = m.emissive.rgb;
    s.occlusion = 1.0;
    tilt = vec3(0.0, 0.0, 1.0);
    if (any_has(kBindBaseColor))
        s.surface.base_color *= textureLod(surface_colors, vec3(uv, m.layers.x), max(level, m.least_levels.x)).rgb;
    if (any_has(kBindMetallicRoughness)) {
        vec2 metal_rough = textureLod(surface_data, vec3(uv, m.layers.y), max(level, m.least_levels.y)).bg;
        s.surface.metallic *= metal_rough.x;
        s.surface.roughness *= metal_rough.y;
    }
    if (any_has(kBindNormal)) {
        vec3 sampled = textureLod(surface_data, vec3(uv, m.layers.z), max(level, m.least_levels.z)).xyz * 2.0 - 1.0;
        if (m.emissive.w != 0.0) tilt = sampled;
    }
    if (any_has(kBindEmissive))
        s.emitted *= textureLod(surface_colors, vec3(uv, m.layers.w), max(level, m.least_levels.w)).rgb;
    if (any_has(kBindOcclusion)) {
        float open = textureLod(surface_data, vec3(uv, m.occlusion.x), max(level, m.occlusion.y)).r;
        s.occlusion = 1.0 + m.factors.z * (open - 1.0);
    }
    if (any_has(kBindNormal)) {
        s.surface.roughness = toksvig_roughness(s.surface.roughness, tilt);
        tilt.xy *= m.emissive.w;
    }
    return s;
}

vec3 tilted(vec3 normal, uint frame_word, vec3 tilt) {
    vec4 tangent = unpacked_tangent(normal, frame_word);
    vec3 bitangent = cross(normal, tangent.xyz) * tangent.w;
    return normalize(tangent.xyz * tilt.x + bitangent * tilt.y + normal * tilt.z);
}

// Share of the sun that reaches a point: four bilinear looks at the map around it.
float sun_visible(vec3 point, vec3 normal) {
    if (kSunShadow == 0u) return 1.0;
    float texel_m = lighting.sun_irradiance.w;
    float facing = clamp(dot(normal, lighting.sun_direction.xyz), 0.0, 1.0);
    vec3 lifted = point + normal * (texel_m * (0.6 + 2.0 * (1.0 - facing)));
    vec3 p = (lighting.shadow_from_world * vec4(lifted, 1.0)).xyz;
    vec2 texel = 1.0 / vec2(textureSize(shadow_map, 0));
    float sum = textureLod(shadow_map, vec3(p.xy + vec2(-0.75, -0.25) * texel, p.z), 0.0);
    sum += textureLod(shadow_map, vec3(p.xy + vec2(0.25, -0.75) * texel, p.z), 0.0);
    sum += textureLod(shadow_map, vec3(p.xy + vec2(0.75, 0.25) * texel, p.z), 0.0);
    sum += textureLod(shadow_map, vec3(p.xy + vec2(-0.25, 0.75) * texel, p.z), 0.0);
    return 0.25 * sum;
}

// Share of a lamp that reaches a point; all of it outside the lamp's map. The derivatives are given because
// implicit ones would be those of warped space.
float lamp_visible(int layer, vec3 point, vec3 normal, float distance) {
    vec3 lifted = point + normal * (0.012 * distance + 0.01);
    vec4 clip = lighting.lamp_from_world[layer] * vec4(lifted, 1.0);
    vec3 p = clip.xyz / max(clip.w, 1e-4);
    if (clip.w <= 0.0 || max(abs(p.x), abs(p.y)) > 1.0) return 1.0;
    vec2 uv = p.xy * 0.5 + 0.5;
    vec2 texel = 0.6 / vec2(textureSize(lamp_shadows, 0).xy);
    vec4 a = vec4(uv + vec2(-texel.x, 0.4 * texel.y), float(layer), p.z);
    vec4 b = vec4(uv + vec2(0.4 * texel.x, texel.y), float(layer), p.z);
    vec4 c = vec4(uv + vec2(0.6 * texel.x, -texel.y), float(layer), p.z);
    return (textureGrad(lamp_shadows, a, vec2(0.0), vec2(0.0)) + textureGrad(lamp_shadows, b, vec2(0.0), vec2(0.0)) +
            textureGrad(lamp_shadows, c, vec2(0.0), vec2(0.0))) * (1.0 / 3.0);
}

// KHR_lights_punctual: inverse square, a window at the range, a smooth cone.
vec3 light_of(LightRecord lamp, Surface s, vec3 point, vec3 to_eye) {
    vec3 to_lamp = lamp.position.xyz - point;
    float squared = max(dot(to_lamp, to_lamp), 1e-4);
    vec3 direction = to_lamp * inversesqrt(squared);
    float ratio = squared * lamp.position.w;
    float window = clamp(1.0 - ratio * ratio, 0.0, 1.0);
    float cone = clamp(dot(-direction, lamp.direction.xyz) * lamp.cone.x + lamp.direction.w, 0.0, 1.0);
    float share = window * cone * cone / squared;
    if (kLampShadow == 1u && lamp.cone.y >= 0.0) share *= lamp_visible(int(lamp.cone.y), point, s.normal, sqrt(squared));
    return reflected(s, to_eye, direction) * lamp.intensity.rgb * share;
}

// Only the lamps that reach the point's cell of the grid.
vec3 lamp_light(Surface s, vec3 point, vec3 to_eye) {
    if (kLights == 0u) return vec3(0.0);
    ivec2 most = textureSize(light_grid, 0) - 1;
    ivec2 cell = ivec2((point.xz - lighting.light_grid.xy) * lighting.light_grid.zw);
    uvec2 lamps = texelFetch(light_grid, clamp(cell, ivec2(0), most), 0).xy;
    vec3 sum = vec3(0.0);
    // The test stands last: some devices run a loop's body once more than its test would let them.
    do {
        bool low = lamps.x != 0u;
        int i = max(low ? findLSB(lamps.x) : findLSB(lamps.y), 0);
        float counts = lamps.x != 0u || lamps.y != 0u ? 1.0 : 0.0;
        sum += counts * light_of(lighting.lights[low ? i : i + 32], s, point, to_eye);
        if (low)
            lamps.x &= lamps.x - 1u;
        else
            lamps.y &= lamps.y - min(lamps.y, 1u);
    } while ((lamps.x | lamps.y) != 0u);
    return sum;
}

// One colour of the volume at a position in it, layers counted from the colour's first.
vec4 volume_at(vec2 uv, float z, float color) {
    float layers = lighting.volume_scale.w;
    float low = floor(z);
    float first = color * layers;
    vec4 a = textureLod(irradiance_volume, vec3(uv, first + low), 0.0);
    vec4 b = textureLod(irradiance_volume, vec3(uv, first + min(low + 1.0, layers - 1.0)), 0.0);
    return mix(a, b, z - low);
}

// What the surroundings send to a surface point, diffusely and out of the mirrored direction.
vec3 ambient_at(Surface s, vec3 point, vec3 to_eye, float occlusion) {
    vec3 mirror = reflect(-to_eye, s.normal);
    vec3 sky = sky_reflection(mirror, s.roughness);
    if (kIrradiance == 0u) return occlusion * ambient_reflected(s, to_eye, ambient_light(s.normal), sky);

    // Look a little off the surface, so that the far side of a wall counts less.
    float layers = lighting.volume_scale.w;
    vec3 at = (point + s.normal * lighting.volume_origin.w - lighting.volume_origin.xyz) * lighting.volume_scale.xyz;
    float z = clamp(at.z * layers - 0.5, 0.0, layers - 1.0);
    vec4 red = volume_at(at.xy, z, 0.0);
    vec4 green = volume_at(at.xy, z, 1.0);
    vec4 blue = volume_at(at.xy, z, 2.0);
    vec4 facing = vec4(1.0, s.normal.yzx);
    vec3 irradiance = max(vec3(dot(red, facing), dot(green, facing), dot(blue, facing)), 0.0);
    // The same numbers as radiance: the directional part is half as strong again.
    vec4 along = vec4(1.0, 1.5 * mirror.yzx);
    vec3 around = max(vec3(dot(red, along), dot(green, along), dot(blue, along)), 0.02 * irradiance);
    // Smooth surfaces mirror the sky itself, as far as its light gets here.
    vec3 open_sky = max(ambient_light(mirror), vec3(1e-3));
    const vec3 kLuminance = vec3(0.2126, 0.7152, 0.0722);
    float reaches = clamp(dot(around, kLuminance) / dot(open_sky, kLuminance), 0.0, 1.0);
    vec3 mirrored = mix(sky * reaches, around, clamp(0.25 + s.roughness, 0.0, 1.0));
    return occlusion * ambient_reflected(s, to_eye, irradiance, mirrored);
}

vec3 lit(Sample s, vec3 point, vec3 to_eye) {
    vec3 to_sun = lighting.sun_direction.xyz;
    vec3 light = s.emitted;
    if (kSun == 1u)
        light += reflected(s.surface, to_eye, to_sun) * lighting.sun_irradiance.rgb *
                 sun_visible(point, s.surface.normal);
    light += lamp_light(s.surface, point, to_eye);
    return light + ambient_at(s.surface, point, to_eye, s.occlusion);
}

// The G-buffer's last pixel, and the share of its sides that a pixel takes.
struct Screen {
    ivec2 last;
    vec2 pixel;
};

Screen screen_of_camera() {
    vec2 size = vec2(camera.ray_per_px_x.w, camera.ray_per_px_y.w);
    return Screen(ivec2(size) - 1, 1.0 / size);
}

// Sampled, not fetched: lavapipe takes longer over a fetch, whose level of detail it looks up for each sample.
vec2 middle_of(Screen screen, ivec2 at) { return (vec2(at) + 0.5) * screen.pixel; }

float depth_at(Screen screen, ivec2 at) { return textureLod(depth_image, middle_of(screen, at), 0.0).r; }

// Nothing clears the G-buffer: what it holds where there is no surface, at depth 0, is of no interest.
uvec4 gbuffer_words(Screen screen, ivec2 at, float depth) {
    uvec4 words = textureLod(gbuffer, middle_of(screen, at), 0.0);
    return depth > 0.0 ? words : uvec4(0u);
}

vec3 normal_beside(Screen screen, ivec2 at) {
    ivec2 inside = clamp(at, ivec2(0), screen.last);
    return unpacked_normal(gbuffer_words(screen, inside, depth_at(screen, inside)).x);
}

// Highlights narrower than the sample are widened to it: the spread of the normals around becomes roughness
// (Kaplanyan et al. 2016, "Filtering Distributions of Normals for Shading Antialiasing").
float widened_roughness(float roughness, vec3 normal, Screen screen, ivec2 at, float reach_px) {
    int reach = max(int(0.5 * reach_px + 0.5), 1);
    vec3 dx = normal_beside(screen, at + ivec2(reach, 0)) - normal;
    vec3 dy = normal_beside(screen, at + ivec2(0, reach)) - normal;
    float spread = dot(dx, dx) + dot(dy, dy);
    float alpha = roughness * roughness;
    return sqrt(sqrt(clamp(alpha * alpha + min(0.5 * spread, 0.18), 0.0, 1.0)));
}

vec3 shade_sample(vec2 position_px, vec2 spacing_px) {
    Screen screen = screen_of_camera();
    ivec2 at = clamp(ivec2(floor(position_px)), ivec2(0), screen.last);
    float reach_px = kUseFootprint == 1u ? sqrt(spacing_px.x * spacing_px.y) : 1.0;

    // Find the nearest blended surface and where the eye sees through it.
    uvec4 glass_words = uvec4(0u);
    float glass_depth = 0.0;
    vec4 glass = vec4(0.0);
    ivec2 behind_at = at;
    float behind_depth = depth_at(screen, at);
    if (kBlend == 1u) {
        glass_depth = textureLod(blended_depth, middle_of(screen, at), 0.0).r;
        bool in_front = glass_depth > behind_depth;
        uvec4 there = textureLod(blended, middle_of(screen, in_front ? at : ivec2(0)), 0.0);
        if (in_front) {
            glass_words = there;
            glass = bytes_of(glass_words.w);
            if (glass.z > 0.0) {
                // A thin slab bends the eye's ray along its normal.
                vec3 normal = unpacked_normal(glass_words.x);
                vec2 aside = vec2(dot(normal, normalize(camera.ray_per_px_x.xyz)),
                                  dot(normal, normalize(camera.ray_per_px_y.xyz)));
                float bend = 2.0 * glass.w / (1.0 + 2.0 * glass.w);
                float reach = 0.06 * bend * glass_depth / (camera.eye.w * length(camera.ray_per_px_x.xyz));
                ivec2 bent = clamp(at - ivec2(aside * min(reach, 60.0)), ivec2(0), screen.last);
                float bent_depth = depth_at(screen, bent);
                if (bent_depth < glass_depth) {
                    behind_at = bent;
                    behind_depth = bent_depth;
                }
            }
        } else {
            glass_depth = 0.0;
        }
    }

    // Read the textures of what lies behind.
    uvec4 behind_words = gbuffer_words(screen, behind_at, behind_depth);
    Sample behind;
    vec3 tilt = vec3(0.0, 0.0, 1.0);
    if (kLate == 1u) behind = late_sample(behind_words, reach_px, tilt);

    // Light what lies behind, then lay the blended surface over it: what it lets through, then its own light; its mirror
    // light is not thinned. One loop whose test stands last, so that where nothing blends it is left after one turn even on
    // devices that would run both sides of a branch.
    vec3 radiance = vec3(0.0);
    uint layer = 0u;
    bool another = false;
    do {
        bool front = layer == 1u;
        ivec2 here = front ? at : behind_at;
        float depth = front ? glass_depth : behind_depth;
        uvec4 words = front ? glass_words : behind_words;
        vec3 ray = ray_at(vec2(here) + 0.5);
        vec3 point = camera.eye.xyz + ray * (camera.eye.w / max(depth, 1e-7));
        vec3 to_eye = normalize(-ray);
        Sample s = sample_of(words);
        if (kEmission == 1u || front) s.emitted = unpacked_radiance(words.z);
        if (kEmission == 1u && !front) s.occlusion = float(words.w & 0xffu) * (1.0 / 255.0);
        if (kLate == 1u && !front) s = behind;
        vec3 lets_through = vec3(0.0);
        if (front) {
            float covers = glass.y * (1.0 - glass.z);
            lets_through = mix(vec3(1.0), s.surface.base_color, glass.z) * (1.0 - covers);
            s.surface.base_color *= covers;
            if (dot(s.surface.normal, to_eye) < 0.0) s.surface.normal = -s.surface.normal;
        } else {
            s.surface.roughness = widened_roughness(s.surface.roughness, s.surface.normal, screen, here, reach_px);
            if (kLate == 1u && any_has(kBindNormal)) s.surface.normal = tilted(s.surface.normal, words.z, tilt);
        }
        vec3 light = lit(s, point, to_eye);
        if (depth <= 0.0) light = sky_with_sun(normalize(ray));
        radiance = radiance * lets_through + light;
        ++layer;
        another = kBlend == 1u && layer == 1u && glass_depth > 0.0;
    } while (another);
    return tone_mapped(radiance);
}

#endif
