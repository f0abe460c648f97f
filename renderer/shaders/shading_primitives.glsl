// shade_sample() of the ray-marched scene: sphere tracing through the solids, the court in closed form, soft shadows,
// ambient occlusion, one mirrored look at the court.
#ifndef SHADING_PRIMITIVES_GLSL
#define SHADING_PRIMITIVES_GLSL

#include "primitives_field.glsl"
#include "primitives_court.glsl"

layout(constant_id = kConstFootprint) const uint kUseFootprint = 1u;
layout(constant_id = kConstSamples) const uint kSamples = 1u;

// What share of its loops shade_sample() may spend: on occlusion, on steps along rays. A method that spends less on
// some samples sets them before.
float occlusion_effort = 1.0;
float step_effort = 1.0;

// Where the rays of a sample may meet the solids of each row.
struct RowSpans {
    vec3 middle_ray;  // unit
    BundleSpan front;
    BundleSpan middle;
    BundleSpan back;
};

RowSpans row_spans(vec3 from, vec3 direction, float reach) {
    return RowSpans(direction, bundle_span(kFrontRow, from, direction, reach),
                    bundle_span(kMiddleRow, from, direction, reach), bundle_span(kBackRow, from, direction, reach));
}

// Sphere tracing (Hart 1996) through a row, to within a cone of the surface; `last` when nothing is met before it.
float trace_row(int row, vec3 from, vec3 direction, vec2 span, float last, float cone) {
    span.y = min(span.y, last);
    float t = span.x;
    float found = last;
    for (int i = 0; i < int(ceil(60.0 * step_effort)) && found == last && t < span.y; ++i) {
        float d = row_field(row, from + t * direction);
        found = d < cone * t ? t : last;
        // As far behind the surface as what counts as on it lies before.
        t += d + cone * t;
    }
    return found;
}

struct SolidHit {
    float distance;  // `last` when nothing is nearer
    int row;
};

// The nearest solid along one of the rays that the spans are of.
SolidHit trace_solids(RowSpans spans, vec3 from, vec3 direction, float last, float cone) {
    // With fewer steps a ray is let off a little farther from the solid.
    cone /= step_effort;
    float apart = distance(direction, spans.middle_ray);
    float front = trace_row(kFrontRow, from, direction, ray_span(spans.front, apart), last, cone);
    float middle = trace_row(kMiddleRow, from, direction, ray_span(spans.middle, apart), front, cone);
    float back = trace_row(kBackRow, from, direction, ray_span(spans.back, apart), middle, cone);
    return SolidHit(back, back < middle ? kBackRow : middle < front ? kMiddleRow : kFrontRow);
}

// The nearest miss of a ray to the sun past the solids of a row, as a share of the sun's radius.
float nearest_miss(int row, vec3 from, vec3 to_sun) {
    const float kSunTangent = 0.035;
    vec2 span = row_span(row, from, to_sun, 0.1, 0.0);
    float share = 1.0;
    // Nearer, a ray only crawls out of the solid that it leaves.
    float t = max(span.x, 0.06);
    float least_m = 0.015 / step_effort;
    for (int i = 0; i < int(ceil(24.0 * step_effort)) && share > -1.0 && t < span.y; ++i) {
        float d = row_field(row, from + t * to_sun);
        share = min(share, d / (kSunTangent * t));
        // May go up to 10 cm through a solid: what so short a way grazes lies too shallow to hide much of the sun.
        t += max(d + clamp(d, 0.0, 0.1), least_m);
    }
    return share;
}

// Share of a sun of finite size that is seen past the solids (the nearest miss, seen as an angle).
float sun_past_solids(vec3 from, vec3 to_sun) {
    float share = min(nearest_miss(kFrontRow, from, to_sun),
                      min(nearest_miss(kMiddleRow, from, to_sun), nearest_miss(kBackRow, from, to_sun)));
    share = clamp(share, -1.0, 1.0);
    return 0.25 * (1.0 + share) * (1.0 + share) * (2.0 - share);
}

float court_distance(vec3 p) {
    return min(p.y, min(kSideWall - abs(p.x), p.z - kBackWall));
}

// Share of the hemisphere that is open (after Evans 2006): distances to the nearest surface at four heights.
float openness(vec3 point, vec3 normal) {
    float blocked = 0.0;
    // All four heights, every other one, or the highest alone.
    int stride = occlusion_effort > 0.7 ? 1 : occlusion_effort > 0.35 ? 2 : 4;
    float weight = stride == 1 ? 1.0 : stride == 2 ? 2.0 * 0.6 : 4.0 * 0.216;
    for (int i = stride; i <= 4; i += stride) {
        float height = 0.06 * float(i * i);
        vec3 p = point + height * normal;
        float d = min(field(p), court_distance(p));
        blocked += weight * max(height - d, 0.0);
        weight *= stride == 1 ? 0.6 : 0.36;
    }
    return clamp(1.0 - 1.1 * blocked, 0.0, 1.0);
}

vec3 row_normal(int row, vec3 p, float step_m) {
    const vec2 k = vec2(1.0, -1.0);
    return normalize(k.xyy * row_field(row, p + k.xyy * step_m) + k.yyx * row_field(row, p + k.yyx * step_m) +
                     k.yxy * row_field(row, p + k.yxy * step_m) + k.xxx * row_field(row, p + k.xxx * step_m));
}

vec3 patterned(Solid solid, vec3 p, float footprint_m) {
    vec3 color = solid.base_color;
    if (solid.pattern > 2.5) {
        float warp = value_noise(p.xz * 4.0 + p.y) + value_noise(p.xy * 4.3 - p.z);
        float vein = abs(value_noise(vec2(p.x + p.z, p.y) * 5.0 + warp * 1.5) - 0.5);
        float veins = mix(0.2, clamp(1.0 - 8.0 * vein, 0.0, 1.0), kept(footprint_m, 0.1));
        return color * (1.0 - 0.75 * veins);
    }
    if (solid.pattern > 1.5) {
        float width = max(footprint_m / 0.11, 1e-3);
        return color * (1.0 + 0.45 * checks((p.y + 0.25 * p.x) / 0.11, width));
    }
    if (solid.pattern > 0.5) {
        float width = max(footprint_m / 0.16, 1e-3);
        vec3 q = p / 0.16 + 0.21;
        float sign_product = checks(q.x, width) * checks(q.y, width) * checks(q.z, width);
        return mix(color, color * 0.15 + 0.75, 0.5 + 0.5 * sign_product);
    }
    return color;
}

vec3 lit_court(CourtHit hit, vec3 point, vec3 direction, float footprint_m, float sun, float open) {
    Masonry m = masonry_at(hit, point, direction, footprint_m);
    Surface s;
    s.normal = normalize(hit.normal + m.tilt.x * hit.along_u + m.tilt.y * hit.along_v);
    s.base_color = m.base_color;
    s.metallic = 0.0;
    s.roughness = m.roughness;
    vec3 to_eye = -direction;
    vec3 mirrored = sky_reflection(reflect(direction, s.normal), m.roughness) * open;
    return ambient_reflected(s, to_eye, ambient_light(s.normal) * open, mirrored) +
           reflected(s, to_eye, lighting.sun_direction.xyz) * lighting.sun_irradiance.rgb * sun;
}

// How far down a wall or out on the floor the sky is hidden by the court itself.
float court_openness(vec3 point) {
    float depth = clamp(point.y / kWallHeight, 0.0, 1.0);
    float corner = clamp(0.35 * min(kSideWall - abs(point.x), point.z - kBackWall) + 0.25, 0.0, 1.0);
    return mix(0.45, 1.0, depth) * mix(0.8, 1.0, corner);
}

const float kSky = 1e9;

// Along one of the rays that the spans are of.
vec3 radiance_along(RowSpans spans, vec3 from, vec3 direction, float cone) {
    CourtHit court = meet_court(from, direction);
    float court_at_m = court.distance > 0.0 ? court.distance : kSky;
    SolidHit hit = trace_solids(spans, from, direction, court_at_m, max(0.35 * cone, 2e-4));
    float distance = hit.distance;
    bool on_solid = distance < court_at_m;
    if (distance == kSky) return sky_with_sun(direction);

    vec3 point = from + distance * direction;
    float footprint_m = cone * distance;
    vec3 normal = court.normal;
    Solid solid;
    if (on_solid) {
        float step_m = max(5e-4, 0.25 * footprint_m);
        // Each branch knows its row.
        if (hit.row == kFrontRow) {
            normal = row_normal(kFrontRow, point, step_m);
            solid = solid_at(kFrontRow, point);
        } else if (hit.row == kMiddleRow) {
            normal = row_normal(kMiddleRow, point, step_m);
            solid = solid_at(kMiddleRow, point);
        } else {
            normal = row_normal(kBackRow, point, step_m);
            solid = solid_at(kBackRow, point);
        }
    }
    vec3 to_sun = lighting.sun_direction.xyz;
    vec3 lifted = point + normal * 0.006;
    float sun = dot(normal, to_sun) > 0.0 ? sun_over_walls(lifted, to_sun) * sun_past_solids(lifted, to_sun) : 0.0;
    float open = openness(point, normal) * court_openness(point);

    // The court is lit once: where it is seen, or where it stands in the solid's mirror, unshadowed by the solids.
    vec3 look = direction;
    vec3 court_point = point;
    float court_footprint_m = footprint_m;
    float court_sun = sun;
    float court_open = open;
    if (on_solid) {
        look = reflect(direction, normal);
        court = meet_court(lifted, look);
        court_point = lifted + court.distance * look;
        float roughness = solid.metallic_roughness.y;
        court_footprint_m += (cone + 0.9 * roughness * roughness) * court.distance;
        court_sun = sun_over_walls(court_point, to_sun);
        court_open = court_openness(court_point);
    }
    vec3 beyond = court.distance > 0.0
                      ? lit_court(court, court_point, look, court_footprint_m, court_sun, court_open)
                      : sky_with_sun(look);
    if (!on_solid) return beyond;

    Surface s;
    s.normal = normal;
    s.base_color = patterned(solid, point, footprint_m);
    s.metallic = solid.metallic_roughness.x;
    s.roughness = solid.metallic_roughness.y;
    vec3 to_eye = -direction;
    // The court also sends light up and across: the floor's share of the hemisphere.
    vec3 ambient = ambient_light(normal) * open;
    return ambient_reflected(s, to_eye, ambient, beyond * mix(1.0, open, 0.7)) +
           reflected(s, to_eye, to_sun) * lighting.sun_irradiance.rgb * sun;
}

vec3 shade_sample(vec2 position_px, vec2 spacing_px) {
    float spread = kUseFootprint == 1u ? clamp(sqrt(spacing_px.x * spacing_px.y), 1.0, 64.0) : 1.0;
    float px_x = length(camera.ray_per_px_x.xyz);
    float px_y = length(camera.ray_per_px_y.xyz);
    vec3 middle = ray_at(position_px);
    // The offsets below are up to 0.63 long, those of more than 40 samples up to 0.71.
    float reach = kSamples == 1u ? 0.0 : (kSamples <= 40u ? 0.64 : 0.72) * spread * max(px_x, px_y) / length(middle);
    RowSpans spans = row_spans(camera.eye.xyz, normalize(middle), reach);
    vec3 sum = vec3(0.0);
    for (uint i = 0u; i < kSamples; ++i) {
        // Points of the R2 sequence around the position; one sample stands in the middle.
        vec2 offset = kSamples == 1u ? vec2(0.0) : fract(vec2(0.7548776662, 0.5698402910) * float(i) + 0.5) - 0.5;
        vec3 direction = ray_at(position_px + offset * spread);
        float stretch = length(direction);
        // The angle that the sample spans shrinks away from the picture's centre.
        float cone = spread * px_x / (stretch * sqrt(stretch));
        sum += tone_mapped(radiance_along(spans, camera.eye.xyz, direction / stretch, cone));
    }
    return sum / float(kSamples);
}

#endif
