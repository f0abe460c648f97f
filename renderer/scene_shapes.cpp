// Samples parametric surfaces into triangles.
#include "renderer/scene_shapes.h"

#include <cmath>
#include <numbers>

namespace parafovea {
namespace {

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

glm::vec3 normal_at(const Surface& surface, float u, float v) {
    constexpr float kStep = 1e-3f;
    const glm::vec3 du = surface(u + kStep, v).position - surface(u - kStep, v).position;
    const glm::vec3 dv = surface(u, v + kStep).position - surface(u, v - kStep).position;
    const glm::vec3 n = glm::cross(du, dv);
    const float length = glm::length(n);
    return length > 1e-14f ? n / length : glm::vec3(0, 1, 0);
}

}  // namespace

void add_surface(Triangles& mesh, int columns, int rows, const Surface& surface) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int row = 0; row <= rows; ++row) {
        for (int column = 0; column <= columns; ++column) {
            const float u = static_cast<float>(column) / static_cast<float>(columns);
            const float v = static_cast<float>(row) / static_cast<float>(rows);
            const SurfacePoint point = surface(u, v);
            SceneVertex vertex;
            vertex.position = point.position;
            vertex.uv = point.uv;
            vertex.normal = normal_at(surface, u, v);
            mesh.vertices.push_back(vertex);
        }
    }
    const auto stride = static_cast<std::uint32_t>(columns + 1);
    for (std::uint32_t row = 0; row < static_cast<std::uint32_t>(rows); ++row) {
        for (std::uint32_t column = 0; column < static_cast<std::uint32_t>(columns); ++column) {
            const std::uint32_t a = first + row * stride + column, b = a + 1, c = b + stride, d = a + stride;
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        }
    }
}

void add_panel(Triangles& mesh, glm::vec3 corner, glm::vec3 edge_u, glm::vec3 edge_v, int cells_u,
               int cells_v) {
    const float width = glm::length(edge_u), height = glm::length(edge_v);
    add_surface(mesh, cells_u, cells_v, [&](float u, float v) {
        return SurfacePoint{corner + u * edge_u + v * edge_v, {u * width, -v * height}};
    });
}

void add_box(Triangles& mesh, glm::vec3 low, glm::vec3 high) {
    const glm::vec3 s = high - low;
    add_panel(mesh, {low.x, low.y, high.z}, {s.x, 0, 0}, {0, s.y, 0});
    add_panel(mesh, {high.x, low.y, low.z}, {-s.x, 0, 0}, {0, s.y, 0});
    add_panel(mesh, {high.x, low.y, high.z}, {0, 0, -s.z}, {0, s.y, 0});
    add_panel(mesh, {low.x, low.y, low.z}, {0, 0, s.z}, {0, s.y, 0});
    add_panel(mesh, {low.x, high.y, high.z}, {s.x, 0, 0}, {0, 0, -s.z});
    add_panel(mesh, {low.x, low.y, low.z}, {s.x, 0, 0}, {0, 0, s.z});
}

void add_lathe(Triangles& mesh, std::span<const glm::vec2> profile, int segments, bool smooth) {
    // The length along the profile is the texture's v.
    std::vector<float> along{0};
    float widest = 0;
    for (std::size_t i = 0; i < profile.size(); ++i) {
        widest = std::max(widest, profile[i].x);
        if (i > 0) along.push_back(along.back() + glm::distance(profile[i - 1], profile[i]));
    }
    const auto at = [&](float angle_turns, glm::vec2 point, float v) {
        const float angle = kTurn * angle_turns;
        return SurfacePoint{{point.x * std::sin(angle), point.y, point.x * std::cos(angle)},
                            {std::round(kTurn * widest) * angle_turns, -v}};
    };
    if (smooth) {
        const auto pieces = static_cast<float>(profile.size() - 1);
        add_surface(mesh, segments, static_cast<int>(profile.size()) - 1, [&](float u, float v) {
            const float x = std::clamp(v, 0.0f, 1.0f) * pieces;
            const auto i = std::min(static_cast<std::size_t>(x), profile.size() - 2);
            const float t = v * pieces - static_cast<float>(i);
            return at(u, glm::mix(profile[i], profile[i + 1], t), glm::mix(along[i], along[i + 1], t));
        });
        return;
    }
    for (std::size_t i = 0; i + 1 < profile.size(); ++i)
        add_surface(mesh, segments, 1, [&](float u, float v) {
            return at(u, glm::mix(profile[i], profile[i + 1], v), glm::mix(along[i], along[i + 1], v));
        });
}

void add_moulding(Triangles& mesh, std::span<const glm::vec2> profile, float length, int cells) {
    float start = 0;
    for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
        const glm::vec2 a = profile[i], b = profile[i + 1];
        const float rise = glm::distance(a, b);
        // Seen from +x, z runs to the left: u runs against it.
        add_surface(mesh, cells, 1, [&](float u, float v) {
            const glm::vec2 p = glm::mix(a, b, v);
            return SurfacePoint{{p.x, p.y, (1 - u) * length}, {u * length, -start - v * rise}};
        });
        start += rise;
    }
}

void add_transformed(Triangles& mesh, const Triangles& part, const glm::mat4& matrix) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const glm::mat3 normals = glm::transpose(glm::inverse(glm::mat3(matrix)));
    for (SceneVertex v : part.vertices) {
        v.position = glm::vec3(matrix * glm::vec4(v.position, 1));
        v.normal = glm::normalize(normals * v.normal);
        mesh.vertices.push_back(v);
    }
    for (std::uint32_t index : part.indices) mesh.indices.push_back(first + index);
}

}  // namespace parafovea
