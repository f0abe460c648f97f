// Directions as unit vectors, for means, velocities and devices that speak them.
#pragma once

#include <cmath>

#include "devices/geometry.h"

namespace parafovea {

// x right, y up, z forward.
struct Vector3 {
    double x = 0;
    double y = 0;
    double z = 0;
};

constexpr Vector3 operator+(Vector3 a, Vector3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}

inline double length(Vector3 v) {
    return std::hypot(v.x, v.y, v.z);
}

inline Vector3 unit_vector(DirectionDeg d) {
    const double azimuth = rad_from_deg(d.azimuth_deg), elevation = rad_from_deg(d.elevation_deg);
    return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
            std::cos(elevation) * std::cos(azimuth)};
}

// The vector need not have length 1; straight ahead for the null vector.
inline DirectionDeg direction_of(Vector3 v) {
    return {deg_from_rad(std::atan2(v.x, v.z)), deg_from_rad(std::atan2(v.y, std::hypot(v.x, v.z)))};
}

// The direction half way between two: that of the mean of their unit vectors.
inline DirectionDeg mean_direction(DirectionDeg a, DirectionDeg b) {
    return direction_of(unit_vector(a) + unit_vector(b));
}

}  // namespace parafovea
