// Sixteen solids as signed distances, metres; the field of the ray-marched scene. The formulas are the published ones
// (Hart 1996, "Sphere tracing"; Quilez, "Distance functions"); pyramid, cone, octahedron and triangular prism use the
// bound by their planes, which is cheaper and still never oversteps.
#ifndef PRIMITIVES_FIELD_GLSL
#define PRIMITIVES_FIELD_GLSL

float length_of(vec2 v) { return sqrt(dot(v, v)); }

float box_distance(vec3 p, vec3 half_size) {
    vec3 q = abs(p) - half_size;
    return length(max(q, 0.0)) + min(max(q.x, max(q.y, q.z)), 0.0);
}

float round_section_distance(vec3 p, float radius, float half_height) {
    vec2 q = vec2(length_of(p.xz) - radius, abs(p.y) - half_height);
    return min(max(q.x, q.y), 0.0) + length_of(max(q, 0.0));
}

// Where each solid stands. Front row, middle row, back row.
const vec3 kSphereAt = vec3(-3.9, 0.75, 2.7);
const vec3 kTorusAt = vec3(-1.95, 0.62, 3.1);
const vec3 kRoundedBoxAt = vec3(0.0, 0.55, 2.5);
const vec3 kCapsuleAt = vec3(2.0, 0.62, 3.1);
const vec3 kOctahedronAt = vec3(3.9, 0.92, 2.7);
const vec3 kBoxAt = vec3(-5.3, 0.7, 0.2);
const vec3 kCylinderAt = vec3(-3.1, 0.9, -0.1);
const vec3 kConeAt = vec3(-1.05, 0.0, 0.1);
const vec3 kHexagonAt = vec3(1.15, 0.72, 0.0);
const vec3 kLinkAt = vec3(3.2, 1.02, -0.1);
const vec3 kEllipsoidAt = vec3(5.3, 0.62, 0.2);
const vec3 kFrameAt = vec3(-5.2, 0.92, -3.1);
const vec3 kPyramidAt = vec3(-2.5, 0.0, -3.2);
const vec3 kPrismAt = vec3(0.1, 0.62, -2.9);
const vec3 kRoundConeAt = vec3(2.6, 0.72, -3.1);
const vec3 kArcAt = vec3(5.2, 0.02, -3.0);

float sphere_at(vec3 p) { return length(p - kSphereAt) - 0.75; }

float torus_at(vec3 p) {
    p -= kTorusAt;
    // Leans back so that the hole is seen.
    p.yz = vec2(0.5 * p.y + 0.8660254 * p.z, -0.8660254 * p.y + 0.5 * p.z);
    return length_of(vec2(length_of(p.xz) - 0.5, p.y)) - 0.19;
}

float rounded_box_at(vec3 p) {
    p -= kRoundedBoxAt;
    p.xz = vec2(0.8 * p.x + 0.6 * p.z, -0.6 * p.x + 0.8 * p.z);
    return box_distance(p, vec3(0.52, 0.41, 0.52)) - 0.14;
}

float capsule_at(vec3 p) {
    p -= kCapsuleAt;
    const vec3 kEnd = vec3(0.42, 0.3, 0.18);
    vec3 from_start = p + kEnd;
    float along = clamp(dot(from_start, kEnd) * (0.5 / dot(kEnd, kEnd)), 0.0, 1.0);
    return length(from_start - 2.0 * along * kEnd) - 0.3;
}

float octahedron_at(vec3 p) {
    p = abs(p - kOctahedronAt);
    return (p.x + p.y + p.z - 0.9) * 0.57735027;
}

float box_at(vec3 p) {
    p -= kBoxAt;
    p.xz = vec2(0.8660254 * p.x - 0.5 * p.z, 0.5 * p.x + 0.8660254 * p.z);
    return box_distance(p, vec3(0.62, 0.7, 0.62));
}

float cylinder_at(vec3 p) { return round_section_distance(p - kCylinderAt, 0.55, 0.9); }

float cone_at(vec3 p) {
    p -= kConeAt;
    // Slope of 0.78 m over 1.9 m.
    return max(dot(vec2(0.92507, 0.37977), vec2(length_of(p.xz), p.y - 1.9)), -p.y);
}

float hexagon_at(vec3 p) {
    p = abs(p - kHexagonAt);
    const vec2 kSide = vec2(-0.8660254, 0.5);
    p.xz -= 2.0 * min(dot(kSide, p.xz), 0.0) * kSide;
    vec2 q = vec2(length_of(p.xz - vec2(clamp(p.x, -0.3579, 0.3579), 0.62)) * sign(p.z - 0.62), p.y - 0.72);
    return min(max(q.x, q.y), 0.0) + length_of(max(q, 0.0));
}

float link_at(vec3 p) {
    p -= kLinkAt;
    p.xz = vec2(0.8 * p.x - 0.6 * p.z, 0.6 * p.x + 0.8 * p.z);
    p.y = max(abs(p.y) - 0.42, 0.0);
    return length_of(vec2(length_of(p.xy) - 0.44, p.z)) - 0.16;
}

float ellipsoid_at(vec3 p) {
    p -= kEllipsoidAt;
    const vec3 kRadius = vec3(0.95, 0.62, 0.6);
    float k0 = length(p / kRadius);
    float k1 = length(p / (kRadius * kRadius));
    return k0 * (k0 - 1.0) / max(k1, 1e-4);
}

float frame_at(vec3 p) {
    p -= kFrameAt;
    p.xz = vec2(0.8 * p.x + 0.6 * p.z, -0.6 * p.x + 0.8 * p.z);
    p = abs(p) - vec3(0.92);
    vec3 q = abs(p + 0.1) - 0.1;
    // The nearest of the three bars that run along x, y and z.
    vec3 along = max(p, 0.0);
    vec3 across = max(q, 0.0);
    float x2 = along.x * along.x + across.y * across.y + across.z * across.z;
    float y2 = across.x * across.x + along.y * along.y + across.z * across.z;
    float z2 = across.x * across.x + across.y * across.y + along.z * along.z;
    float inside = min(min(max(p.x, max(q.y, q.z)), max(q.x, max(p.y, q.z))), max(q.x, max(q.y, p.z)));
    return sqrt(min(x2, min(y2, z2))) + min(inside, 0.0);
}

float pyramid_at(vec3 p) {
    p -= kPyramidAt;
    // A base of 1.9 m and a height of 1.9 m.
    float side = max(abs(p.x), abs(p.z));
    return max(dot(vec2(0.894427, 0.447214), vec2(side, p.y - 1.9)), -p.y);
}

float prism_at(vec3 p) {
    p -= kPrismAt;
    p.xz = vec2(0.8660254 * p.x + 0.5 * p.z, -0.5 * p.x + 0.8660254 * p.z);
    return max(abs(p.z) - 0.8, max(abs(p.x) * 0.8660254 + p.y * 0.5, -p.y) - 0.62);
}

float round_cone_at(vec3 p) {
    p -= kRoundConeAt;
    // Radius 0.72 m below, 0.26 m above, 1.25 m between the centres.
    const float kLean = 0.368;
    const float kUpright = 0.92982794;
    vec2 q = vec2(length_of(p.xz), p.y);
    float along = dot(q, vec2(-kLean, kUpright));
    float slope = dot(q, vec2(kUpright, kLean)) - 0.72;
    float low = length_of(q) - 0.72;
    float high = length_of(q - vec2(0.0, 1.25)) - 0.26;
    return along < 0.0 ? low : (along > kUpright * 1.25 ? high : slope);
}

float arc_at(vec3 p) {
    p -= kArcAt;
    p.xz = vec2(0.8660254 * p.x - 0.5 * p.z, 0.5 * p.x + 0.8660254 * p.z);
    // A ring of radius 0.95 m, open below: 115 degrees to either side of the top.
    const vec2 kOpening = vec2(0.9063078, -0.4226183);
    p.x = abs(p.x);
    p.y -= 0.55;
    float reach = kOpening.y * p.x > kOpening.x * p.y ? dot(p.xy, kOpening) : length_of(p.xy);
    return sqrt(max(dot(p, p) + 0.9025 - 1.9 * reach, 0.0)) - 0.17;
}

// The rows in which the solids stand. A ray is followed row by row: each asks only its own solids, and only where the ray
// passes them. `row` is a constant wherever these are called.
const int kFrontRow = 0;
const int kMiddleRow = 1;
const int kBackRow = 2;

float row_field(int row, vec3 p) {
    if (row == kFrontRow)
        return min(min(min(sphere_at(p), torus_at(p)), min(rounded_box_at(p), capsule_at(p))), octahedron_at(p));
    if (row == kMiddleRow)
        return min(min(min(box_at(p), cylinder_at(p)), min(cone_at(p), hexagon_at(p))),
                   min(link_at(p), ellipsoid_at(p)));
    return min(min(min(frame_at(p), pyramid_at(p)), min(prism_at(p), round_cone_at(p))), arc_at(p));
}

// Distance to the nearest solid.
float field(vec3 p) {
    return min(row_field(kFrontRow, p), min(row_field(kMiddleRow, p), row_field(kBackRow, p)));
}

struct Solid {
    float distance;
    vec3 base_color;
    vec2 metallic_roughness;
    float pattern;  // 0 plain, 1 checks, 2 stripes, 3 veins
};

void take_nearer(inout Solid nearest, float distance, vec3 base_color, vec2 metallic_roughness, float pattern) {
    if (distance < nearest.distance) nearest = Solid(distance, base_color, metallic_roughness, pattern);
}

// The nearest solid of a row and what it is made of.
Solid solid_at(int row, vec3 p) {
    Solid s = Solid(1e9, vec3(0.5), vec2(0.0, 0.5), 0.0);
    if (row == kFrontRow) {
        take_nearer(s, sphere_at(p), vec3(0.95, 0.93, 0.90), vec2(1.0, 0.12), 0.0);
        take_nearer(s, torus_at(p), vec3(1.00, 0.71, 0.29), vec2(1.0, 0.25), 0.0);
        take_nearer(s, rounded_box_at(p), vec3(0.75, 0.09, 0.07), vec2(0.0, 0.25), 1.0);
        take_nearer(s, capsule_at(p), vec3(0.08, 0.35, 0.62), vec2(0.0, 0.15), 2.0);
        take_nearer(s, octahedron_at(p), vec3(0.10, 0.55, 0.35), vec2(0.0, 0.12), 3.0);
    } else if (row == kMiddleRow) {
        take_nearer(s, box_at(p), vec3(0.55, 0.33, 0.16), vec2(0.0, 0.55), 2.0);
        take_nearer(s, cylinder_at(p), vec3(0.85, 0.83, 0.78), vec2(0.0, 0.3), 3.0);
        take_nearer(s, cone_at(p), vec3(0.90, 0.45, 0.08), vec2(0.0, 0.35), 2.0);
        take_nearer(s, hexagon_at(p), vec3(0.30, 0.18, 0.52), vec2(0.0, 0.2), 1.0);
        take_nearer(s, link_at(p), vec3(0.56, 0.57, 0.58), vec2(1.0, 0.32), 0.0);
        take_nearer(s, ellipsoid_at(p), vec3(0.72, 0.72, 0.15), vec2(0.0, 0.22), 1.0);
    } else {
        take_nearer(s, frame_at(p), vec3(0.95, 0.64, 0.54), vec2(1.0, 0.3), 0.0);
        take_nearer(s, pyramid_at(p), vec3(0.72, 0.56, 0.36), vec2(0.0, 0.7), 2.0);
        take_nearer(s, prism_at(p), vec3(0.10, 0.48, 0.55), vec2(0.0, 0.2), 1.0);
        take_nearer(s, round_cone_at(p), vec3(0.82, 0.80, 0.76), vec2(0.0, 0.25), 3.0);
        take_nearer(s, arc_at(p), vec3(0.62, 0.10, 0.28), vec2(0.0, 0.2), 2.0);
    }
    return s;
}

void span_sphere(vec3 from, vec3 direction, vec3 centre, float radius, float reach, inout vec2 span) {
    vec3 m = from - centre;
    radius += reach * (radius + length(m));
    float b = dot(m, direction);
    float h = b * b - dot(m, m) + radius * radius;
    float s = sqrt(max(h, 0.0));
    bool met = h > 0.0 && s > b;
    span.x = met ? min(span.x, max(-b - s, 0.0)) : span.x;
    span.y = met ? max(span.y, s - b) : span.y;
}

// The stretch of a ray in which solids of a row, swollen by `margin`, may be met: (first, last); first > last when none.
// It holds for all rays whose unit vectors lie within `reach` of `direction`.
vec2 row_span(int row, vec3 from, vec3 direction, float margin, float reach) {
    vec2 span = vec2(1e9, -1.0);
    if (row == kFrontRow) {
        span_sphere(from, direction, kSphereAt, 0.76 + margin, reach, span);
        span_sphere(from, direction, kTorusAt, 0.70 + margin, reach, span);
        span_sphere(from, direction, kRoundedBoxAt, 0.99 + margin, reach, span);
        span_sphere(from, direction, kCapsuleAt, 0.86 + margin, reach, span);
        span_sphere(from, direction, kOctahedronAt, 0.91 + margin, reach, span);
    } else if (row == kMiddleRow) {
        span_sphere(from, direction, kBoxAt, 1.13 + margin, reach, span);
        span_sphere(from, direction, kCylinderAt, 1.06 + margin, reach, span);
        span_sphere(from, direction, kConeAt + vec3(0.0, 0.79, 0.0), 1.12 + margin, reach, span);
        span_sphere(from, direction, kHexagonAt, 1.03 + margin, reach, span);
        span_sphere(from, direction, kLinkAt, 1.03 + margin, reach, span);
        span_sphere(from, direction, kEllipsoidAt, 0.96 + margin, reach, span);
    } else {
        span_sphere(from, direction, kFrameAt, 1.60 + margin, reach, span);
        span_sphere(from, direction, kPyramidAt + vec3(0.0, 0.48, 0.0), 1.43 + margin, reach, span);
        span_sphere(from, direction, kPrismAt, 1.49 + margin, reach, span);
        span_sphere(from, direction, kRoundConeAt + vec3(0.0, 0.4, 0.0), 1.14 + margin, reach, span);
        span_sphere(from, direction, kArcAt + vec3(0.0, 0.55, 0.0), 1.13 + margin, reach, span);
    }
    return span;
}

// Where the rays of a bundle may meet the solids of a row. They march as one ("cone marching") to `at`, along the middle
// ray; around the point there no solid is nearer than `free`. All have passed the row at `last`.
struct BundleSpan {
    float at;
    float free;
    float last;
};

// `reach` as row_span() takes it. A single ray, of no reach, has nothing to share.
BundleSpan bundle_span(int row, vec3 from, vec3 direction, float reach) {
    vec2 span = row_span(row, from, direction, 0.0, reach);
    BundleSpan bundle = BundleSpan(span.x, 0.0, span.y);
    if (reach == 0.0) return bundle;
    bool worth_it = true;
    for (int turn = 0; turn < 24 && worth_it && span.x < span.y; ++turn) {
        bundle.at = span.x;
        bundle.free = row_field(row, from + span.x * direction);
        float width = reach * span.x;
        span.x += max(bundle.free - width, 0.0);
        // Where the free sphere is hardly wider than the bundle, its rays go on alone.
        worth_it = bundle.free > 1.25 * width;
    }
    return bundle;
}

// The stretch in which a ray of the bundle may meet solids; `apart`: between its unit vector and the middle one.
vec2 ray_span(BundleSpan bundle, float apart) {
    return vec2(bundle.at + max(bundle.free - apart * bundle.at, 0.0), bundle.last);
}

#endif
