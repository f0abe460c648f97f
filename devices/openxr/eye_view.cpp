// Projects onto one eye's picture.
#include "devices/openxr/eye_view.h"

#include <cmath>
#include <limits>

namespace parafovea {

namespace {

struct Tangents {
    double left, right, up, down;  // all positive in a symmetric frustum

    explicit Tangents(const XrFovf& fov)
        : left(-std::tan(fov.angleLeft)),
          right(std::tan(fov.angleRight)),
          up(std::tan(fov.angleUp)),
          down(-std::tan(fov.angleDown)) {}
};

// By a quaternion, in OpenXR's frame: x right, y up, -z forward.
Vector3 turned(const XrQuaternionf& q, Vector3 v) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    return {(1 - 2 * (y * y + z * z)) * v.x + 2 * (x * y - w * z) * v.y + 2 * (x * z + w * y) * v.z,
            2 * (x * y + w * z) * v.x + (1 - 2 * (x * x + z * z)) * v.y + 2 * (y * z - w * x) * v.z,
            2 * (x * z - w * y) * v.x + 2 * (y * z + w * x) * v.y + (1 - 2 * (x * x + y * y)) * v.z};
}

}  // namespace

PointPx picture_point(const XrView& view, SizePx size, Vector3 point_m) {
    const XrVector3f& eye = view.pose.position;
    const XrQuaternionf& q = view.pose.orientation;
    const Vector3 seen =
        turned({-q.x, -q.y, -q.z, q.w}, {point_m.x - eye.x, point_m.y - eye.y, -point_m.z - eye.z});
    if (!(seen.z < 0))
        return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    const Tangents edge(view.fov);
    return {(seen.x / -seen.z + edge.left) / (edge.left + edge.right) * size.width,
            (edge.up - seen.y / -seen.z) / (edge.up + edge.down) * size.height};
}

Vector3 point_on_plane(const XrView& view, SizePx size, PointPx picture_px, double distance_m) {
    const Tangents edge(view.fov);
    const Vector3 ray =
        turned(view.pose.orientation, {picture_px.x / size.width * (edge.left + edge.right) - edge.left,
                                       edge.up - picture_px.y / size.height * (edge.up + edge.down), -1});
    const XrVector3f& eye = view.pose.position;
    const double along = (-distance_m - eye.z) / ray.z;
    const double never = std::numeric_limits<double>::quiet_NaN();
    if (!(along > 0)) return {never, never, never};
    return {eye.x + along * ray.x, eye.y + along * ray.y, distance_m};
}

ViewGeometry picture_between(std::span<const XrView> views, SizePx size) {
    const Tangents edge(views.front().fov);
    return {size, 2 * deg_from_rad(std::atan((edge.left + edge.right) / 2))};
}

}  // namespace parafovea
