// What can be said of a scene without drawing it: features, triangles, bounds, the camera along its path.
#include "renderer/scene.h"

#include <algorithm>
#include <cassert>
#include <glm/gtc/matrix_transform.hpp>

namespace parafovea {
namespace {

glm::vec3 catmull_rom(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, float t) {
    return 0.5f *
           (2.0f * b + t * (c - a + t * (2.0f * a - 5.0f * b + 4.0f * c - d + t * (3.0f * (b - c) + d - a))));
}

}  // namespace

SceneFeatures features_of(const Scene& scene) {
    SceneFeatures f;
    std::vector<bool> used(scene.materials.size(), false);
    for (const SceneInstance& instance : scene.instances) used[scene.meshes[instance.mesh].material] = true;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        if (!used[i]) continue;
        const Material& m = scene.materials[i];
        f.normal_maps |= static_cast<bool>(m.normal_texture);
        f.alpha_mask |= m.alpha_mode == AlphaMode::mask;
        f.alpha_blend |= m.alpha_mode == AlphaMode::blend;
        f.emission |= m.emissive != glm::vec3(0);
        f.occlusion_maps |= static_cast<bool>(m.occlusion_texture);
        f.transmission |= m.transmission > 0;
    }
    f.vertex_colors = std::any_of(scene.vertices.begin(), scene.vertices.end(),
                                  [](const SceneVertex& v) { return v.color != glm::u8vec4(255); });
    f.sun = scene.sun.has_value();
    f.sun_shadow = f.sun && scene.sun->casts_shadow;
    f.punctual_lights = static_cast<int>(scene.lights.size());
    return f;
}

std::uint64_t triangles_drawn(const Scene& scene) {
    std::uint64_t count = 0;
    for (const SceneInstance& instance : scene.instances)
        count += scene.meshes[instance.mesh].index_count / 3;
    return count;
}

Bounds transformed(const Bounds& bounds, const glm::mat4& matrix) {
    Bounds result;
    if (bounds.empty()) return result;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::vec3 p{corner & 1 ? bounds.high.x : bounds.low.x,
                          corner & 2 ? bounds.high.y : bounds.low.y,
                          corner & 4 ? bounds.high.z : bounds.low.z};
        result.add(glm::vec3(matrix * glm::vec4(p, 1)));
    }
    return result;
}

Bounds world_bounds(const Scene& scene) {
    Bounds all;
    for (const SceneInstance& instance : scene.instances) {
        const Bounds b = transformed(scene.meshes[instance.mesh].bounds, instance.world_from_mesh);
        if (b.empty()) continue;
        all.add(b.low);
        all.add(b.high);
    }
    return all;
}

SceneCamera camera_looking(glm::vec3 from, glm::vec3 at, float vertical_fov_rad) {
    SceneCamera camera;
    const glm::vec3 along = glm::normalize(at - from);
    const glm::vec3 up = std::abs(along.y) > 0.999f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
    camera.world_from_camera = glm::inverse(glm::lookAt(from, at, up));
    camera.vertical_fov_rad = vertical_fov_rad;
    return camera;
}

SceneCamera camera_on_path(const Scene& scene, float time_s) {
    assert(scene.path.size() >= 2 && !scene.cameras.empty());
    const auto& path = scene.path;
    const int last = static_cast<int>(path.size()) - 1;
    int i = 0;
    while (i + 1 < last && path[i + 1].time_s <= time_s) ++i;
    const float span = path[i + 1].time_s - path[i].time_s;
    const float t = std::clamp((time_s - path[i].time_s) / span, 0.0f, 1.0f);
    const CameraKey &a = path[std::max(i - 1, 0)], &b = path[i], &c = path[i + 1],
                    &d = path[std::min(i + 2, last)];
    SceneCamera camera = camera_looking(catmull_rom(a.position, b.position, c.position, d.position, t),
                                        catmull_rom(a.target, b.target, c.target, d.target, t),
                                        scene.cameras.front().vertical_fov_rad);
    camera.near_m = scene.cameras.front().near_m;
    camera.name = "path";
    return camera;
}

}  // namespace parafovea
