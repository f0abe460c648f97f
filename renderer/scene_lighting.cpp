// Projects the sky on spherical harmonics and packs the lights.
#include "renderer/scene_lighting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace parafovea {
namespace {

shared::vec4 packed(glm::vec3 v, float w = 0) {
    return {v.x, v.y, v.z, w};
}

// Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps": the nine
// coefficients of irradiance / pi, each times its basis function's constant, in the order that
// ambient_light() adds them.
std::array<glm::vec3, 9> ambient_coefficients(const Sky& sky) {
    constexpr int kRings = 64, kSectors = 16;
    std::array<glm::vec3, 9> sums{};
    constexpr float kDegree0 = 0.282095f, kDegree1 = 0.488603f, kDegree2 = 1.092548f, kZonal2 = 0.315392f,
                    kSquare2 = 0.546274f;
    for (int ring = 0; ring < kRings; ++ring) {
        const float y = -1 + 2 * (static_cast<float>(ring) + 0.5f) / kRings;
        const float across = std::sqrt(1 - y * y);
        for (int sector = 0; sector < kSectors; ++sector) {
            const float angle =
                2 * std::numbers::pi_v<float> * (static_cast<float>(sector) + 0.5f) / kSectors;
            const glm::vec3 d{across * std::cos(angle), y, across * std::sin(angle)};
            const glm::vec3 light =
                sky_radiance(sky, d) * (4 * std::numbers::pi_v<float> / (kRings * kSectors));
            const std::array<float, 9> basis{kDegree0,
                                             kDegree1 * d.y,
                                             kDegree1 * d.z,
                                             kDegree1 * d.x,
                                             kDegree2 * d.x * d.y,
                                             kDegree2 * d.y * d.z,
                                             kZonal2 * (3 * d.z * d.z - 1),
                                             kDegree2 * d.x * d.z,
                                             kSquare2 * (d.x * d.x - d.y * d.y)};
            for (int i = 0; i < 9; ++i) sums[i] += light * basis[i];
        }
    }
    // The cosine lobe's share of each degree, over pi, and the basis constants of the sum in the shader.
    const std::array<float, 9> weights{kDegree0,         kDegree1 * 2 / 3, kDegree1 * 2 / 3,
                                       kDegree1 * 2 / 3, kDegree2 / 4,     kDegree2 / 4,
                                       kZonal2 / 4,      kDegree2 / 4,     kSquare2 / 4};
    for (int i = 0; i < 9; ++i) sums[i] *= weights[i];
    return sums;
}

shared::LightRecord light_record(const PunctualLight& light) {
    shared::LightRecord record{};
    const bool spot = light.kind == LightKind::spot;
    record.position = packed(light.position, light.range_m > 0 ? 1 / (light.range_m * light.range_m) : 0);
    record.intensity = packed(light.intensity, spot ? 1.0f : 0.0f);
    // KHR_lights_punctual's recommended cone: smooth from the inner to the outer angle.
    const float outer = std::cos(light.outer_cone_rad);
    const float scale = 1 / std::max(std::cos(light.inner_cone_rad) - outer, 1e-3f);
    record.direction = packed(light.direction, spot ? -outer * scale : 1);
    record.cone = {spot ? scale : 0, -1, 0, 0};
    return record;
}

}  // namespace

glm::vec3 sky_radiance(const Sky& sky, glm::vec3 direction) {
    const float up = std::clamp(direction.y, 0.0f, 1.0f);
    const float haze = (1 - up) * (1 - up);
    const glm::vec3 above = glm::mix(sky.zenith, sky.horizon, haze * haze);
    return glm::mix(above, sky.ground, std::clamp(-direction.y * 12, 0.0f, 1.0f));
}

LightGrid make_light_grid(const Scene& scene) {
    constexpr float kCell_m = 0.75f;
    constexpr int kMostCells = 128;
    LightGrid grid;
    const Bounds bounds = world_bounds(scene);
    const glm::vec2 low{bounds.low.x, bounds.low.z}, extent = glm::vec2(bounds.high.x, bounds.high.z) - low;
    grid.low = low;
    grid.size = glm::clamp(glm::ivec2(glm::ceil(extent / kCell_m)), glm::ivec2(1), glm::ivec2(kMostCells));
    grid.cell_m = glm::max(extent / glm::vec2(grid.size), glm::vec2(1e-6f));
    for (int y = 0; y < grid.size.y; ++y) {
        for (int x = 0; x < grid.size.x; ++x) {
            const glm::vec2 cell_low = low + glm::vec2(x, y) * grid.cell_m,
                            cell_high = cell_low + grid.cell_m;
            std::uint64_t mask = 0;
            for (std::size_t i = 0; i < std::min<std::size_t>(scene.lights.size(), shared::kMaxLights); ++i) {
                const PunctualLight& light = scene.lights[i];
                const glm::vec2 at{light.position.x, light.position.z};
                const float distance = glm::distance(at, glm::clamp(at, cell_low, cell_high));
                if (light.range_m <= 0 || distance < light.range_m) mask |= std::uint64_t{1} << i;
            }
            grid.lights.push_back(mask);
        }
    }
    return grid;
}

shared::Lighting lighting_block(const Scene& scene) {
    shared::Lighting block{};
    const Sun sun = scene.sun.value_or(Sun{{0, 1, 0}, glm::vec3(0), false});
    block.sun_direction = packed(glm::normalize(sun.direction), scene.exposure);
    block.sun_irradiance = packed(sun.irradiance);
    block.sky_zenith = packed(scene.sky.zenith);
    block.sky_horizon = packed(scene.sky.horizon);
    block.sky_ground = packed(scene.sky.ground);
    const auto ambient = ambient_coefficients(scene.sky);
    for (int i = 0; i < 9; ++i) block.ambient[i] = packed(ambient[i]);
    const std::size_t count = std::min<std::size_t>(scene.lights.size(), shared::kMaxLights);
    for (std::size_t i = 0; i < count; ++i) block.lights[i] = light_record(scene.lights[i]);
    return block;
}

}  // namespace parafovea
