// Arithmetic of poses as OpenXR has them: right-handed, x right, y up, -z forward.
#pragma once

#include <openxr/openxr.h>

#include <cmath>

#include "devices/geometry.h"

namespace parafovea::headset {

inline constexpr XrPosef kIdentityPose{{0, 0, 0, 1}, {0, 0, 0}};

inline XrQuaternionf multiply(const XrQuaternionf& a, const XrQuaternionf& b) {
    return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
            a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

inline XrVector3f rotate(const XrQuaternionf& q, const XrVector3f& v) {
    const XrQuaternionf r = multiply(multiply(q, {v.x, v.y, v.z, 0}), {-q.x, -q.y, -q.z, q.w});
    return {r.x, r.y, r.z};
}

// a_from_c = a_from_b b_from_c.
inline XrPosef compose(const XrPosef& a_from_b, const XrPosef& b_from_c) {
    const XrVector3f moved = rotate(a_from_b.orientation, b_from_c.position);
    return {multiply(a_from_b.orientation, b_from_c.orientation),
            {a_from_b.position.x + moved.x, a_from_b.position.y + moved.y, a_from_b.position.z + moved.z}};
}

inline XrPosef inverse(const XrPosef& pose) {
    const XrQuaternionf& q = pose.orientation;
    const XrQuaternionf back{-q.x, -q.y, -q.z, q.w};
    const XrVector3f p = rotate(back, pose.position);
    return {back, {-p.x, -p.y, -p.z}};
}

// Turns -z into the direction: first up about x, then right about y.
inline XrQuaternionf orientation_towards(DirectionDeg direction) {
    const double yaw = -rad_from_deg(direction.azimuth_deg) / 2;
    const double pitch = rad_from_deg(direction.elevation_deg) / 2;
    return multiply({0, static_cast<float>(std::sin(yaw)), 0, static_cast<float>(std::cos(yaw))},
                    {static_cast<float>(std::sin(pitch)), 0, 0, static_cast<float>(std::cos(pitch))});
}

inline bool is_unit(const XrQuaternionf& q) {
    const float square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return std::abs(square - 1) < 0.02f;
}

}  // namespace parafovea::headset
