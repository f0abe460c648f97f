// Fills cells with the triangles that pass through them and walks rays from cell to cell.
#include "renderer/scene_voxels.h"

#include <algorithm>
#include <cmath>

namespace parafovea {
namespace {

float linear_of(std::uint8_t byte) {
    const float s = static_cast<float>(byte) / 255;
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

// Mean colour of an image, from a few hundred of its texels.
glm::vec3 mean_color(const SceneImage& image, bool srgb) {
    const std::size_t texels = image.rgba.size() / 4, stride = std::max<std::size_t>(1, texels / 509);
    glm::vec3 sum{0};
    float count = 0;
    for (std::size_t i = 0; i < texels; i += stride, ++count)
        for (int c = 0; c < 3; ++c) {
            const std::uint8_t byte = image.rgba[4 * i + static_cast<std::size_t>(c)];
            sum[c] += srgb ? linear_of(byte) : static_cast<float>(byte) / 255;
        }
    return count > 0 ? sum / count : glm::vec3(1);
}

glm::vec3 mean_of(const Scene& scene, const TextureSlot& slot) {
    if (!slot) return glm::vec3(1);
    const SceneTexture& texture = scene.textures[static_cast<std::size_t>(slot.texture)];
    return mean_color(scene.images[static_cast<std::size_t>(texture.image)], texture.srgb);
}

}  // namespace

SceneVoxels::SceneVoxels(const Scene& scene, int cells_along) : bounds_(world_bounds(scene)) {
    const glm::vec3 extent = bounds_.high - bounds_.low;
    cell_m_ =
        std::max(std::max(extent.x, std::max(extent.y, extent.z)) / static_cast<float>(cells_along), 1e-4f);
    bounds_.low -= glm::vec3(0.5f * cell_m_);
    bounds_.high += glm::vec3(0.5f * cell_m_);
    size_ = glm::ivec3(glm::ceil((bounds_.high - bounds_.low) / cell_m_));
    cells_.assign(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                      static_cast<std::size_t>(size_.z),
                  -1);

    std::vector<VoxelSurface> means;
    for (const Material& m : scene.materials) {
        VoxelSurface mean;
        // Metals reflect as much, only in one direction.
        mean.albedo = glm::vec3(m.base_color) * mean_of(scene, m.base_color_texture);
        mean.emission =
            m.emissive == glm::vec3(0) ? glm::vec3(0) : m.emissive * mean_of(scene, m.emissive_texture);
        means.push_back(mean);
    }
    for (const SceneInstance& instance : scene.instances) {
        const SceneMesh& mesh = scene.meshes[static_cast<std::size_t>(instance.mesh)];
        const Material& material = scene.materials[static_cast<std::size_t>(mesh.material)];
        if (material.alpha_mode == AlphaMode::blend || material.transmission > 0) continue;
        for (std::uint32_t i = 0; i < mesh.index_count; i += 3) {
            glm::vec3 corners[3], shading_normal{0};
            for (std::uint32_t k = 0; k < 3; ++k) {
                const SceneVertex& v =
                    scene.vertices[mesh.first_vertex + scene.indices[mesh.first_index + i + k]];
                corners[k] = glm::vec3(instance.world_from_mesh * glm::vec4(v.position, 1));
                shading_normal += v.normal;
            }
            VoxelSurface surface = means[static_cast<std::size_t>(mesh.material)];
            surface.normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
            if (glm::dot(surface.normal, glm::mat3(instance.world_from_mesh) * shading_normal) < 0)
                surface.normal = -surface.normal;
            add_triangle(corners, surface);
        }
    }
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
        surfaces_[i].albedo /= weights_[i];
        surfaces_[i].emission /= weights_[i];
        surfaces_[i].normal /= weights_[i];
    }
}

int* SceneVoxels::cell_at(glm::ivec3 c) {
    if (c.x < 0 || c.y < 0 || c.z < 0 || c.x >= size_.x || c.y >= size_.y || c.z >= size_.z) return nullptr;
    return &cells_[(static_cast<std::size_t>(c.z) * static_cast<std::size_t>(size_.y) +
                    static_cast<std::size_t>(c.y)) *
                       static_cast<std::size_t>(size_.x) +
                   static_cast<std::size_t>(c.x)];
}

void SceneVoxels::add_triangle(const glm::vec3 corners[3], const VoxelSurface& material) {
    const float area = 0.5f * glm::length(material.normal);
    if (!(area > 0)) return;
    const glm::vec3 normal = glm::normalize(material.normal);
    const float longest =
        std::max(glm::distance(corners[0], corners[1]),
                 std::max(glm::distance(corners[1], corners[2]), glm::distance(corners[2], corners[0])));
    // Points on a barycentric lattice finer than the cells, each standing for its share of the area.
    const int steps = std::clamp(static_cast<int>(std::ceil(longest / (0.7f * cell_m_))), 1, 2000);
    const float weight = area / (0.5f * static_cast<float>(steps) * static_cast<float>(steps + 1));
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; i + j < steps; ++j) {
            const float u = (static_cast<float>(i) + 1.0f / 3) / static_cast<float>(steps);
            const float v = (static_cast<float>(j) + 1.0f / 3) / static_cast<float>(steps);
            const glm::vec3 p = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
            int* cell = cell_at(glm::ivec3(glm::floor((p - bounds_.low) / cell_m_)));
            if (!cell) continue;
            if (*cell < 0) {
                *cell = static_cast<int>(surfaces_.size());
                surfaces_.push_back({});
                weights_.push_back(0);
            }
            const auto index = static_cast<std::size_t>(*cell);
            surfaces_[index].albedo += weight * material.albedo;
            surfaces_[index].emission += weight * material.emission;
            surfaces_[index].normal += weight * normal;
            weights_[index] += weight;
        }
    }
}

bool SceneVoxels::filled(glm::vec3 p) const {
    const int* cell =
        const_cast<SceneVoxels*>(this)->cell_at(glm::ivec3(glm::floor((p - bounds_.low) / cell_m_)));
    return cell && *cell >= 0;
}

// Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing".
SceneVoxels::Hit SceneVoxels::trace(glm::vec3 from, glm::vec3 direction) const {
    const glm::vec3 start = (from - bounds_.low) / cell_m_;
    glm::ivec3 c{glm::floor(start)};
    glm::ivec3 step;
    glm::vec3 next, per_cell;
    for (int axis = 0; axis < 3; ++axis) {
        const float d = direction[axis];
        step[axis] = d > 0 ? 1 : -1;
        per_cell[axis] = std::abs(d) > 1e-9f ? 1 / std::abs(d) : 1e30f;
        const float inside = start[axis] - static_cast<float>(c[axis]);
        next[axis] = (d > 0 ? 1 - inside : inside) * per_cell[axis];
    }
    const std::size_t row = static_cast<std::size_t>(size_.x),
                      layer = row * static_cast<std::size_t>(size_.y);
    while (true) {
        const int axis = next.x < next.y ? (next.x < next.z ? 0 : 2) : (next.y < next.z ? 1 : 2);
        const float distance = next[axis];
        c[axis] += step[axis];
        if (c[axis] < 0 || c[axis] >= size_[axis]) {
            // A ray that starts outside may still enter on another axis; rays here start inside.
            return {};
        }
        next[axis] += per_cell[axis];
        const int cell = cells_[static_cast<std::size_t>(c.z) * layer + static_cast<std::size_t>(c.y) * row +
                                static_cast<std::size_t>(c.x)];
        if (cell >= 0) return {cell, distance * cell_m_};
    }
}

}  // namespace parafovea
