// The view, or the two eyes' views, that `parafovea render` draws.
#pragma once

#include <string>
#include <vector>

#include "app/eye_pictures.h"

namespace parafovea {

struct TwoEyes {
    double ipd_m = 0.063;
    double gaze_distance_m = 2;
    // Degrees from the left eye's straight ahead to the left, right, top and bottom of its picture; the right
    // eye's picture is its mirror image. All zero: the camera's own frustum for both.
    double left_deg = 0, right_deg = 0, up_deg = 0, down_deg = 0;
};

// "54,46,50,48" into the four angles, each above 0 and below 85; throws CLI::ValidationError otherwise.
void parse_eye_fov(const std::string& text, TwoEyes& eyes);

// Two eyes beside a camera, each with a picture of this size.
Eyes eyes_beside(const SceneCamera& camera, SizePx size, const TwoEyes& wanted);

// What one picture shows.
struct RenderedView {
    CameraView view;
    RenderMethod method;
    PointPx gaze;
};

// For a camera: one view, or, with `two`, the left and the right eye's. The gaze is a point on the one
// picture, or on the one that stands between the eyes (Eyes::view()), at their gaze distance.
std::vector<RenderedView> rendered_views(const SceneCamera& camera, SizePx size, const RenderMethod& method,
                                         PointPx gaze, const TwoEyes* two);

// Pictures of one height beside each other.
Image side_by_side(const std::vector<Image>& pictures);

}  // namespace parafovea
