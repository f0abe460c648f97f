// Light that is worked out before the first frame: the irradiance volume, the light grid, the sky's
// harmonics.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "devices/random.h"
#include "renderer/scene_irradiance.h"
#include "renderer/scene_lighting.h"
#include "renderer/scene_shapes.h"
#include "renderer/scene_voxels.h"

namespace parafovea {
namespace {

glm::vec3 irradiance_over_pi(const IrradianceVolume& volume, glm::ivec3 cell, glm::vec3 n) {
    const glm::vec4 basis{1, n.y, n.z, n.x};
    glm::vec3 sum;
    for (int color = 0; color < 3; ++color)
        sum[color] = glm::dot(volume.at(color, cell.x, cell.y, cell.z), basis);
    return sum;
}

// A room of 4 x 4 x 4 metres seen from within; walls of one colour that may shine.
Scene room(glm::vec3 color, glm::vec3 emission) {
    Scene scene;
    scene.sky = Sky{glm::vec3(5), glm::vec3(5), glm::vec3(5)};
    Material m;
    m.base_color = glm::vec4(color, 1);
    m.emissive = emission;
    scene.materials.push_back(m);
    Triangles walls;
    add_box(walls, glm::vec3(-2), glm::vec3(2));
    for (std::size_t i = 0; i < walls.indices.size(); i += 3)
        std::swap(walls.indices[i], walls.indices[i + 1]);
    for (SceneVertex& v : walls.vertices) v.normal = -v.normal;
    scene.instances.push_back({append_mesh(scene, walls, 0), glm::mat4(1)});
    return scene;
}

TEST(IrradianceVolume, OfAClosedDarkRoomIsBlack) {
    const IrradianceVolume volume = bake_irradiance(room(glm::vec3(0.8f), glm::vec3(0)));
    for (const glm::vec4& texel : volume.texels) EXPECT_NEAR(glm::length(texel), 0, 1e-6);
}

TEST(IrradianceVolume, OfAGlowingRoomIsTheGeometricSeriesOfItsBounces) {
    // Inside an enclosure of radiance e and albedo a everything sees e (1 + a + a^2 + ...); three gathers
    // keep three terms.
    const glm::vec3 emission{1, 2, 0.5f}, albedo{0.5f, 0.2f, 0.8f};
    const IrradianceVolume volume = bake_irradiance(room(albedo, emission));
    const glm::ivec3 middle = volume.size / 2;
    for (const glm::vec3 n : {glm::vec3(0, 1, 0), glm::vec3(1, 0, 0), glm::vec3(0.6f, 0, -0.8f)}) {
        const glm::vec3 light = irradiance_over_pi(volume, middle, n);
        for (int c = 0; c < 3; ++c) {
            const float expected = emission[c] * (1 + albedo[c] + albedo[c] * albedo[c]);
            EXPECT_NEAR(light[c], expected, 0.04f * expected) << c;
        }
    }
}

TEST(IrradianceVolume, UnderTheOpenSkyIsTheSky) {
    Scene scene = room(glm::vec3(0), glm::vec3(0));
    // A small black thing and another far off span the volume.
    scene.instances = {{0, glm::mat4(0.01f)}, {0, glm::mat4(0.01f)}};
    scene.instances[0].world_from_mesh[3] = {0, 0, 0, 1};
    scene.instances[1].world_from_mesh[3] = {10, 10, 10, 1};
    const IrradianceVolume volume = bake_irradiance(scene);
    const glm::vec3 light = irradiance_over_pi(volume, volume.size / 2, {0, 1, 0});
    EXPECT_NEAR(light.x, 5, 0.05);
}

TEST(IrradianceVolume, IsTheSameOnEveryCall) {
    const Scene scene = room({0.3f, 0.4f, 0.5f}, {0.1f, 0, 1});
    EXPECT_EQ(bake_irradiance(scene).texels, bake_irradiance(scene).texels);
}

TEST(Voxels, AreHitWhereTheSurfaceIs) {
    const SceneVoxels voxels(room(glm::vec3(0.5f), glm::vec3(0)), 64);
    Random random(7);
    for (int i = 0; i < 500; ++i) {
        const glm::vec3 from{random.uniform(-1.8, 1.8), random.uniform(-1.8, 1.8), random.uniform(-1.8, 1.8)};
        const glm::vec3 direction =
            glm::normalize(glm::vec3(random.normal(), random.normal(), random.normal()));
        double expected = 1e9;
        for (int axis = 0; axis < 3; ++axis)
            expected =
                std::min(expected, ((direction[axis] > 0 ? 2.0 : -2.0) - from[axis]) / direction[axis]);
        const SceneVoxels::Hit hit = voxels.trace(from, direction);
        ASSERT_GE(hit.surface, 0);
        // Along a slanted ray a cell of the wall may be entered early, by its height over the cosine.
        EXPECT_LE(hit.distance_m, expected + 1e-3);
        const glm::vec3 entered = glm::abs(from + direction * hit.distance_m);
        EXPECT_GE(std::max(entered.x, std::max(entered.y, entered.z)), 2 - 1.6 * voxels.cell_m());
    }
}

TEST(LightGrid, ListsEveryLampThatReachesACellAndNoneThatIsFar) {
    Scene scene = room(glm::vec3(0.5f), glm::vec3(0));
    scene.instances[0].world_from_mesh = glm::mat4(8);
    scene.instances[0].world_from_mesh[3] = {0, 0, 0, 1};
    Random random(11);
    for (int i = 0; i < 60; ++i) {
        PunctualLight lamp;
        lamp.position = {random.uniform(-16, 16), random.uniform(0, 6), random.uniform(-16, 16)};
        lamp.range_m = i == 0 ? 0 : static_cast<float>(random.uniform(1, 9));
        scene.lights.push_back(lamp);
    }
    const LightGrid grid = make_light_grid(scene);
    for (int i = 0; i < 4000; ++i) {
        const glm::vec3 p{random.uniform(-16, 16), random.uniform(-16, 16), random.uniform(-16, 16)};
        const glm::ivec2 cell =
            glm::min(glm::ivec2((glm::vec2(p.x, p.z) - grid.low) / grid.cell_m), grid.size - 1);
        const std::uint64_t listed = grid.lights[static_cast<std::size_t>(cell.y * grid.size.x + cell.x)];
        for (std::size_t k = 0; k < scene.lights.size(); ++k) {
            const PunctualLight& lamp = scene.lights[k];
            const float across =
                glm::distance(glm::vec2(p.x, p.z), glm::vec2(lamp.position.x, lamp.position.z));
            const bool is_listed = listed >> k & 1;
            const bool reaches = lamp.range_m == 0 || glm::distance(p, lamp.position) < lamp.range_m;
            const bool far = lamp.range_m > 0 && across > lamp.range_m + 1.5f * glm::length(grid.cell_m);
            ASSERT_TRUE(is_listed || !reaches);
            ASSERT_FALSE(is_listed && far);
        }
    }
}

TEST(LightingBlock, HoldsTheSkysIrradianceForEveryNormal) {
    Scene scene;
    scene.sky = Sky{{0.2f, 0.4f, 0.9f}, {0.7f, 0.8f, 0.9f}, {0.3f, 0.2f, 0.1f}};
    const shared::Lighting block = lighting_block(scene);
    for (const glm::vec3 n :
         {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(0.48f, 0.6f, 0.64f)}) {
        // Integrate radiance times cosine over the sphere, in double.
        double expected = 0;
        const int rings = 400, sectors = 400;
        for (int i = 0; i < rings; ++i) {
            for (int j = 0; j < sectors; ++j) {
                const double y = -1 + 2 * (i + 0.5) / rings, r = std::sqrt(1 - y * y);
                const double a = 2 * std::numbers::pi * (j + 0.5) / sectors;
                const glm::vec3 d(r * std::cos(a), y, r * std::sin(a));
                expected += sky_radiance(scene.sky, d).y * std::max(glm::dot(d, n), 0.0f);
            }
        }
        expected *= 4 / static_cast<double>(rings * sectors);  // 4 pi over the count, over pi
        const double x = n.x, y = n.y, z = n.z;
        const double basis[9] = {1, y, z, x, x * y, y * z, 3 * z * z - 1, x * z, x * x - y * y};
        double sum = 0;
        for (int i = 0; i < 9; ++i) sum += block.ambient[i].y * basis[i];
        // Degree 2 leaves about 3 per cent (Ramamoorthi and Hanrahan 2001).
        EXPECT_NEAR(sum, expected, 0.03 * expected + 0.01);
    }
}

}  // namespace
}  // namespace parafovea
