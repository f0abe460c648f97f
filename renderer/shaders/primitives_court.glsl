// The court around the sixteen solids: a tiled floor and three brick walls, met in closed form, and their patterns,
// box-filtered over the sample's footprint (Ebert et al. 2003, "Texturing and Modeling", chapter 2).
#ifndef PRIMITIVES_COURT_GLSL
#define PRIMITIVES_COURT_GLSL

const float kWallHeight = 6.4;
const float kSideWall = 7.2;   // the walls stand at x = -7.2 and 7.2
const float kBackWall = -5.6;  // and at z = -5.6

float hash(vec2 cell) {
    vec3 q = fract(vec3(cell.xyx) * 0.1031);
    q += dot(q, q.yzx + 33.33);
    return fract((q.x + q.y) * q.z);
}

float value_noise(vec2 p) {
    vec2 cell = floor(p);
    vec2 t = p - cell;
    t = t * t * (3.0 - 2.0 * t);
    return mix(mix(hash(cell), hash(cell + vec2(1.0, 0.0)), t.x),
               mix(hash(cell + vec2(0.0, 1.0)), hash(cell + vec2(1.0, 1.0)), t.x), t.y);
}

// Share of the interval of length `width` around x in which frac(x) > gap: the filtered comb of bricks between joints.
float between_joints(float x, float width, float gap) {
    float low = x - 0.5 * width;
    float high = x + 0.5 * width;
    float area_low = floor(low) * (1.0 - gap) + max(fract(low) - gap, 0.0);
    float area_high = floor(high) * (1.0 - gap) + max(fract(high) - gap, 0.0);
    return clamp((area_high - area_low) / width, 0.0, 1.0);
}

// Filtered +1 / -1 square wave of period 2.
float checks(float x, float width) {
    float low = x - 0.5 * width;
    float high = x + 0.5 * width;
    float area_low = abs(fract(low * 0.5) - 0.5);
    float area_high = abs(fract(high * 0.5) - 0.5);
    return clamp(2.0 * (area_low - area_high) / width, -1.0, 1.0);
}

// What the court is made of at a point of it. `footprint`: metres that the sample covers along u and v.
struct Masonry {
    vec3 base_color;
    float roughness;
    vec2 tilt;  // slope of the surface along u and v
};

// Full below `fine`, gone when the footprint reaches half a feature.
float kept(float footprint, float feature) { return clamp(1.5 - 2.0 * footprint / feature, 0.0, 1.0); }

Masonry brickwork(vec2 uv, vec2 footprint) {
    const vec2 kBrick = vec2(0.42, 0.14);
    vec2 p = uv / kBrick;
    vec2 width = max(footprint / kBrick, vec2(1e-3));
    float row = floor(p.y);
    p.x += 0.5 * mod(row, 2.0) * step(width.y, 2.0);
    vec2 gap = vec2(0.03, 0.09);
    float brick = between_joints(p.x, width.x, gap.x) * between_joints(p.y, width.y, gap.y);
    float detail = kept(max(width.x, width.y), 1.0);
    float tone = mix(0.5, hash(vec2(floor(p.x), row)), detail);
    float grain = mix(0.5, value_noise(uv * 26.0), kept(max(footprint.x, footprint.y), 0.04));
    float large = value_noise(uv * 0.7);
    vec3 clay = mix(vec3(0.36, 0.13, 0.075), vec3(0.55, 0.27, 0.15), tone);
    clay = mix(clay, vec3(0.50, 0.36, 0.26), step(0.86, tone) * detail * 0.8);
    clay *= 0.75 + 0.5 * grain;
    clay *= 0.8 + 0.4 * large;
    vec3 mortar = vec3(0.50, 0.47, 0.42) * (0.8 + 0.4 * grain);
    // Every brick is set a little askew.
    vec2 tilt = detail * 0.10 * (vec2(hash(vec2(floor(p.x) + 17.0, row)), tone) - 0.5);
    return Masonry(mix(mortar, clay, brick), mix(0.92, 0.75, brick), tilt);
}

// A band of small glazed tiles that runs around the walls.
Masonry mosaic(vec2 uv, vec2 footprint) {
    const float kTile = 0.15;
    vec2 p = uv / kTile;
    vec2 width = max(footprint / kTile, vec2(1e-3));
    float tile = between_joints(p.x, width.x, 0.08) * between_joints(p.y, width.y, 0.08);
    float detail = kept(max(width.x, width.y), 1.0);
    vec2 cell = floor(p);
    // A diamond figure of eight by eight tiles.
    vec2 figure = abs(mod(cell + vec2(0.0, 4.0), 8.0) - 3.5);
    float ring = mod(floor(figure.x + figure.y), 4.0);
    vec3 glaze = ring < 1.0 ? vec3(0.75, 0.70, 0.58)
                            : (ring < 2.0 ? vec3(0.05, 0.16, 0.42)
                                          : (ring < 3.0 ? vec3(0.62, 0.30, 0.06) : vec3(0.05, 0.33, 0.31)));
    glaze = mix(vec3(0.36, 0.35, 0.32), glaze * (0.75 + 0.5 * hash(cell)), detail);
    vec2 tilt = detail * 0.08 * (vec2(hash(cell + 5.0), hash(cell + 9.0)) - 0.5);
    return Masonry(mix(vec3(0.55, 0.53, 0.5), glaze, tile), mix(0.8, 0.2, tile), tilt);
}

Masonry wall(vec2 uv, vec2 footprint) {
    float v = uv.y;
    bool band = (v > 2.4 && v < 3.6) || (v > 5.2 && v < 5.8);
    if (band) return mosaic(uv, footprint);
    return brickwork(uv, footprint);
}

Masonry paving(vec2 uv, vec2 footprint) {
    const float kSlab = 0.6;
    vec2 p = uv / kSlab;
    vec2 width = max(footprint / kSlab, vec2(1e-3));
    float slab = between_joints(p.x, width.x, 0.025) * between_joints(p.y, width.y, 0.025);
    float check = 0.5 + 0.5 * checks(p.x, width.x) * checks(p.y, width.y);
    float detail = kept(max(width.x, width.y), 1.0);
    vec2 cell = floor(p);
    float tone = mix(0.5, hash(cell), detail);
    // Veins: a warped band of noise, each slab with its own.
    vec2 q = uv * 3.1 + 7.0 * tone;
    float warp = value_noise(q) + 0.5 * value_noise(q * 2.1);
    float vein = abs(value_noise(q * 1.7 + warp) - 0.5);
    float veins = mix(0.35, clamp(1.0 - 9.0 * vein, 0.0, 1.0), kept(max(footprint.x, footprint.y), 0.12));
    // Every fourth slab carries an inlay of small squares.
    vec2 small = uv / 0.1;
    vec2 small_width = max(footprint / 0.1, vec2(1e-3));
    float inlay = 0.5 + 0.5 * checks(small.x, small_width.x) * checks(small.y, small_width.y);
    float inlaid = step(0.75, tone) * detail;
    vec3 light = mix(vec3(0.66, 0.61, 0.53), vec3(0.42, 0.35, 0.29), veins);
    vec3 dark = mix(vec3(0.13, 0.15, 0.16), vec3(0.45, 0.44, 0.42), veins * 0.6);
    vec3 color = mix(dark, light, check) * (0.8 + 0.4 * tone);
    color = mix(color, mix(vec3(0.35, 0.08, 0.06), vec3(0.7, 0.62, 0.45), inlay), inlaid * 0.85);
    vec2 tilt = detail * 0.012 * (vec2(hash(cell + 3.0), tone) - 0.5);
    return Masonry(mix(vec3(0.3, 0.28, 0.26), color, slab), mix(0.85, 0.3, slab), tilt);
}

struct CourtHit {
    float distance;  // negative: the sky
    vec3 normal;
    vec3 along_u;
    vec3 along_v;
};

// The nearest wall or floor along a ray from inside the court.
CourtHit meet_court(vec3 from, vec3 direction) {
    CourtHit hit = CourtHit(-1.0, vec3(0.0, 1.0, 0.0), vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0));
    float floor_at = direction.y < -1e-5 ? -from.y / direction.y : 1e9;
    float side = direction.x > 0.0 ? 1.0 : -1.0;
    float side_at = abs(direction.x) > 1e-5 ? (side * kSideWall - from.x) / direction.x : 1e9;
    float back_at = direction.z < -1e-5 ? (kBackWall - from.z) / direction.z : 1e9;
    float wall_at = min(side_at, back_at);
    bool wall_met = wall_at < floor_at && wall_at < 200.0 && from.y + wall_at * direction.y < kWallHeight;
    bool floor_met = floor_at <= wall_at && floor_at < 200.0;
    if (floor_met) {
        hit.distance = floor_at;
    } else if (wall_met) {
        hit.distance = wall_at;
        hit.along_v = vec3(0.0, 1.0, 0.0);
        if (side_at < back_at) {
            hit.normal = vec3(-side, 0.0, 0.0);
            hit.along_u = vec3(0.0, 0.0, 1.0);
        } else {
            hit.normal = vec3(0.0, 0.0, 1.0);
        }
    }
    return hit;
}

// `footprint_m`: diameter of the sample's cone where it meets the court.
Masonry masonry_at(CourtHit hit, vec3 point, vec3 direction, float footprint_m) {
    vec2 uv = vec2(dot(point, hit.along_u), dot(point, hit.along_v));
    // The cone's section with the plane is longer along the ray's own direction.
    float slant = max(abs(dot(hit.normal, direction)), 0.05);
    vec2 run = abs(vec2(dot(direction, hit.along_u), dot(direction, hit.along_v)));
    vec2 footprint = footprint_m * (1.0 + run * run * (1.0 / slant - 1.0) / max(1.0 - slant * slant, 1e-3));
    if (hit.normal.y > 0.5) return paving(uv, footprint);
    return wall(uv, footprint);
}

// Share of the sun that the walls let through to a point of the court; the wall on the sun's side is the one that counts.
float sun_over_walls(vec3 point, vec3 to_sun) {
    float side = to_sun.x > 0.0 ? kSideWall : -kSideWall;
    float side_at = (side - point.x) / to_sun.x;
    float side_height = point.y + side_at * to_sun.y;
    float side_lit = smoothstep(-0.012, 0.012, (side_height - kWallHeight) / max(side_at, 1e-3));
    float back_at = to_sun.z < 0.0 ? (kBackWall - point.z) / to_sun.z : 1e9;
    float back_lit = to_sun.z < 0.0 ? smoothstep(-0.012, 0.012, (point.y + back_at * to_sun.y - kWallHeight) / max(back_at, 1e-3)) : 1.0;
    return side_lit * back_lit;
}

#endif
