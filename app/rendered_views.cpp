// Places eyes beside a scene's camera.
#include "app/rendered_views.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

namespace parafovea {

void parse_eye_fov(const std::string& text, TwoEyes& eyes) {
    char more = 0;
    const int found = std::sscanf(text.c_str(), "%lf,%lf,%lf,%lf%c", &eyes.left_deg, &eyes.right_deg,
                                  &eyes.up_deg, &eyes.down_deg, &more);
    const auto in_range = [](double deg) { return deg > 0 && deg < 85; };
    if (found != 4 || !in_range(eyes.left_deg) || !in_range(eyes.right_deg) || !in_range(eyes.up_deg) ||
        !in_range(eyes.down_deg)) {
        throw CLI::ValidationError("--eye-fov",
                                   "expected LEFT,RIGHT,UP,DOWN of the left eye in degrees, each above 0 and "
                                   "below 85, such as 54,46,50,48; found '" +
                                       text + "'");
    }
}

Eyes eyes_beside(const SceneCamera& camera, SizePx size, const TwoEyes& wanted) {
    const CameraView own = view_through(camera, size);
    Eyes eyes;
    eyes.gaze_distance_m = wanted.gaze_distance_m;
    for (const int side : {-1, 1}) {
        XrView view{XR_TYPE_VIEW, nullptr, {{0, 0, 0, 1}, {0, 0, 0}}, {}};
        view.pose.position.x = static_cast<float>(side * wanted.ipd_m / 2);
        if (wanted.left_deg > 0) {
            const double outer = rad_from_deg(wanted.left_deg), inner = rad_from_deg(wanted.right_deg);
            view.fov.angleLeft = static_cast<float>(side < 0 ? -outer : -inner);
            view.fov.angleRight = static_cast<float>(side < 0 ? inner : outer);
            view.fov.angleUp = static_cast<float>(rad_from_deg(wanted.up_deg));
            view.fov.angleDown = static_cast<float>(-rad_from_deg(wanted.down_deg));
        } else {
            view.fov = {-std::atan(own.tan_left), std::atan(own.tan_right), std::atan(own.tan_up),
                        -std::atan(own.tan_down)};
        }
        eyes.views.push_back(view);
        eyes.sizes.push_back(size);
    }
    return eyes;
}

std::vector<RenderedView> rendered_views(const SceneCamera& camera, SizePx size, const RenderMethod& method,
                                         PointPx gaze, const TwoEyes* two) {
    if (two == nullptr) return {{view_through(camera, size), method, gaze}};
    const Eyes eyes = eyes_beside(camera, size, *two);
    std::vector<RenderedView> views;
    for (std::size_t eye = 0; eye < eyes.views.size(); ++eye) {
        views.push_back({view_of_eye(eyes.views[eye], camera), method_of_eye(eyes, eye, method),
                         eyes.seen_at(eye, gaze)});
    }
    return views;
}

Image side_by_side(const std::vector<Image>& pictures) {
    Image all;
    all.size.height = pictures.front().size.height;
    for (const Image& picture : pictures) {
        assert(picture.size.height == all.size.height);
        all.size.width += picture.size.width;
    }
    for (int y = 0; y < all.size.height; ++y) {
        for (const Image& picture : pictures) {
            const auto row = picture.rgba.begin() + static_cast<std::ptrdiff_t>(y) * picture.size.width * 4;
            all.rgba.insert(all.rgba.end(), row, row + static_cast<std::ptrdiff_t>(picture.size.width) * 4);
        }
    }
    return all;
}

}  // namespace parafovea
