// How much work a sample is worth at a distance from the gaze: Swafford et al. 2016, methods 2 and 4.
#ifndef PARAFOVEA_EFFORT_H
#define PARAFOVEA_EFFORT_H

#include "bridge.h"

SHARED_BEGIN

// Uniform block; std140.
struct EffortFalloff {
    vec2 gaze;    // pixels
    float slope;  // how fast it falls, 1 / pixel, ...
    float start;  // ... from this distance on, pixels
    float least;  // in (0, 1]
    float pad_0;
    float pad_1;
    float pad_2;
};

// In [least, 1]: one over the spacing that samples would have if they were spaced as acuity falls.
SHARED_FUNCTION float effort_at(EffortFalloff falloff, float distance_px) {
    return max(falloff.least, 1.0f / (1.0f + falloff.slope * max(distance_px - falloff.start, 0.0f)));
}

SHARED_END

#ifdef __cplusplus
static_assert(sizeof(parafovea::shared::EffortFalloff) == 32);
#endif

#endif
