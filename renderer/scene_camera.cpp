// Builds the camera block: reversed infinite depth, y down on the picture.
#include "renderer/scene_camera.h"

#include <cassert>
#include <cmath>
#include <cstring>

namespace parafovea {
namespace {

shared::vec4 packed(glm::vec3 v, float w) {
    return {v.x, v.y, v.z, w};
}

CameraView symmetric(const SceneCamera& camera, float tan_x, float tan_y) {
    CameraView view;
    view.world_from_eye = camera.world_from_camera;
    view.tan_left = view.tan_right = tan_x;
    view.tan_up = view.tan_down = tan_y;
    view.near_m = camera.near_m;
    return view;
}

}  // namespace

CameraView view_through(const SceneCamera& camera, SizePx size) {
    assert(size.width > 0 && size.height > 0);
    const float tan_y = std::tan(camera.vertical_fov_rad / 2);
    return symmetric(camera, tan_y * static_cast<float>(size.width) / static_cast<float>(size.height), tan_y);
}

CameraView view_through(const SceneCamera& camera, const ViewGeometry& geometry) {
    assert(geometry.size.width > 0 && geometry.size.height > 0);
    const auto tan_x = static_cast<float>(std::tan(rad_from_deg(geometry.horizontal_fov_deg) / 2));
    return symmetric(
        camera, tan_x,
        tan_x * static_cast<float>(geometry.size.height) / static_cast<float>(geometry.size.width));
}

glm::mat4 clip_from_world(const CameraView& view, SizePx size) {
    const float width = view.tan_left + view.tan_right, height = view.tan_up + view.tan_down;
    // A sample shifted by the jitter sees what lies at its position plus the jitter.
    const float shift_x = static_cast<float>(view.jitter_px.x) * 2 / static_cast<float>(size.width);
    const float shift_y = static_cast<float>(view.jitter_px.y) * 2 / static_cast<float>(size.height);
    glm::mat4 clip_from_eye{0};
    clip_from_eye[0][0] = 2 / width;
    clip_from_eye[2][0] = (view.tan_right - view.tan_left) / width + shift_x;
    clip_from_eye[1][1] = -2 / height;
    clip_from_eye[2][1] = (view.tan_down - view.tan_up) / height + shift_y;
    clip_from_eye[2][3] = -1;
    clip_from_eye[3][2] = view.near_m;
    return clip_from_eye * glm::inverse(view.world_from_eye);
}

shared::Camera camera_block(const CameraView& view, SizePx size) {
    const glm::mat3 rotation{view.world_from_eye};
    const float per_px_x = (view.tan_left + view.tan_right) / static_cast<float>(size.width);
    const float per_px_y = (view.tan_up + view.tan_down) / static_cast<float>(size.height);
    const float x0 = -view.tan_left + static_cast<float>(view.jitter_px.x) * per_px_x;
    const float y0 = view.tan_up - static_cast<float>(view.jitter_px.y) * per_px_y;
    shared::Camera block{};
    const glm::mat4 matrix = clip_from_world(view, size);
    std::memcpy(block.clip_from_world.columns, &matrix, sizeof matrix);
    block.eye = packed(glm::vec3(view.world_from_eye[3]), view.near_m);
    block.ray_origin = packed(rotation * glm::vec3(x0, y0, -1), 0);
    block.ray_per_px_x = packed(rotation * glm::vec3(per_px_x, 0, 0), static_cast<float>(size.width));
    block.ray_per_px_y = packed(rotation * glm::vec3(0, -per_px_y, 0), static_cast<float>(size.height));
    return block;
}

}  // namespace parafovea
