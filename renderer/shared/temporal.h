// What anti-aliasing over time needs to know of a frame.
#ifndef PARAFOVEA_TEMPORAL_H
#define PARAFOVEA_TEMPORAL_H

#include "bridge.h"
#include "camera.h"

SHARED_BEGIN

// Uniform block; std140.
struct Temporal {
    Camera camera;                  // this frame's, without jitter
    mat4 previous_clip_from_world;  // the last frame's, without jitter
    float least_weight;             // a frame counts at least this much
    float clip;                     // history may be this many standard deviations off its surroundings
    uint fresh;                     // 1: there is no history
    uint still;                     // 1: the view is the last frame's
};

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(parafovea::shared::Temporal) == 208);
#endif

#endif
