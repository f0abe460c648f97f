// The distance from a point to the nearest of many triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/scene.h"

namespace parafovea {

class TriangleTree {
  public:
    // `corners` are indices into `places`, which must outlive the tree; there must be a triangle.
    TriangleTree(std::span<const glm::vec3> places, std::vector<std::array<std::uint32_t, 3>> corners);

    // The squared distance; where it is at most `enough`, anything between it and `enough`.
    float squared_distance(glm::vec3 p, float enough) const;

  private:
    struct Node {
        Bounds bounds;
        std::uint32_t first = 0;
        std::uint32_t count = 0;        // of triangles, 0 where there are children: the next node and
        std::uint32_t second_node = 0;  // this one
    };
    void build(std::uint32_t first, std::uint32_t count);
    glm::vec3 centre_of(const std::array<std::uint32_t, 3>& triangle) const;

    std::span<const glm::vec3> places_;
    std::vector<std::array<std::uint32_t, 3>> corners_;
    std::vector<Node> nodes_;
};

}  // namespace parafovea
