// Cuts meshes into pieces that are drawn or left out on their own, and simplifies each piece into levels of
// detail that share its vertices.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/scene.h"

namespace parafovea {

// A run of SceneDetail::indices. `error_m`: no vertex of the piece lies farther from the triangles that stand
// for its connected part, in the mesh's own space.
struct DetailLevel {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    float error_m = 0;
};

// Whole connected parts of a mesh that lie near each other, so that no surface is ever cut.
struct MeshPiece {
    Bounds bounds;
    std::vector<DetailLevel> levels;  // the first is the piece itself; errors rise, counts fall
};

struct SceneDetail {
    std::vector<std::uint32_t> indices;          // count from SceneMesh::first_vertex
    std::vector<std::vector<MeshPiece>> pieces;  // of each mesh of the scene
    // Where the first levels of all of a mesh's pieces stand one after the other: SceneMesh::index_count
    // indices.
    std::vector<std::uint32_t> first_index;
};

// The same scene gives the same detail. `simplified` false: one level for each piece.
SceneDetail make_detail(const Scene& scene, bool simplified);

// The last level of the piece whose error stays below `most_error_m`.
const DetailLevel& level_for(const MeshPiece& piece, float most_error_m);

}  // namespace parafovea
