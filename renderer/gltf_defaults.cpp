// Chooses a camera that sees everything and a sun that shines in.
#include "renderer/gltf_defaults.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "renderer/scene_voxels.h"

namespace parafovea {
namespace {

bool inside(const Bounds& box, glm::vec3 p) {
    return glm::all(glm::lessThan(box.low, p)) && glm::all(glm::lessThan(p, box.high));
}

// The direction to the sun that lights most of what the camera sees.
glm::vec3 sun_that_shines_in(const Scene& scene, glm::vec3 otherwise) {
    const SceneVoxels voxels(scene, 96);
    const SceneCamera& camera = scene.cameras.front();
    const glm::vec3 eye{camera.world_from_camera[3]};
    const glm::mat3 world_from_camera{camera.world_from_camera};
    const float tan_y = std::tan(camera.vertical_fov_rad / 2), tan_x = 1.7f * tan_y;
    std::vector<std::pair<glm::vec3, glm::vec3>> seen;  // positions and normals
    for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 34; ++x) {
            const glm::vec3 ray{tan_x * (2 * (static_cast<float>(x) + 0.5f) / 34 - 1),
                                tan_y * (2 * (static_cast<float>(y) + 0.5f) / 20 - 1), -1};
            const glm::vec3 direction = glm::normalize(world_from_camera * ray);
            const SceneVoxels::Hit hit = voxels.trace(eye, direction);
            if (hit.surface < 0) continue;
            glm::vec3 normal = voxels.surface(hit.surface).normal;
            if (glm::length(normal) < 0.3f) continue;
            normal = glm::normalize(normal) * (glm::dot(normal, direction) > 0 ? -1.0f : 1.0f);
            seen.emplace_back(eye + direction * hit.distance_m + 0.6f * voxels.cell_m() * normal, normal);
        }
    }
    float most = 0.02f * static_cast<float>(seen.size());
    glm::vec3 best = otherwise;
    for (float elevation_deg : {28.0f, 40.0f, 52.0f}) {
        for (int step = 0; step < 24; ++step) {
            const float azimuth = 2 * std::numbers::pi_v<float> * static_cast<float>(step) / 24;
            const float elevation = elevation_deg * std::numbers::pi_v<float> / 180;
            const glm::vec3 to_sun{std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                   std::cos(elevation) * std::cos(azimuth)};
            float lit = 0;
            for (const auto& [position, normal] : seen) {
                const float cosine = glm::dot(normal, to_sun);
                if (cosine > 0.05f && voxels.trace(position, to_sun).surface < 0) lit += std::sqrt(cosine);
            }
            if (lit > most) {
                most = lit;
                best = to_sun;
            }
        }
    }
    return best;
}

// In a house: at eye height near a lamp, where the view reaches farthest. Empty if every place is blocked.
std::optional<SceneCamera> room_camera(const Scene& scene) {
    constexpr int kDirections = 48;
    constexpr float kEyeHeight_m = 1.55f, kFarEnough_m = 9;
    const SceneVoxels voxels(scene, 128);
    const float eye_y = world_bounds(scene).low.y + kEyeHeight_m;
    std::optional<SceneCamera> best;
    float best_score = 1.5f;
    for (const PunctualLight& lamp : scene.lights) {
        for (int place = 0; place < 16; ++place) {
            const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(place) / 16;
            const glm::vec3 eye{lamp.position.x + 1.8f * std::sin(turn), eye_y,
                                lamp.position.z + 1.8f * std::cos(turn)};
            if (!inside(voxels.bounds(), eye) || voxels.filled(eye)) continue;
            float reach[kDirections];
            const auto direction = [](int i) {
                const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kDirections;
                return glm::vec3(std::sin(angle), -0.08f, std::cos(angle));
            };
            for (int i = 0; i < kDirections; ++i) {
                const SceneVoxels::Hit hit = voxels.trace(eye, glm::normalize(direction(i)));
                // A view out of the house shows nothing.
                reach[i] = hit.surface < 0 ? 0 : std::min(hit.distance_m, kFarEnough_m);
            }
            for (int i = 0; i < kDirections; ++i) {
                float sum = 0, nearest = kFarEnough_m;
                for (int k = -5; k <= 5; ++k) {
                    const float r = reach[(i + k + kDirections) % kDirections];
                    sum += r / 11;
                    nearest = std::min(nearest, r);
                }
                const float score = sum + std::min(nearest, 2.0f);
                if (score <= best_score) continue;
                best_score = score;
                best = camera_looking(eye, eye + direction(i), 1.0f);
                best->name = "room";
            }
        }
    }
    return best;
}

}  // namespace

SceneCamera default_camera(const Scene& scene) {
    constexpr float kFov = 0.8f;
    // Lamps and the size of a building: people look at it from within.
    if (!scene.lights.empty() && world_bounds(scene).radius() > 4)
        if (const auto room = room_camera(scene)) return *room;
    const Bounds bounds = world_bounds(scene);
    const float radius = std::max(bounds.radius(), 1e-4f);
    const glm::vec3 from =
        bounds.centre() + glm::normalize(glm::vec3(0.55f, 0.35f, 1)) * radius / std::sin(kFov / 2);
    SceneCamera camera = camera_looking(from, bounds.centre(), kFov);
    camera.name = "whole";
    camera.near_m = 0.01f * radius;
    return camera;
}

void light_by_default(Scene& scene, bool has_sun) {
    const bool indoors = inside(world_bounds(scene), glm::vec3(scene.cameras.front().world_from_camera[3]));
    if (has_sun) {
        // Files in physical units give the sun tens of thousands of lux.
        const glm::vec3 e = scene.sun->irradiance;
        const float scale = std::max(std::max(e.x, std::max(e.y, e.z)) / 3, 0.01f);
        scene.sky = Sky{scene.sky.zenith * scale, scene.sky.horizon * scale, scene.sky.ground * scale};
        scene.exposure = scale > 3 ? 1 / scale : 1;
    } else if (scene.lights.empty()) {
        glm::vec3 to_sun = glm::normalize(glm::vec3(0.45f, 0.75f, 0.5f));
        if (indoors) to_sun = sun_that_shines_in(scene, to_sun);
        scene.sun = Sun{to_sun, glm::vec3(3.2f, 3.0f, 2.7f), true};
        scene.exposure = 0.75f;
    } else {
        // A scene with lamps of its own is lit by them; the sky only fills in.
        scene.sky = Sky{glm::vec3(0.25f), glm::vec3(0.3f), glm::vec3(0.15f)};
    }
    if (indoors) scene.exposure = 0;
}

}  // namespace parafovea
