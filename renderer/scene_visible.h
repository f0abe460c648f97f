// Which pieces of a scene a view shows, in which levels of detail, and which of them one call can draw.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/scene_camera.h"
#include "renderer/scene_resources.h"

namespace parafovea {

// A piece of an instance, in the level of detail in which it is drawn.
struct VisiblePiece {
    float distance_m = 0;
    std::size_t instance = 0;
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    bool mirrored = false;
};

// Neighbours among the pieces that one draw call draws: the same piece in the same level of detail.
struct PieceDraw {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
};

struct VisiblePieces {
    std::vector<VisiblePiece> pieces;
    std::vector<PieceDraw> draws;  // the nearest first
    std::uint64_t triangles = 0;
    std::uint64_t full_triangles = 0;  // of the same pieces in full detail
};

// Each piece is in the coarsest level no vertex of which appears farther than `most_error_px` from its place.
VisiblePieces visible_pieces(const SceneResources& resources, const CameraView& view, SizePx size,
                             double most_error_px);

}  // namespace parafovea
