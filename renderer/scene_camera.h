// How an eye looks at a scene: where it is, its frustum, and the camera block that shaders read.
#pragma once

#include <glm/glm.hpp>

#include "devices/geometry.h"
#include "renderer/scene.h"
#include "renderer/shared/camera.h"

namespace parafovea {

// One eye's view. The frustum is given by the tangents of its half angles, all positive in a symmetric one;
// looks along its own -z, y up.
struct CameraView {
    glm::mat4 world_from_eye{1};
    float tan_left = 1;
    float tan_right = 1;
    float tan_up = 1;
    float tan_down = 1;
    float near_m = 0.05f;
    PointPx jitter_px;  // shifts every sample on the picture; for anti-aliasing over time
};

// A scene's camera with its own vertical field of view and square pixels.
CameraView view_through(const SceneCamera& camera, SizePx size);

// The same place and direction, with the field of view of a display.
CameraView view_through(const SceneCamera& camera, const ViewGeometry& geometry);

shared::Camera camera_block(const CameraView& view, SizePx size);

// The matrix that camera_block() puts into the block.
glm::mat4 clip_from_world(const CameraView& view, SizePx size);

}  // namespace parafovea
