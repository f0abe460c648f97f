// A scene's lights and sky as the block that shaders read.
#pragma once

#include "renderer/scene.h"
#include "renderer/shared/scene_layout.h"

namespace parafovea {

// Everything but the shadow matrix and the irradiance volume, which their makers fill in. At most kMaxLights
// lights.
shared::Lighting lighting_block(const Scene& scene);

// Which lights reach each cell of a grid over the scene, seen from above.
struct LightGrid {
    glm::vec2 low{0};  // x and z of its corner
    glm::vec2 cell_m{1};
    glm::ivec2 size{1};
    std::vector<std::uint64_t> lights;  // bit i: light i; rows along x
};
LightGrid make_light_grid(const Scene& scene);

// Radiance of the sky without the sun; the same formula as sky_radiance() in lighting.glsl.
glm::vec3 sky_radiance(const Sky& sky, glm::vec3 direction);

}  // namespace parafovea
