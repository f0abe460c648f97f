// Where the eye looks and where the camera is in each frame that a sweep measures.
#pragma once

#include <vector>

#include "app/tradeoff_plan.h"
#include "renderer/scene.h"
#include "renderer/scene_camera.h"

namespace parafovea {

// One frame: the eye's true place, and the one the frame is drawn for (older by the plan's age of gaze).
struct TradeoffFrame {
    CameraView view;
    PointPx gaze;
    PointPx drawn_gaze;
};

// The frames of a group: one if nothing moves, else as many as the plan says, at the display's rate.
//
// A gaze path begins two frames before a saccade of at least 5 degrees: the first one of the recording, or of
// the simulated eye, which looks at a new place within the middle of the picture every third of a second. A
// camera path begins at a quarter of the scene's own; a scene without one is looked at from its first camera,
// which turns by 20 degrees a second.
//
// Throws std::runtime_error with one line where the recording cannot be read or holds no such saccade.
std::vector<TradeoffFrame> frames_of(const TradeoffPlan& plan, const TradeoffGroup& group,
                                     const Scene& scene);

}  // namespace parafovea
