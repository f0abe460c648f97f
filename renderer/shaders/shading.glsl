// The scene's colour at a screen position: one function, shared by full resolution and every foveated method.
// Include with SCENE_MESHES or SCENE_PRIMITIVES defined. Declares descriptor set 0 (see scene_layout.h).
//
//   vec3 shade_sample(vec2 position_px, vec2 spacing_px)
//
// position_px: where on the screen, in pixels from the top left. spacing_px: the distance from this sample to its
// neighbours, radial and tangential, at full resolution (1, 1). Result: display-linear, tone-mapped, in [0, 1].
// Uses no implicit derivatives: it is called in warped space.
#ifndef SHADING_GLSL
#define SHADING_GLSL

#include "../shared/camera.h"
#include "../shared/scene_layout.h"

layout(set = 0, binding = kBindCamera, std140) uniform CameraBlock { Camera camera; };
layout(set = 0, binding = kBindLighting, std140) uniform LightingBlock { Lighting lighting; };

#include "lighting.glsl"

// Through a point of the picture, 1 long along the view axis.
vec3 ray_at(vec2 position_px) {
    return camera.ray_origin.xyz + position_px.x * camera.ray_per_px_x.xyz + position_px.y * camera.ray_per_px_y.xyz;
}

#if defined(SCENE_MESHES)
#include "shading_meshes.glsl"
#elif defined(SCENE_PRIMITIVES)
#include "shading_primitives.glsl"
#else
#error "define SCENE_MESHES or SCENE_PRIMITIVES"
#endif

#endif
