// Ambient light as it varies over a scene: sky light that finds its way in, and sunlight and lamplight that
// surfaces pass on.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/scene.h"

namespace parafovea {

// A box of probes. Each holds, for red, green and blue, four numbers (a, b, c, d) of irradiance / pi as a
// function of the normal: a + b n.y + c n.z + d n.x (spherical harmonics of degree 1, constants folded in).
struct IrradianceVolume {
    Bounds box;  // the outer faces of the outermost probes' cells
    glm::ivec3 size{0};
    std::vector<glm::vec4> texels;  // [colour][z][y][x]

    const glm::vec4& at(int color, int x, int y, int z) const {
        return texels[static_cast<std::size_t>(((color * size.z + z) * size.y + y) * size.x + x)];
    }
};

// Traces light through a coarse model of the scene, with three bounces. Deterministic; well under a second of
// one core for a million triangles.
IrradianceVolume bake_irradiance(const Scene& scene);

}  // namespace parafovea
