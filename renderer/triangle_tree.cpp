// Halves triangles at the median along the longest side of their box, and leaves out boxes that lie too far
// away.
#include "renderer/triangle_tree.h"

#include <algorithm>
#include <cassert>

namespace parafovea {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;

float squared_distance_to(const Bounds& box, glm::vec3 p) {
    const glm::vec3 off = p - glm::clamp(p, box.low, box.high);
    return glm::dot(off, off);
}

float squared_distance_to(glm::vec3 p, glm::vec3 a, glm::vec3 b) {
    const glm::vec3 along = b - a;
    const float length = glm::dot(along, along);
    const float t = length > 0 ? std::clamp(glm::dot(p - a, along) / length, 0.0f, 1.0f) : 0.0f;
    const glm::vec3 off = p - (a + t * along);
    return glm::dot(off, off);
}

float squared_distance_to(glm::vec3 p, glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const glm::vec3 n = glm::cross(b - a, c - a);
    const float area = glm::dot(n, n);
    // Above the triangle its plane is nearest, elsewhere one of its edges.
    if (area > 0 && glm::dot(glm::cross(b - a, p - a), n) >= 0 &&
        glm::dot(glm::cross(c - b, p - b), n) >= 0 && glm::dot(glm::cross(a - c, p - c), n) >= 0) {
        const float height = glm::dot(p - a, n);
        return height * height / area;
    }
    return std::min(squared_distance_to(p, a, b),
                    std::min(squared_distance_to(p, b, c), squared_distance_to(p, c, a)));
}

}  // namespace

TriangleTree::TriangleTree(std::span<const glm::vec3> places,
                           std::vector<std::array<std::uint32_t, 3>> corners)
    : places_(places), corners_(std::move(corners)) {
    assert(!corners_.empty());
    build(0, static_cast<std::uint32_t>(corners_.size()));
}

glm::vec3 TriangleTree::centre_of(const std::array<std::uint32_t, 3>& t) const {
    return (places_[t[0]] + places_[t[1]] + places_[t[2]]) / 3.0f;
}

void TriangleTree::build(std::uint32_t first, std::uint32_t count) {
    const std::size_t at = nodes_.size();
    nodes_.push_back({{}, first, count, 0});
    Bounds centres;
    for (std::uint32_t i = first; i < first + count; ++i) {
        for (std::uint32_t v : corners_[i]) nodes_[at].bounds.add(places_[v]);
        centres.add(centre_of(corners_[i]));
    }
    if (count <= kLeafTriangles) return;
    const glm::vec3 size = centres.high - centres.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto begin = corners_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count, [&](const auto& a, const auto& b) {
        return std::pair(centre_of(a)[axis], a) < std::pair(centre_of(b)[axis], b);
    });
    nodes_[at].count = 0;
    build(first, count / 2);
    nodes_[at].second_node = static_cast<std::uint32_t>(nodes_.size());
    build(first + count / 2, count - count / 2);
}

float TriangleTree::squared_distance(glm::vec3 p, float enough) const {
    float nearest = 1e30f;
    // Halving a count of 32 bits is over after as many steps.
    std::array<std::uint32_t, 64> waiting{};
    std::size_t waiting_count = 1;
    while (waiting_count > 0 && nearest > enough) {
        const std::uint32_t at = waiting[--waiting_count];
        const Node& node = nodes_[at];
        if (squared_distance_to(node.bounds, p) >= nearest) continue;
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
            const auto& t = corners_[i];
            nearest = std::min(nearest, squared_distance_to(p, places_[t[0]], places_[t[1]], places_[t[2]]));
        }
        if (node.count > 0) continue;
        const bool first_is_nearer = squared_distance_to(nodes_[at + 1].bounds, p) <
                                     squared_distance_to(nodes_[node.second_node].bounds, p);
        waiting[waiting_count++] = first_is_nearer ? node.second_node : at + 1;
        waiting[waiting_count++] = first_is_nearer ? at + 1 : node.second_node;
    }
    return nearest;
}

}  // namespace parafovea
