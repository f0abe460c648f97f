// One eye's picture in a headset: a frustum that need not be symmetric, beside the middle of the head, and
// perhaps turned.
#pragma once

#include <span>

#include "devices/geometry.h"
#include "devices/openxr/openxr_api.h"
#include "devices/unit_vector.h"

namespace parafovea {

// Where a point is seen on an eye's picture, in pixels, anywhere; straight behind the eye it is not a number.
// The point is in metres in the frame of the view's pose, as devices/unit_vector.h has it: x right, y up,
// z forward.
PointPx picture_point(const XrView& view, SizePx size, Vector3 point_m);

// The point where an eye's line of sight through a picture position crosses the plane z = distance_m. Not a
// number where it never does.
Vector3 point_on_plane(const XrView& view, SizePx size, PointPx picture_px, double distance_m);

// The one symmetric picture, seen from between the eyes, that stands for them all: of the first view's size
// and number of pixels per degree.
ViewGeometry picture_between(std::span<const XrView> views, SizePx size);

}  // namespace parafovea
