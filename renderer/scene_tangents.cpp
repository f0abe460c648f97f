// Derives normals from triangles and tangents from texture coordinates.
#include "renderer/scene_tangents.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace parafovea {
namespace {

glm::vec3 unit_or(glm::vec3 v, glm::vec3 otherwise) {
    const float length = glm::length(v);
    return length > 1e-20f && std::isfinite(length) ? v / length : otherwise;
}

glm::vec3 any_perpendicular(glm::vec3 n) {
    return glm::normalize(std::abs(n.x) < 0.9f ? glm::cross(n, {1, 0, 0}) : glm::cross(n, {0, 1, 0}));
}

struct FaceTangent {
    glm::vec3 along_u{0};  // not normalised; zero when the texture coordinates do not span a triangle
    bool mirrored = false;
};

FaceTangent face_tangent(const SceneVertex& a, const SceneVertex& b, const SceneVertex& c) {
    const glm::vec3 e1 = b.position - a.position, e2 = c.position - a.position;
    const glm::vec2 d1 = b.uv - a.uv, d2 = c.uv - a.uv;
    const float area = d1.x * d2.y - d1.y * d2.x;
    if (std::abs(area) < 1e-20f) return {};
    // Texture v points down, the bitangent up: on an unmirrored triangle the area in (u, v) is negative.
    return {(e1 * d2.y - e2 * d1.y) * (area > 0 ? 1.0f : -1.0f), area > 0};
}

}  // namespace

void make_flat_normals(Triangles& mesh) {
    Triangles flat;
    flat.vertices.reserve(mesh.indices.size());
    flat.indices.reserve(mesh.indices.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        SceneVertex corners[3];
        for (std::size_t k = 0; k < 3; ++k) corners[k] = mesh.vertices[mesh.indices[i + k]];
        const glm::vec3 normal = unit_or(
            glm::cross(corners[1].position - corners[0].position, corners[2].position - corners[0].position),
            {0, 1, 0});
        for (SceneVertex& corner : corners) {
            corner.normal = normal;
            flat.indices.push_back(static_cast<std::uint32_t>(flat.vertices.size()));
            flat.vertices.push_back(corner);
        }
    }
    mesh = std::move(flat);
}

void make_tangents(Triangles& mesh) {
    // Sum the tangents of the faces around each vertex, the mirrored ones apart.
    const std::size_t count = mesh.vertices.size();
    std::vector<glm::vec3> plain(count, glm::vec3(0)), mirrored(count, glm::vec3(0));
    std::vector<bool> has_plain(count, false), has_mirrored(count, false);
    std::vector<bool> face_mirrored(mesh.indices.size() / 3, false);
    for (std::size_t face = 0; face < face_mirrored.size(); ++face) {
        const std::uint32_t* corner = &mesh.indices[3 * face];
        const FaceTangent t =
            face_tangent(mesh.vertices[corner[0]], mesh.vertices[corner[1]], mesh.vertices[corner[2]]);
        if (t.along_u == glm::vec3(0)) continue;
        face_mirrored[face] = t.mirrored;
        for (int k = 0; k < 3; ++k) {
            const SceneVertex& v = mesh.vertices[corner[k]];
            const glm::vec3 to_next =
                unit_or(mesh.vertices[corner[(k + 1) % 3]].position - v.position, glm::vec3(0));
            const glm::vec3 to_last =
                unit_or(mesh.vertices[corner[(k + 2) % 3]].position - v.position, glm::vec3(0));
            const float angle = std::acos(std::clamp(glm::dot(to_next, to_last), -1.0f, 1.0f));
            const glm::vec3 in_plane = t.along_u - v.normal * glm::dot(v.normal, t.along_u);
            (t.mirrored ? mirrored : plain)[corner[k]] += angle * unit_or(in_plane, glm::vec3(0));
            (t.mirrored ? has_mirrored : has_plain)[corner[k]] = true;
        }
    }

    // Store them; where both kinds meet, the mirrored faces get a vertex of their own.
    std::vector<std::uint32_t> twin(count, 0);
    for (std::size_t i = 0; i < count; ++i) {
        SceneVertex& v = mesh.vertices[i];
        const bool only_mirrored = has_mirrored[i] && !has_plain[i];
        const glm::vec3 fallback = any_perpendicular(v.normal);
        v.tangent = glm::vec4(unit_or(only_mirrored ? mirrored[i] : plain[i], fallback),
                              only_mirrored ? -1.0f : 1.0f);
        if (has_mirrored[i] && has_plain[i]) {
            SceneVertex other = v;
            other.tangent = glm::vec4(unit_or(mirrored[i], fallback), -1.0f);
            twin[i] = static_cast<std::uint32_t>(mesh.vertices.size());
            mesh.vertices.push_back(other);
        }
    }
    for (std::size_t face = 0; face < face_mirrored.size(); ++face) {
        if (!face_mirrored[face]) continue;
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& corner = mesh.indices[3 * face + static_cast<std::size_t>(k)];
            if (twin[corner] != 0) corner = twin[corner];
        }
    }
}

int append_mesh(Scene& scene, const Triangles& mesh, int material) {
    SceneMesh entry;
    entry.first_index = static_cast<std::uint32_t>(scene.indices.size());
    entry.index_count = static_cast<std::uint32_t>(mesh.indices.size());
    entry.first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
    entry.vertex_count = static_cast<std::uint32_t>(mesh.vertices.size());
    entry.material = material;
    for (const SceneVertex& v : mesh.vertices) entry.bounds.add(v.position);
    scene.vertices.insert(scene.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    scene.indices.insert(scene.indices.end(), mesh.indices.begin(), mesh.indices.end());
    scene.meshes.push_back(entry);
    return static_cast<int>(scene.meshes.size()) - 1;
}

}  // namespace parafovea
