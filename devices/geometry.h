// Positions on a picture, directions from the eye, and the view that connects the two.
#pragma once

#include <cmath>
#include <numbers>

namespace parafovea {

struct SizePx {
    int width = 0;
    int height = 0;

    bool operator==(const SizePx&) const = default;
};

// A position on a picture in pixels: the top left corner is (0, 0), pixel (i, j) has its centre at
// (i + 0.5, j + 0.5), y points down.
struct PointPx {
    double x = 0;
    double y = 0;

    bool operator==(const PointPx&) const = default;
};

constexpr PointPx centre_of(SizePx size) {
    return {size.width * 0.5, size.height * 0.5};
}

// A direction from the eye in Fick angles: azimuth positive to the right, elevation positive up, both zero
// straight ahead.
struct DirectionDeg {
    double azimuth_deg = 0;
    double elevation_deg = 0;

    bool operator==(const DirectionDeg&) const = default;
};

constexpr double rad_from_deg(double deg) {
    return deg * std::numbers::pi / 180;
}
constexpr double deg_from_rad(double rad) {
    return rad * 180 / std::numbers::pi;
}

// A flat, square-pixelled picture seen through a symmetric frustum by one eye.
struct ViewGeometry {
    SizePx size;
    double horizontal_fov_deg = 90;

    // Distance from the eye to the picture plane, in pixels.
    double distance_px() const { return 0.5 * size.width / std::tan(rad_from_deg(horizontal_fov_deg) / 2); }

    // Pixels per degree at the centre of the picture.
    double pixels_per_degree() const { return distance_px() * std::tan(rad_from_deg(1)); }

    PointPx point_from_direction(DirectionDeg d) const {
        const double azimuth = rad_from_deg(d.azimuth_deg), elevation = rad_from_deg(d.elevation_deg);
        const PointPx centre = centre_of(size);
        return {centre.x + distance_px() * std::tan(azimuth),
                centre.y - distance_px() * std::tan(elevation) / std::cos(azimuth)};
    }

    DirectionDeg direction_from_point(PointPx p) const {
        const PointPx centre = centre_of(size);
        const double x = p.x - centre.x, y = centre.y - p.y, z = distance_px();
        return {deg_from_rad(std::atan2(x, z)), deg_from_rad(std::atan2(y, std::hypot(x, z)))};
    }
};

// The angle between two directions, in degrees.
inline double angle_between_deg(DirectionDeg a, DirectionDeg b) {
    const double aa = rad_from_deg(a.azimuth_deg), ae = rad_from_deg(a.elevation_deg);
    const double ba = rad_from_deg(b.azimuth_deg), be = rad_from_deg(b.elevation_deg);
    const double ax = std::cos(ae) * std::sin(aa), ay = std::sin(ae), az = std::cos(ae) * std::cos(aa);
    const double bx = std::cos(be) * std::sin(ba), by = std::sin(be), bz = std::cos(be) * std::cos(ba);
    const double cx = ay * bz - az * by, cy = az * bx - ax * bz, cz = ax * by - ay * bx;
    return deg_from_rad(std::atan2(std::sqrt(cx * cx + cy * cy + cz * cz), ax * bx + ay * by + az * bz));
}

}  // namespace parafovea
