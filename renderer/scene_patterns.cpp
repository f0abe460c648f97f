// Paints textures and derives their normal maps from heights.
#include "renderer/scene_patterns.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/all_processors.h"

namespace parafovea {
namespace {

int wrapped(int i, int period) {
    if (i >= 0 && i < period) return i;
    const int rest = i % period;
    return rest < 0 ? rest + period : rest;
}

int floor_of(float x) {
    const int truncated = static_cast<int>(x);
    return x < static_cast<float>(truncated) ? truncated - 1 : truncated;
}

float blend(float a, float b, float t) {
    return a + (b - a) * t;
}

float smooth(float t) {
    return t * t * t * (t * (6 * t - 15) + 10);
}

std::uint8_t byte_of(float x) {
    return static_cast<std::uint8_t>(255 * std::clamp(x, 0.0f, 1.0f) + 0.5f);
}

}  // namespace

float lattice_noise(int x, int y, std::uint32_t seed) {
    // Integer mixing: multiply and fold, twice.
    std::uint32_t h = static_cast<std::uint32_t>(x) * 0x8da6b343u ^
                      static_cast<std::uint32_t>(y) * 0xd8163841u ^ (seed + 1) * 0xcb1ab31fu;
    h ^= h >> 15;
    h *= 0x2c1b3c6du;
    h ^= h >> 12;
    h *= 0x297a2d39u;
    h ^= h >> 15;
    return static_cast<float>(h >> 8) * (1.0f / 16777216.0f);
}

float value_noise(float x, float y, int period, std::uint32_t seed) {
    const int ix = floor_of(x), iy = floor_of(y);
    const float tx = smooth(x - static_cast<float>(ix)), ty = smooth(y - static_cast<float>(iy));
    const int x0 = wrapped(ix, period), x1 = x0 + 1 == period ? 0 : x0 + 1;
    const int y0 = wrapped(iy, period), y1 = y0 + 1 == period ? 0 : y0 + 1;
    const float low = blend(lattice_noise(x0, y0, seed), lattice_noise(x1, y0, seed), tx);
    const float high = blend(lattice_noise(x0, y1, seed), lattice_noise(x1, y1, seed), tx);
    return blend(low, high, ty);
}

float fractal_noise(float x, float y, int period, int octaves, std::uint32_t seed) {
    float sum = 0, weight = 0, strength = 1;
    for (int i = 0; i < octaves; ++i) {
        sum += strength * value_noise(x, y, period, seed + static_cast<std::uint32_t>(i));
        weight += strength;
        strength *= 0.5f;
        x *= 2;
        y *= 2;
        period *= 2;
    }
    return sum / weight;
}

CellDistance cellular_noise(float x, float y, int period, std::uint32_t seed) {
    const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
    CellDistance result{1e9f, 1e9f, 0, 0};
    for (int j = iy - 1; j <= iy + 1; ++j) {
        for (int i = ix - 1; i <= ix + 1; ++i) {
            const int wx = wrapped(i, period), wy = wrapped(j, period);
            const float dx = static_cast<float>(i) + 0.15f + 0.7f * lattice_noise(wx, wy, seed) - x;
            const float dy = static_cast<float>(j) + 0.15f + 0.7f * lattice_noise(wx, wy, seed + 77) - y;
            const float d = std::sqrt(dx * dx + dy * dy);
            if (d < result.nearest) {
                result.second = result.nearest;
                result.nearest = d;
                result.cell_x = wx;
                result.cell_y = wy;
            } else {
                result.second = std::min(result.second, d);
            }
        }
    }
    return result;
}

std::uint8_t srgb_byte(float linear) {
    const float x = std::clamp(linear, 0.0f, 1.0f);
    return byte_of(x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f);
}

PaintedMaterial add_painted_material(Scene& scene, const std::string& name, int size, float extent_m,
                                     const std::function<Paint(float u, float v)>& paint) {
    const auto texels = static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
    SceneImage color{name + " colour", size, size, std::vector<std::uint8_t>(4 * texels, 255)};
    SceneImage normal{name + " normal", size, size, std::vector<std::uint8_t>(4 * texels, 255)};
    SceneImage rough{name + " metal and roughness", size, size, std::vector<std::uint8_t>(4 * texels, 255)};
    std::vector<float> height(texels);

    on_all_processors(size, [&](int y) {
        for (int x = 0; x < size; ++x) {
            const float scale = 1 / static_cast<float>(size);
            const Paint p =
                paint((static_cast<float>(x) + 0.5f) * scale, (static_cast<float>(y) + 0.5f) * scale);
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
            for (int c = 0; c < 3; ++c)
                color.rgba[4 * i + static_cast<std::size_t>(c)] = srgb_byte(p.color[c]);
            rough.rgba[4 * i + 1] = byte_of(p.roughness);
            rough.rgba[4 * i + 2] = byte_of(p.metallic);
            height[i] = p.height_m;
        }
    });

    // Slopes of the height, u to the right and v downwards; the map's green points up.
    const float per_m = static_cast<float>(size) / (2 * extent_m);
    const auto height_at = [&](int x, int y) {
        return height[static_cast<std::size_t>(wrapped(y, size)) * static_cast<std::size_t>(size) +
                      static_cast<std::size_t>(wrapped(x, size))];
    };
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const float slope_u = (height_at(x + 1, y) - height_at(x - 1, y)) * per_m;
            const float slope_v = (height_at(x, y + 1) - height_at(x, y - 1)) * per_m;
            const glm::vec3 n = glm::normalize(glm::vec3(-slope_u, slope_v, 1));
            const std::size_t i =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(size) + static_cast<std::size_t>(x);
            for (int c = 0; c < 3; ++c)
                normal.rgba[4 * i + static_cast<std::size_t>(c)] = byte_of(0.5f + 0.5f * n[c]);
        }
    }

    Material material;
    material.name = name;
    TextureSlot* slots[] = {&material.base_color_texture, &material.normal_texture,
                            &material.metallic_roughness_texture};
    std::array<SceneImage*, 3> images{&color, &normal, &rough};
    for (std::size_t i = 0; i < images.size(); ++i) {
        scene.textures.push_back({static_cast<int>(scene.images.size()), i == 0});
        scene.images.push_back(std::move(*images[i]));
        slots[i]->texture = static_cast<int>(scene.textures.size()) - 1;
    }
    scene.materials.push_back(material);
    return {static_cast<int>(scene.materials.size()) - 1, 1 / extent_m};
}

int append_painted(Scene& scene, Triangles mesh, const PaintedMaterial& paint) {
    for (SceneVertex& v : mesh.vertices) v.uv *= paint.repeats_per_m;
    make_tangents(mesh);
    return append_mesh(scene, mesh, paint.material);
}

}  // namespace parafovea
