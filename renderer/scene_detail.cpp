// Finds connected parts, groups them, and simplifies them with meshoptimizer (Garland and Heckbert 1997,
// "Surface Simplification Using Quadric Error Metrics").
#include "renderer/scene_detail.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <unordered_map>

#include "renderer/all_processors.h"
#include "renderer/triangle_tree.h"

namespace parafovea {
namespace {

constexpr std::size_t kPieceTriangles = 1200;
// Below this a draw costs more than its triangles.
constexpr std::size_t kFewestTriangles = 48;
// A level is worth its memory if it has at most this share of the triangles of the one before.
constexpr double kWorthwhile = 0.8;
// The first level's error as a share of the piece's radius, how errors grow from level to level, and the
// largest, beyond which a lamp's ball would lose much of its area and so of its light.
constexpr float kFirstError = 1.0f / 1024, kErrorGrowth = 1.35f, kLargestError = 0.125f;

using Triangle = std::array<std::uint32_t, 3>;

// The triangles of a mesh with their connected parts. Corners at one place are one corner here, whatever else
// differs between their vertices.
struct ConnectedMesh {
    std::vector<glm::vec3> places;  // of each vertex; equal where vertices meet
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> part_of;  // each triangle's part, numbered in the order of first triangles
    std::size_t part_count = 0;
};

// Rounds places so that seams close: both sides of a tube's seam differ in the last bits.
std::vector<glm::vec3> closed_places(const Scene& scene, const SceneMesh& mesh) {
    const float extent = std::max(mesh.bounds.radius(), 1e-20f);
    const float step = std::exp2(std::floor(std::log2(extent)) - 19);
    std::vector<glm::vec3> places;
    places.reserve(mesh.vertex_count);
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
        glm::vec3 place = glm::round(scene.vertices[mesh.first_vertex + v].position / step) * step + 0.0f;
        // Sums of what lies beyond any scene must not upset the sorting below.
        for (int axis = 0; axis < 3; ++axis) place[axis] = std::abs(place[axis]) < 1e15f ? place[axis] : 0.0f;
        places.push_back(place);
    }
    return places;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parents, std::uint32_t v) {
    while (parents[v] != v) v = parents[v] = parents[parents[v]];
    return v;
}

ConnectedMesh connected(const Scene& scene, const SceneMesh& mesh) {
    ConnectedMesh c;
    c.places = closed_places(scene, mesh);
    std::vector<std::uint32_t> parents(mesh.vertex_count);
    std::iota(parents.begin(), parents.end(), 0u);
    std::vector<std::uint32_t> same(mesh.vertex_count);
    if (mesh.index_count > 0) {
        meshopt_generateVertexRemap(same.data(), &scene.indices[mesh.first_index], mesh.index_count,
                                    c.places.data(), c.places.size(), sizeof(glm::vec3));
    }
    std::vector<std::uint32_t> first_at(mesh.vertex_count, ~0u);
    for (std::uint32_t i = 0; i + 2 < mesh.index_count; i += 3) {
        Triangle t;
        for (std::uint32_t k = 0; k < 3; ++k) {
            t[k] = scene.indices[mesh.first_index + i + k];
            std::uint32_t& first = first_at[same[t[k]]];
            if (first == ~0u) first = t[k];
            parents[root_of(parents, t[k])] = root_of(parents, first);
        }
        for (std::uint32_t k = 1; k < 3; ++k) parents[root_of(parents, t[k])] = root_of(parents, t[0]);
        c.triangles.push_back(t);
    }
    std::vector<std::uint32_t> number(mesh.vertex_count, ~0u);
    for (const Triangle& t : c.triangles) {
        std::uint32_t& part = number[root_of(parents, t[0])];
        if (part == ~0u) part = static_cast<std::uint32_t>(c.part_count++);
        c.part_of.push_back(part);
    }
    return c;
}

// Parts in groups of about kPieceTriangles that lie near each other; of each group its triangles, the parts
// farthest out in the mesh first: seen from outside, these hide others, as a crown's outer leaves do.
std::vector<std::vector<std::uint32_t>> grouped(const ConnectedMesh& mesh) {
    struct Part {
        Bounds bounds;
        std::vector<std::uint32_t> triangles;
        float out = 0;  // squared, in half the mesh's size
    };
    std::vector<Part> parts(mesh.part_count);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        Part& part = parts[mesh.part_of[i]];
        part.triangles.push_back(i);
        for (std::uint32_t v : mesh.triangles[i]) part.bounds.add(mesh.places[v]);
    }
    Bounds whole;
    for (const Part& part : parts) whole.add(part.bounds.centre());
    const glm::vec3 reach = glm::max(0.5f * (whole.high - whole.low), glm::vec3(1e-20f));
    for (Part& part : parts) {
        const glm::vec3 out = (part.bounds.centre() - whole.centre()) / reach;
        part.out = glm::dot(out, out);
    }
    std::vector<std::uint32_t> order(parts.size());
    std::iota(order.begin(), order.end(), 0u);
    std::vector<std::vector<std::uint32_t>> groups;
    std::vector<std::span<std::uint32_t>> waiting{order};
    while (!waiting.empty()) {
        const std::span<std::uint32_t> some = waiting.back();
        waiting.pop_back();
        std::size_t count = 0;
        Bounds centres;
        for (std::uint32_t p : some) {
            count += parts[p].triangles.size();
            centres.add(parts[p].bounds.centre());
        }
        if (count <= kPieceTriangles || some.size() == 1) {
            std::sort(some.begin(), some.end(), [&](std::uint32_t a, std::uint32_t b) {
                return std::pair(-parts[a].out, a) < std::pair(-parts[b].out, b);
            });
            std::vector<std::uint32_t> group;
            for (std::uint32_t p : some)
                group.insert(group.end(), parts[p].triangles.begin(), parts[p].triangles.end());
            if (!group.empty()) groups.push_back(std::move(group));
            continue;
        }
        const glm::vec3 size = centres.high - centres.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        std::sort(some.begin(), some.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(parts[a].bounds.centre()[axis], a) <
                   std::pair(parts[b].bounds.centre()[axis], b);
        });
        waiting.push_back(some.subspan(some.size() / 2));
        waiting.push_back(some.first(some.size() / 2));
    }
    return groups;
}

// One piece while it is simplified: its own vertices, numbered from 0.
struct WorkingPiece {
    std::vector<glm::vec3> places;
    std::vector<std::uint32_t> mesh_vertex;
    std::vector<std::uint32_t> part;  // of each vertex
    std::vector<std::uint32_t> indices;
};

WorkingPiece working_piece(const ConnectedMesh& mesh, std::span<const std::uint32_t> triangles) {
    WorkingPiece piece;
    std::unordered_map<std::uint32_t, std::uint32_t> numbers;
    for (std::uint32_t t : triangles) {
        for (std::uint32_t v : mesh.triangles[t]) {
            const auto [found, is_new] = numbers.try_emplace(v, static_cast<std::uint32_t>(numbers.size()));
            if (is_new) {
                piece.places.push_back(mesh.places[v]);
                piece.mesh_vertex.push_back(v);
                piece.part.push_back(mesh.part_of[t]);
            }
            piece.indices.push_back(found->second);
        }
    }
    return piece;
}

// The largest distance of a vertex from the triangles that are left of its part; infinite where none is left.
float deviation(const WorkingPiece& piece, std::span<const std::uint32_t> left) {
    std::unordered_map<std::uint32_t, std::vector<Triangle>> triangles_of_part;
    std::vector<bool> kept(piece.places.size(), false);
    for (std::size_t i = 0; i < left.size(); i += 3) {
        triangles_of_part[piece.part[left[i]]].push_back({left[i], left[i + 1], left[i + 2]});
        for (std::size_t k = 0; k < 3; ++k) kept[left[i + k]] = true;
    }
    std::unordered_map<std::uint32_t, TriangleTree> trees;
    for (auto& [part, triangles] : triangles_of_part)
        trees.try_emplace(part, piece.places, std::move(triangles));
    float largest = 0;
    for (std::size_t v = 0; v < piece.places.size(); ++v) {
        if (kept[v]) continue;
        const auto tree = trees.find(piece.part[v]);
        if (tree == trees.end()) return std::numeric_limits<float>::infinity();
        largest = std::max(largest, tree->second.squared_distance(piece.places[v], largest));
    }
    return std::sqrt(largest);
}

std::vector<std::uint32_t> simplified(const WorkingPiece& piece, std::span<const std::uint32_t> indices,
                                      float error_m) {
    std::vector<std::uint32_t> left(indices.size());
    const float scale = meshopt_simplifyScale(&piece.places[0].x, piece.places.size(), sizeof(glm::vec3));
    left.resize(meshopt_simplify(left.data(), indices.data(), indices.size(), &piece.places[0].x,
                                 piece.places.size(), sizeof(glm::vec3), 0, error_m / scale, 0, nullptr));
    return left;
}

struct SimplerLevel {
    std::vector<std::uint32_t> indices;  // of the working piece
    float error_m = 0;
};

std::vector<SimplerLevel> simpler_levels(const WorkingPiece& piece, float radius) {
    std::vector<SimplerLevel> levels;
    if (piece.indices.size() / 3 < kFewestTriangles || !(radius > 0)) return levels;
    const auto worthwhile = [](std::size_t fewer, std::size_t than) {
        return static_cast<double>(fewer) <= kWorthwhile * static_cast<double>(than);
    };
    std::size_t last_count = piece.indices.size();
    for (float error = kFirstError; error <= kLargestError; error *= kErrorGrowth) {
        const std::vector<std::uint32_t>& from = levels.empty() ? piece.indices : levels.back().indices;
        SimplerLevel level{simplified(piece, from, error * radius), 0};
        const bool fewer = !level.indices.empty() && worthwhile(level.indices.size(), last_count);
        if (!fewer) continue;
        level.error_m = deviation(piece, level.indices);
        if (level.error_m > kLargestError * radius) break;
        if (!levels.empty() && level.error_m <= levels.back().error_m) levels.pop_back();
        last_count = level.indices.size();
        levels.push_back(std::move(level));
        if (last_count / 3 < kFewestTriangles / 2) break;
    }
    for (SimplerLevel& level : levels) {
        meshopt_optimizeVertexCache(level.indices.data(), level.indices.data(), level.indices.size(),
                                    piece.places.size());
    }
    return levels;
}

}  // namespace

SceneDetail make_detail(const Scene& scene, bool simplify) {
    SceneDetail detail;
    // Lay out full detail.
    std::vector<WorkingPiece> working;
    for (const SceneMesh& mesh : scene.meshes) {
        const ConnectedMesh whole = connected(scene, mesh);
        detail.first_index.push_back(static_cast<std::uint32_t>(detail.indices.size()));
        std::vector<MeshPiece>& pieces = detail.pieces.emplace_back();
        for (const auto& group : grouped(whole)) {
            MeshPiece piece;
            piece.levels.push_back({static_cast<std::uint32_t>(detail.indices.size()),
                                    static_cast<std::uint32_t>(3 * group.size()), 0});
            for (std::uint32_t t : group) {
                for (std::uint32_t v : whole.triangles[t]) {
                    piece.bounds.add(scene.vertices[mesh.first_vertex + v].position);
                    detail.indices.push_back(v);
                }
            }
            pieces.push_back(std::move(piece));
            if (simplify) working.push_back(working_piece(whole, group));
        }
    }
    if (!simplify) return detail;

    // Simplify.
    std::vector<MeshPiece*> pieces;
    for (auto& of_mesh : detail.pieces)
        for (MeshPiece& piece : of_mesh) pieces.push_back(&piece);
    std::vector<std::vector<SimplerLevel>> levels(pieces.size());
    on_all_processors(static_cast<int>(pieces.size()), [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        levels[k] = simpler_levels(working[k], pieces[k]->bounds.radius());
    });
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        for (const SimplerLevel& level : levels[i]) {
            pieces[i]->levels.push_back({static_cast<std::uint32_t>(detail.indices.size()),
                                         static_cast<std::uint32_t>(level.indices.size()), level.error_m});
            for (std::uint32_t v : level.indices) detail.indices.push_back(working[i].mesh_vertex[v]);
        }
    }
    return detail;
}

const DetailLevel& level_for(const MeshPiece& piece, float most_error_m) {
    assert(!piece.levels.empty());
    std::size_t chosen = 0;
    while (chosen + 1 < piece.levels.size() && piece.levels[chosen + 1].error_m <= most_error_m) ++chosen;
    return piece.levels[chosen];
}

}  // namespace parafovea
