// A scene as coarse cells that light can be traced through on the CPU.
#pragma once

#include <vector>

#include "renderer/scene.h"

namespace parafovea {

// What fills a cell: the mean of the surfaces in it.
struct VoxelSurface {
    glm::vec3 albedo{0};
    glm::vec3 emission{0};
    glm::vec3 normal{0};  // shorter than 1 where surfaces face different ways
};

class SceneVoxels {
  public:
    // Opaque surfaces only; `cells_along` cells on the scene's longest side.
    SceneVoxels(const Scene& scene, int cells_along);

    struct Hit {
        int surface = -1;  // -1: the ray left the scene
        float distance_m = 0;
    };
    // The first filled cell along a ray, the one it starts in not counted. `direction` has unit length.
    Hit trace(glm::vec3 from, glm::vec3 direction) const;

    bool filled(glm::vec3 p) const;
    const VoxelSurface& surface(int index) const { return surfaces_[static_cast<std::size_t>(index)]; }
    const Bounds& bounds() const { return bounds_; }
    float cell_m() const { return cell_m_; }

  private:
    void add_triangle(const glm::vec3 corners[3], const VoxelSurface& material);
    int* cell_at(glm::ivec3 c);

    Bounds bounds_;
    float cell_m_ = 1;
    glm::ivec3 size_{1};
    std::vector<int> cells_;  // index of the surface, -1: empty
    std::vector<VoxelSurface> surfaces_;
    std::vector<float> weights_;
};

}  // namespace parafovea
