// Paints wet stone, plaster, iron, leaves, awnings and windows.
#include "renderer/street_materials.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "renderer/atrium_materials.h"

namespace parafovea {
namespace {

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

float fraction(float x) {
    return x - std::floor(x);
}

float step_between(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

// Water lies where the noise is high: smooth and dark.
void make_wet(Paint& p, float u, float v, float share) {
    const float water = step_between(0.62f - share, 0.80f - share, fractal_noise(u * 4, v * 4, 4, 4, 7));
    p.color *= 0.55f - 0.2f * water;
    p.roughness = std::lerp(0.42f * p.roughness + 0.06f, 0.07f, water);
    p.height_m *= 1 - 0.85f * water;
}

Paint cobble(float u, float v) {
    const float grain = fractal_noise(u * 48, v * 48, 48, 4, 11);
    const float tone = fractal_noise(u * 6, v * 6, 6, 3, 12);
    Paint p;
    p.color =
        glm::mix(glm::vec3(0.13f, 0.125f, 0.12f), glm::vec3(0.30f, 0.28f, 0.26f), 0.6f * tone + 0.4f * grain);
    p.height_m = 0.003f * grain;
    p.roughness = 0.55f + 0.3f * grain;
    make_wet(p, u, v, 0.12f);
    return p;
}

Paint slabs(float u, float v) {
    constexpr int kRows = 4;
    const float y = v * kRows, x = u * 2 + 0.37f * static_cast<float>(static_cast<int>(y));
    const float joint = std::min(std::min(fraction(x), 1 - fraction(x)) * 1.2f,
                                 std::min(fraction(y), 1 - fraction(y)) * 0.6f);
    const float body = step_between(0.005f, 0.02f, joint);
    const float tone = lattice_noise(static_cast<int>(x) % 2, static_cast<int>(y) % kRows, 21);
    const float grain = fractal_noise(u * 64, v * 64, 64, 3, 22);
    Paint p;
    p.color = glm::mix(glm::vec3(0.07f),
                       glm::vec3(0.34f, 0.32f, 0.29f) * (0.7f + 0.4f * tone) * (0.7f + 0.5f * grain), body);
    p.height_m = 0.008f * body + 0.002f * grain;
    p.roughness = 0.6f + 0.25f * grain;
    make_wet(p, u, v, 0.06f);
    return p;
}

Paint plaster(float u, float v, glm::vec3 color) {
    const float patch = fractal_noise(u * 3, v * 3, 3, 5, 31);
    const float grain = fractal_noise(u * 80, v * 80, 80, 3, 32);
    const CellDistance cracks = cellular_noise(u * 5, v * 5, 5, 33);
    const float crack = 1 - step_between(0.0f, 0.02f, cracks.second - cracks.nearest);
    const float bare = step_between(0.66f, 0.70f, patch);
    Paint p;
    p.color =
        glm::mix(color * (0.6f + 0.6f * patch), glm::vec3(0.34f, 0.20f, 0.14f), bare) * (0.8f + 0.3f * grain);
    p.color *= 1 - 0.5f * crack * (1 - bare);
    p.height_m = 0.004f * (1 - bare) + 0.002f * grain - 0.003f * crack;
    p.roughness = 0.85f;
    return p;
}

Paint iron(float u, float v) {
    const float rust = step_between(0.58f, 0.75f, fractal_noise(u * 8, v * 8, 8, 4, 41));
    const float grain = fractal_noise(u * 48, v * 48, 48, 3, 42);
    Paint p;
    p.color = glm::mix(glm::vec3(0.020f, 0.028f, 0.026f), glm::vec3(0.16f, 0.065f, 0.03f), rust);
    p.roughness = 0.30f + 0.4f * rust + 0.1f * grain;
    p.height_m = 0.0008f * grain;
    return p;
}

Paint leaf(float u, float v) {
    const float rib = std::abs(u - 0.5f), side = std::abs(fraction(10 * (v + rib)) - 0.5f);
    const float vein =
        std::max(1 - step_between(0.0f, 0.03f, rib), 0.5f * (1 - step_between(0.0f, 0.1f, side)));
    const float tone = fractal_noise(u * 6, v * 6, 6, 3, 51);
    Paint p;
    p.color =
        glm::mix(glm::vec3(0.035f, 0.10f, 0.02f), glm::vec3(0.16f, 0.26f, 0.06f), 0.6f * tone + 0.5f * vein);
    p.roughness = 0.38f;
    p.height_m = -0.004f * vein;
    return p;
}

Paint awning(float u, float v, glm::vec3 color) {
    const bool light = fraction(u * 4) < 0.5f;
    const float weave = 0.5f + 0.25f * std::sin(kTurn * 64 * u) + 0.25f * std::sin(kTurn * 64 * v);
    Paint p;
    p.color = (light ? glm::vec3(0.62f, 0.58f, 0.48f) : color) * (0.75f + 0.3f * weave) *
              (0.75f + 0.4f * fractal_noise(u * 4, v * 4, 4, 4, 61));
    p.roughness = 0.8f;
    p.height_m = 0.0008f * weave;
    return p;
}

// Curtains, and the shapes of a room behind them.
Paint window_light(float u, float v, bool warm) {
    const float pane_x = fraction(2 * u), pane_y = fraction(3 * v);
    const float bar = std::min(std::min(pane_x, 1 - pane_x), std::min(pane_y, 1 - pane_y));
    const float curtain = u < 0.3f || u > 0.7f ? 0.35f + 0.2f * std::sin(kTurn * 14 * u) : 1.0f;
    const float shapes =
        0.45f + 0.55f * step_between(0.35f, 0.6f, fractal_noise(u * 5, v * 5, 5, 2, warm ? 71 : 72));
    const glm::vec3 light = warm ? glm::vec3(1.0f, 0.56f, 0.22f) : glm::vec3(1.0f, 0.74f, 0.45f);
    Paint p;
    p.color = light * (curtain * shapes * (1 - 0.3f * v)) * step_between(0.02f, 0.03f, bar);
    p.roughness = 0.1f;
    return p;
}

Paint goods(float u, float v) {
    const float shelf = fraction(v * 4);
    const int row = static_cast<int>(v * 4), item = static_cast<int>(u * 24);
    const float height = 0.3f + 0.6f * lattice_noise(item, row, 81);
    const float across = std::abs(fraction(u * 24) - 0.5f);
    const bool there = shelf > 1 - height && across < 0.42f && shelf < 0.94f;
    const glm::vec3 hue{lattice_noise(item, row, 82), lattice_noise(item, row, 83),
                        lattice_noise(item, row, 84)};
    const bool label = there && shelf > 0.62f && shelf < 0.82f;
    Paint p;
    p.color = shelf > 0.94f ? glm::vec3(0.22f, 0.12f, 0.06f)
              : label       ? glm::vec3(0.75f, 0.70f, 0.58f)
              : there       ? glm::mix(hue * hue, glm::vec3(0.25f, 0.16f, 0.08f), 0.55f) * 0.7f
                            : glm::vec3(0.10f, 0.06f, 0.04f);
    p.roughness = there ? 0.25f : 0.8f;
    p.height_m = there ? 0.03f * std::cos(2 * across) : 0;
    return p;
}

PaintedMaterial plain(Scene& scene, const std::string& name, glm::vec4 color, float roughness) {
    Material m;
    m.name = name;
    m.base_color = color;
    m.metallic = 0;
    m.roughness = roughness;
    scene.materials.push_back(m);
    return {static_cast<int>(scene.materials.size()) - 1, 1};
}

}  // namespace

StreetMaterials add_street_materials(Scene& scene) {
    StreetMaterials m;
    const auto material = [&](const PaintedMaterial& paint) -> Material& {
        return scene.materials[static_cast<std::size_t>(paint.material)];
    };
    m.cobble = add_painted_material(scene, "wet cobbles", 512, 1.4f, cobble);
    m.slabs = add_painted_material(scene, "wet slabs", 512, 2.4f, slabs);
    m.brick = add_painted_material(scene, "brick", 512, 2.0f, paint_brick);
    m.stone = add_painted_material(scene, "stone", 512, 1.5f, paint_stone);
    const glm::vec3 colors[3] = {{0.52f, 0.40f, 0.24f}, {0.46f, 0.26f, 0.20f}, {0.36f, 0.38f, 0.36f}};
    for (int i = 0; i < 3; ++i)
        m.plaster[i] = add_painted_material(scene, "plaster " + std::to_string(i + 1), 512, 3.0f,
                                            [&](float u, float v) { return plaster(u, v, colors[i]); });
    m.wood = add_painted_material(scene, "wood", 256, 1.2f, paint_wood);
    m.iron = add_painted_material(scene, "iron", 256, 0.6f, iron);
    m.leaf = add_painted_material(scene, "leaf", 128, 1, leaf);
    material(m.leaf).double_sided = true;
    for (int i = 0; i < 2; ++i) {
        const glm::vec3 color = i == 0 ? glm::vec3(0.42f, 0.03f, 0.03f) : glm::vec3(0.03f, 0.16f, 0.10f);
        m.awning[i] = add_painted_material(scene, "awning " + std::to_string(i + 1), 256, 0.8f,
                                           [&](float u, float v) { return awning(u, v, color); });
        material(m.awning[i]).double_sided = true;
        m.lit_window[i] = add_painted_material(scene, "lit window " + std::to_string(i + 1), 256, 1,
                                               [&](float u, float v) { return window_light(u, v, i == 0); });
        Material& lit = material(m.lit_window[i]);
        lit.emissive_texture = lit.base_color_texture;
        lit.emissive = glm::vec3(1.6f);
        lit.base_color = {0.1f, 0.1f, 0.1f, 1};
    }
    m.goods = add_painted_material(scene, "goods", 512, 1.6f, goods);
    m.dark_window = plain(scene, "dark window", {0.012f, 0.015f, 0.022f, 1}, 0.06f);
    m.bulb = plain(scene, "bulb", {0.8f, 0.8f, 0.8f, 1}, 0.4f);
    material(m.bulb).emissive = {26, 17, 8};
    m.glass = plain(scene, "glass", {0.9f, 1, 0.95f, 0.10f}, 0.03f);
    material(m.glass).alpha_mode = AlphaMode::blend;
    m.bottle = plain(scene, "bottle", {0.35f, 0.62f, 0.38f, 1}, 0.04f);
    material(m.bottle).transmission = 0.92f;
    return m;
}

}  // namespace parafovea
