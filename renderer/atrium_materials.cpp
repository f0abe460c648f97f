// Paints stone, brick, tiles, cloth, wood and glaze.
#include "renderer/atrium_materials.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace parafovea {
namespace {

float fraction(float x) {
    return x - std::floor(x);
}

float step_between(float low, float high, float x) {
    const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
    return t * t * (3 - 2 * t);
}

// Distance from the border of a cell, for coordinates in [0, 1) of the cell.
float from_border(float x, float y) {
    return std::min(std::min(x, 1 - x), std::min(y, 1 - y));
}

glm::vec3 marble(float u, float v, int period, std::uint32_t seed, glm::vec3 ground, glm::vec3 vein) {
    const auto scale = static_cast<float>(period);
    const float warp = fractal_noise(u * scale, v * scale, period, 3, seed);
    const float warp2 = fractal_noise(u * scale, v * scale, period, 2, seed + 9);
    const float band =
        std::abs(2 * fractal_noise(u * scale + 3 * warp, v * scale + 3 * warp2, period, 4, seed + 20) - 1);
    const float strength = std::pow(1 - std::min(band * 2.2f, 1.0f), 3.0f);
    const float cloud = fractal_noise(u * scale, v * scale, period, 2, seed + 40);
    return glm::mix(ground * (0.75f + 0.5f * cloud), vein, 0.8f * strength);
}

// Squares set on edge between octagons, eight to the texture.
Paint paving(float u, float v) {
    constexpr int kTiles = 4;
    const float x = u * kTiles, y = v * kTiles;
    const float fx = std::abs(fraction(x) - 0.5f), fy = std::abs(fraction(y) - 0.5f);
    const float corner = 1 - fx - fy;  // distance from the lattice corner, in its diamond
    const bool diamond = corner < 0.29f;
    const float joint =
        std::min(std::min(0.5f - fx, 0.5f - fy) * (diamond ? 9.0f : 1.0f), std::abs(corner - 0.29f) * 0.7f);
    const float groove = step_between(0.006f, 0.018f, joint);
    const int cx = static_cast<int>(diamond ? x + 0.5f : x) % kTiles,
              cy = static_cast<int>(diamond ? y + 0.5f : y) % kTiles;
    const float tone = lattice_noise(cx, cy, diamond ? 5u : 6u);
    glm::vec3 color = diamond ? marble(u, v, 8, 300, {0.055f, 0.07f, 0.065f}, {0.35f, 0.36f, 0.32f})
                      : (cx + cy) % 2 == 0
                          ? marble(u, v, 8, 100, {0.58f, 0.50f, 0.40f}, {0.30f, 0.22f, 0.16f})
                          : marble(u, v, 8, 200, {0.42f, 0.16f, 0.10f}, {0.62f, 0.48f, 0.40f});
    color *= 0.8f + 0.4f * tone;
    // Inlaid rosette in every light octagon.
    if (!diamond && (cx + cy) % 2 == 0) {
        const float radius = std::hypot(fraction(x) - 0.5f, fraction(y) - 0.5f);
        const float angle = std::atan2(fraction(y) - 0.5f, fraction(x) - 0.5f);
        const float petal = 0.20f + 0.06f * std::cos(8 * angle);
        if (radius < petal && radius > petal - 0.035f) color = glm::vec3(0.08f, 0.10f, 0.14f);
        if (radius < 0.07f) color = glm::vec3(0.36f, 0.10f, 0.06f);
    }
    const float wear = fractal_noise(u * 16, v * 16, 16, 4, 400);
    Paint p;
    p.color = glm::mix(glm::vec3(0.12f, 0.11f, 0.10f), color, groove);
    p.height_m = 0.004f * groove + 0.0006f * wear + 0.0012f * tone;
    p.roughness = std::lerp(0.85f, 0.22f + 0.25f * wear, groove);
    return p;
}

Paint brick(float u, float v) {
    constexpr int kColumns = 8, kRows = 24;
    const float y = v * kRows;
    const int row = static_cast<int>(y);
    const float x = u * kColumns + (row % 2) * 0.5f;
    const int column = static_cast<int>(x) % kColumns;
    const float wobble = 0.02f * (fractal_noise(u * 64, v * 64, 64, 2, 11) - 0.5f);
    const float dx = std::min(fraction(x), 1 - fraction(x)) * (2.0f / kColumns),
                dy = std::min(fraction(y), 1 - fraction(y)) * (2.0f / kRows);
    const float edge = std::min(dx, dy) + wobble;
    const float body = step_between(0.004f, 0.014f, edge);
    const float tone = lattice_noise(column, row, 21);
    const float grain = fractal_noise(u * 96, v * 96, 96, 3, 31);
    const float stain = fractal_noise(u * 4, v * 4, 4, 3, 41);
    glm::vec3 clay = glm::mix(glm::vec3(0.24f, 0.085f, 0.05f), glm::vec3(0.52f, 0.23f, 0.12f), tone);
    if (tone > 0.88f) clay = glm::vec3(0.13f, 0.075f, 0.065f);
    clay *= (0.7f + 0.6f * grain) * (0.7f + 0.6f * stain);
    Paint p;
    p.color = glm::mix(glm::vec3(0.42f, 0.38f, 0.32f) * (0.7f + 0.5f * grain), clay, body);
    p.height_m = 0.010f * body * (0.7f + 0.3f * tone) + 0.004f * grain;
    p.roughness = std::lerp(0.95f, 0.72f + 0.2f * grain, body);
    return p;
}

Paint stone(float u, float v) {
    const float grain = fractal_noise(u * 128, v * 128, 128, 3, 51);
    const float cloud = fractal_noise(u * 5, v * 5, 5, 5, 61);
    const CellDistance pits = cellular_noise(u * 40, v * 40, 40, 71);
    const float pit = step_between(0.10f, 0.24f, pits.nearest + 0.35f * (1 - cloud));
    const float layer = 0.5f + 0.5f * std::sin(2 * std::numbers::pi_v<float> * (7 * v + 1.4f * cloud));
    Paint p;
    p.color = glm::mix(glm::vec3(0.46f, 0.38f, 0.28f), glm::vec3(0.68f, 0.62f, 0.52f),
                       0.65f * cloud + 0.35f * layer * cloud);
    p.color *= (0.78f + 0.3f * grain) * (0.72f + 0.28f * pit);
    p.height_m = 0.003f * pit + 0.0022f * grain + 0.002f * cloud;
    p.roughness = 0.62f + 0.3f * (1 - pit * cloud);
    return p;
}

// A running key pattern between two fillets.
Paint frieze(float u, float v) {
    Paint p = stone(u, v);
    constexpr int kKeys = 4;
    const float x = fraction(u * kKeys) * 8, y = v * 8;
    const int cx = static_cast<int>(x), cy = static_cast<int>(y);
    static constexpr const char* kKey[8] = {"11111111", "00000000", "11111101", "10000101",
                                            "10110101", "10111101", "10000001", "11111111"};
    const auto raised = [&](int i, int j) {
        return kKey[((j % 8) + 8) % 8][((i % 8) + 8) % 8] == '1' ? 1.0f : 0.0f;
    };
    const float tx = x - static_cast<float>(cx), ty = y - static_cast<float>(cy);
    const float edge_x = tx < 0.5f ? raised(cx - 1, cy) : raised(cx + 1, cy),
                edge_y = ty < 0.5f ? raised(cx, cy - 1) : raised(cx, cy + 1);
    const float own = raised(cx, cy);
    const float near_x = step_between(0.0f, 0.18f, std::min(tx, 1 - tx)),
                near_y = step_between(0.0f, 0.18f, std::min(ty, 1 - ty));
    const float level = own * std::min(std::max(near_x, edge_x), std::max(near_y, edge_y));
    p.height_m = 0.35f * p.height_m + 0.02f * level;
    p.color *= 0.45f + 0.55f * level;
    if (own < 0.5f) p.color *= glm::vec3(0.65f, 0.45f, 0.40f);
    return p;
}

Paint wood(float u, float v) {
    const float warp = fractal_noise(u * 3, v * 12, 12, 4, 81);
    const float ring = fraction(v * 14 + 2.2f * warp);
    const float fibre = fractal_noise(u * 8, v * 160, 160, 3, 91);
    Paint p;
    p.color = glm::mix(glm::vec3(0.11f, 0.055f, 0.026f), glm::vec3(0.26f, 0.14f, 0.068f),
                       ring * 0.6f + 0.4f * fibre);
    const float plank = std::min(fraction(v * 4), 1 - fraction(v * 4));
    const float gap = step_between(0.01f, 0.035f, plank);
    p.color *= 0.3f + 0.7f * gap;
    p.height_m = 0.006f * gap + 0.0015f * fibre;
    p.roughness = 0.55f + 0.3f * fibre;
    return p;
}

// Blue and white glaze with a band of scrolls.
Paint glazed(float u, float v) {
    const float crackle =
        cellular_noise(u * 18, v * 18, 18, 101).second - cellular_noise(u * 18, v * 18, 18, 101).nearest;
    const float wave = 0.5f + 0.22f * std::sin(2 * std::numbers::pi_v<float> * 6 * u);
    const float curl = std::abs(fraction(v * 3) - wave);
    const float line = 1 - step_between(0.02f, 0.05f, std::abs(curl - 0.1f));
    const CellDistance dots = cellular_noise(u * 10, v * 10, 10, 111);
    const float dot = 1 - step_between(0.16f, 0.2f, dots.nearest);
    const float ink = std::max(line, 0.8f * dot);
    Paint p;
    p.color = glm::mix(glm::vec3(0.70f, 0.70f, 0.66f), glm::vec3(0.02f, 0.06f, 0.28f), ink);
    p.color *= 0.85f + 0.15f * step_between(0.0f, 0.05f, crackle);
    p.height_m = 0.0008f * step_between(0.0f, 0.06f, crackle);
    p.roughness = 0.12f + 0.1f * ink;
    return p;
}

Paint bronze(float u, float v) {
    const float patina = fractal_noise(u * 6, v * 6, 6, 5, 121);
    const float hammer = cellular_noise(u * 24, v * 24, 24, 131).nearest;
    const float green = step_between(0.52f, 0.68f, patina);
    Paint p;
    p.color = glm::mix(glm::vec3(0.60f, 0.38f, 0.18f), glm::vec3(0.14f, 0.30f, 0.24f), green);
    p.metallic = 1 - green;
    p.roughness = 0.28f + 0.5f * green;
    p.height_m = 0.004f * hammer;
    return p;
}

// Damask: a stylised leaf in two weaves of one colour, with threads.
Paint cloth(float u, float v, glm::vec3 dark, glm::vec3 light) {
    const float x = fraction(u * 3), y0 = v * 3;
    const float y = fraction(y0 + 0.5f * static_cast<float>(static_cast<int>(u * 3) % 2));
    const float dx = std::abs(x - 0.5f), dy = y - 0.5f;
    const float leaf = 0.32f * std::cos(std::numbers::pi_v<float> * dy) - dx * (1 + 0.5f * std::sin(30 * dy));
    const float vein = std::abs(fraction((dy + 0.8f * dx) * 9) - 0.5f);
    const float figure =
        step_between(0.0f, 0.02f, leaf) * (leaf > 0.06f ? step_between(0.06f, 0.14f, vein) : 1.0f);
    const float diamond = from_border(x, y) < 0.03f ? 1.0f : 0.0f;
    const float weave = std::max(figure, diamond);
    const float warp = std::sin(2 * std::numbers::pi_v<float> * 128 * u),
                weft = std::sin(2 * std::numbers::pi_v<float> * 128 * v);
    const float fuzz = fractal_noise(u * 64, v * 64, 64, 3, 141);
    Paint p;
    p.color = glm::mix(dark, light, weave) * (0.75f + 0.5f * fuzz);
    p.height_m = 0.0012f * weave + 0.0005f * (0.5f + 0.25f * (weave > 0.5f ? warp : weft)) + 0.0006f * fuzz;
    p.roughness = std::lerp(0.9f, 0.5f, weave);
    return p;
}

}  // namespace

Paint paint_brick(float u, float v) {
    return brick(u, v);
}
Paint paint_stone(float u, float v) {
    return stone(u, v);
}
Paint paint_wood(float u, float v) {
    return wood(u, v);
}

AtriumMaterials add_atrium_materials(Scene& scene) {
    AtriumMaterials m;
    m.paving = add_painted_material(scene, "paving", 1024, 3.2f, paving);
    m.brick = add_painted_material(scene, "brick", 1024, 2.0f, brick);
    m.stone = add_painted_material(scene, "stone", 512, 1.5f, stone);
    m.frieze = add_painted_material(scene, "frieze", 256, 0.6f, frieze);
    m.wood = add_painted_material(scene, "wood", 256, 1.2f, wood);
    m.glazed = add_painted_material(scene, "glazed", 512, 1.0f, glazed);
    m.bronze = add_painted_material(scene, "bronze", 256, 0.5f, bronze);
    const glm::vec3 dark[3] = {{0.30f, 0.012f, 0.018f}, {0.015f, 0.12f, 0.055f}, {0.018f, 0.04f, 0.20f}};
    const glm::vec3 light[3] = {{0.62f, 0.34f, 0.10f}, {0.50f, 0.46f, 0.18f}, {0.55f, 0.50f, 0.40f}};
    for (int i = 0; i < 3; ++i) {
        m.cloth[i] = add_painted_material(scene, "cloth " + std::to_string(i + 1), 512, 0.9f,
                                          [&](float u, float v) { return cloth(u, v, dark[i], light[i]); });
        scene.materials[static_cast<std::size_t>(m.cloth[i].material)].double_sided = true;
    }
    return m;
}

}  // namespace parafovea
