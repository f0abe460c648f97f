// Leaves out what lies outside the frustum and sorts what is left.
#include "renderer/scene_visible.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "renderer/scene_shadow.h"

namespace parafovea {
namespace {

// How many pixels at most a metre covers, anywhere in a box. A flat picture stretches what lies off its axis.
float px_per_m(const Bounds& box, const CameraView& view, const glm::mat4& eye_from_world, SizePx size) {
    const float widest = std::max(view.tan_left, view.tan_right),
                highest = std::max(view.tan_up, view.tan_down);
    float most_x = 0, most_y = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p{eye_from_world * glm::vec4(corner & 1 ? box.high.x : box.low.x,
                                                     corner & 2 ? box.high.y : box.low.y,
                                                     corner & 4 ? box.high.z : box.low.z, 1)};
        const bool ahead = p.z < -view.near_m;
        most_x = std::max(most_x, ahead ? std::abs(p.x / p.z) : widest);
        most_y = std::max(most_y, ahead ? std::abs(p.y / p.z) : highest);
    }
    // Only what lies in the frustum is seen.
    most_x = std::min(most_x, widest);
    most_y = std::min(most_y, highest);
    const float px_per_tan = std::max(static_cast<float>(size.width) / (view.tan_left + view.tan_right),
                                      static_cast<float>(size.height) / (view.tan_up + view.tan_down));
    const glm::vec3 eye{view.world_from_eye[3]};
    const float distance = std::max(glm::distance(eye, glm::clamp(eye, box.low, box.high)), view.near_m);
    return px_per_tan * (1 + most_x * most_x + most_y * most_y) / distance;
}

}  // namespace

VisiblePieces visible_pieces(const SceneResources& resources, const CameraView& view, SizePx size,
                             double most_error_px) {
    const glm::vec3 eye{view.world_from_eye[3]};
    const glm::mat4 eye_from_world = glm::inverse(view.world_from_eye);
    const glm::mat4 clip = clip_from_world(view, size);
    VisiblePieces visible;
    std::vector<VisiblePiece>& found = visible.pieces;
    for (std::size_t i = 0; i < resources.instances().size(); ++i) {
        const DrawInstance& instance = resources.instances()[i];
        if (instance.bounds.empty() || !may_be_seen(instance.bounds, clip)) continue;
        const std::vector<MeshPiece>& pieces = resources.meshes()[instance.mesh].pieces;
        for (std::size_t k = 0; k < pieces.size(); ++k) {
            const Bounds& bounds = instance.piece_bounds[k];
            if (pieces.size() > 1 && !may_be_seen(bounds, clip)) continue;
            DetailLevel level = pieces[k].levels.front();
            visible.full_triangles += level.index_count / 3;
            if (pieces[k].levels.size() > 1) {
                const float px_per_error = px_per_m(bounds, view, eye_from_world, size) * instance.stretch;
                level = level_for(pieces[k], static_cast<float>(most_error_px) / px_per_error);
            }
            visible.triangles += level.index_count / 3;
            // By their centres: what is large and begins near, as a road, mostly lies behind what stands on
            // it.
            found.push_back({glm::distance(eye, bounds.centre()), i, level.first_index, level.index_count,
                             instance.mirrored});
        }
    }
    std::sort(found.begin(), found.end(), [](const VisiblePiece& a, const VisiblePiece& b) {
        return std::tuple(a.first_index, a.mirrored, a.distance_m, a.instance) <
               std::tuple(b.first_index, b.mirrored, b.distance_m, b.instance);
    });
    for (std::uint32_t i = 0; i < found.size(); ++i) {
        const bool same = i > 0 && found[i].first_index == found[i - 1].first_index &&
                          found[i].mirrored == found[i - 1].mirrored;
        if (!same) visible.draws.push_back({i, 0});
        ++visible.draws.back().count;
    }
    std::sort(visible.draws.begin(), visible.draws.end(), [&found](const PieceDraw& a, const PieceDraw& b) {
        return std::tuple(found[a.first].distance_m, a.first) <
               std::tuple(found[b.first].distance_m, b.first);
    });
    return visible;
}

}  // namespace parafovea
