// The camera block: how a screen position becomes a ray, and back.
#ifndef PARAFOVEA_CAMERA_H
#define PARAFOVEA_CAMERA_H

#include "bridge.h"

SHARED_BEGIN

// Uniform block; std140. Screen positions in pixels from the top left corner. Depth is reversed and infinite:
// depth = near / distance along the view axis, 0 is the sky.
// World position at p with depth d: eye + (ray_origin + p.x ray_per_px_x + p.y ray_per_px_y) near / d.
struct Camera {
    mat4 clip_from_world;
    vec4 eye;           // world position; w: near distance, metres
    vec4 ray_origin;    // direction through (0, 0), 1 long along the view axis
    vec4 ray_per_px_x;  // its change per pixel to the right; w: pixels of width
    vec4 ray_per_px_y;  // and per pixel down; w: pixels of height
};

SHARED_END

#endif
