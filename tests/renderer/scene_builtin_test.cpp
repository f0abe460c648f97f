// The built-in scenes: large enough, the same on every call, sound geometry.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "renderer/scene_catalog.h"

namespace parafovea {
namespace {

template <typename T>
std::uint64_t hash_of(const std::vector<T>& values, std::uint64_t hash = 1469598103934665603u) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(values.data());
    for (std::size_t i = 0; i < values.size() * sizeof(T); ++i) hash = (hash ^ bytes[i]) * 1099511628211u;
    return hash;
}

std::uint64_t hash_of(const Scene& scene) {
    std::uint64_t hash = hash_of(scene.indices, hash_of(scene.vertices));
    for (const SceneImage& image : scene.images) hash = hash_of(image.rgba, hash);
    return hash;
}

// Building it takes a second; most tests can share one.
const Scene& atrium() {
    static const Scene scene = load_scene("atrium");
    return scene;
}

TEST(Atrium, HasAQuarterMillionTrianglesNormalMapsAndAShadowedSun) {
    const Scene& scene = atrium();
    EXPECT_GE(triangles_drawn(scene), 250000u);
    EXPECT_TRUE(features_of(scene).normal_maps);
    EXPECT_TRUE(features_of(scene).sun_shadow);
    EXPECT_FALSE(features_of(scene).alpha_blend);
    EXPECT_GE(scene.path.size(), 2u);
}

TEST(Atrium, IsTheSameOnEveryCall) {
    EXPECT_EQ(hash_of(load_scene("atrium")), hash_of(atrium()));
}

TEST(Atrium, WindsItsTrianglesTheWayItsNormalsPoint) {
    const Scene& scene = atrium();
    std::size_t wrong = 0, all = 0;
    for (const SceneMesh& mesh : scene.meshes) {
        for (std::uint32_t i = 0; i < mesh.index_count; i += 3) {
            const SceneVertex* v[3];
            for (std::uint32_t k = 0; k < 3; ++k)
                v[k] = &scene.vertices[mesh.first_vertex + scene.indices[mesh.first_index + i + k]];
            const glm::vec3 face =
                glm::cross(v[1]->position - v[0]->position, v[2]->position - v[0]->position);
            if (glm::length(face) < 1e-9f) continue;
            ++all;
            wrong += glm::dot(face, v[0]->normal + v[1]->normal + v[2]->normal) <= 0;
        }
    }
    EXPECT_LT(static_cast<double>(wrong), 0.001 * static_cast<double>(all)) << wrong << " of " << all;
}

TEST(Atrium, HasUnitNormalsAndTangentsAcrossThem) {
    const Scene& scene = atrium();
    for (const SceneVertex& v : scene.vertices) {
        ASSERT_NEAR(glm::length(v.normal), 1, 1e-3);
        ASSERT_NEAR(glm::length(glm::vec3(v.tangent)), 1, 1e-3);
        ASSERT_NEAR(glm::dot(v.normal, glm::vec3(v.tangent)), 0, 2e-3);
    }
}

TEST(Atrium, HasItsCameraInsideTheHall) {
    const Scene& scene = atrium();
    const Bounds hall = world_bounds(scene);
    for (const SceneCamera& camera : scene.cameras) {
        const glm::vec3 p{camera.world_from_camera[3]};
        EXPECT_TRUE(glm::all(glm::lessThan(hall.low, p)) && glm::all(glm::lessThan(p, hall.high)));
    }
}

TEST(Street, HasAMillionTrianglesDozensOfLampsAndGlass) {
    const Scene scene = load_scene("street");
    const SceneFeatures f = features_of(scene);
    EXPECT_GE(triangles_drawn(scene), 1000000u);
    EXPECT_GE(f.punctual_lights, 24);
    EXPECT_LE(f.punctual_lights, 64);
    EXPECT_TRUE(f.alpha_blend && f.transmission && f.emission && f.normal_maps);
    EXPECT_EQ(hash_of(scene), hash_of(load_scene("street")));
}

TEST(Primitives, AreRayMarchedWithoutMeshes) {
    const Scene scene = load_scene("primitives");
    EXPECT_TRUE(scene.ray_marched);
    EXPECT_TRUE(scene.meshes.empty());
    EXPECT_EQ(triangles_drawn(scene), 0u);
    EXPECT_TRUE(scene.sun.has_value());
}

TEST(Catalog, ListsScenesThatLoadUnderTheirNames) {
    for (const SceneSummary& summary : scene_catalog()) {
        const Scene scene = load_scene(summary.name);
        EXPECT_EQ(scene.name, summary.name);
        EXPECT_EQ(triangles_drawn(scene), summary.triangles);
        EXPECT_FALSE(summary.features.empty());
        EXPECT_GT(summary.lights, 0);
    }
}

TEST(CameraPath, RunsSmoothlyThroughItsKeys) {
    const Scene& scene = atrium();
    for (const CameraKey& key : scene.path) {
        const SceneCamera camera = camera_on_path(scene, key.time_s);
        EXPECT_NEAR(glm::distance(glm::vec3(camera.world_from_camera[3]), key.position), 0, 1e-4);
    }
    const float end = scene.path.back().time_s;
    glm::vec3 last{camera_on_path(scene, -1).world_from_camera[3]};
    for (float t = 0; t <= end + 1; t += 0.05f) {
        const glm::vec3 here{camera_on_path(scene, t).world_from_camera[3]};
        EXPECT_LT(glm::distance(here, last), 0.25f) << t;
        last = here;
    }
}

}  // namespace
}  // namespace parafovea
