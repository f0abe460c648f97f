// Builds columns, arches, cloth, vases, balusters and lamps.
#include "renderer/atrium_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace parafovea {
namespace {

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

std::vector<glm::vec2> half_round(glm::vec2 low, glm::vec2 high, float bulge, int steps) {
    std::vector<glm::vec2> points;
    for (int i = 0; i <= steps; ++i) {
        const float t = static_cast<float>(i) / static_cast<float>(steps);
        points.push_back(glm::mix(low, high, t) + glm::vec2(bulge * std::sin(0.5f * kTurn * t), 0));
    }
    return points;
}

void add_leaf_capital(Triangles& mesh, float bottom, float height, float radius) {
    // Two rings of leaves on a bell, each leaf a bulge that curls outwards at its tip.
    add_surface(mesh, 64, 14, [=](float u, float v) {
        const float angle = kTurn * u;
        const float bell = radius * (1.0f + 0.30f * v * v);
        const float ring = v < 0.5f ? 0.0f : 1.0f;
        const float t = v < 0.5f ? 2 * v : 2 * v - 1;
        const float around = 8 * u + 0.5f * ring;
        const float across = std::abs(around - std::floor(around) - 0.5f) * 2;  // 0 on a leaf's spine
        const float blade = std::max(0.0f, 1 - across * across * (1 + 2 * t));
        const float curl = 0.17f * radius * std::pow(t, 3.0f) + 0.05f * radius;
        const float ribs = 0.012f * radius * std::cos(40 * across);
        const float r = bell + blade * (curl + ribs);
        return SurfacePoint{{r * std::sin(angle), bottom + height * v, r * std::cos(angle)},
                            {std::round(kTurn * radius) * u, -height * v}};
    });
}

}  // namespace

Triangles make_column(float height, float radius, int flutes) {
    Triangles mesh;
    const float plinth = 0.45f * radius, base = 0.7f * radius, capital = 1.5f * radius, slab = 0.35f * radius;
    const float shaft_from = plinth + base, shaft_to = height - capital - slab;
    add_box(mesh, {-1.45f * radius, 0, -1.45f * radius}, {1.45f * radius, plinth, 1.45f * radius});
    // Attic base: two rolls with a hollow between.
    const auto lower =
        half_round({1.28f * radius, plinth}, {1.28f * radius, plinth + 0.4f * base}, 0.16f * radius, 6);
    const auto hollow = half_round({1.24f * radius, plinth + 0.4f * base},
                                   {1.12f * radius, plinth + 0.7f * base}, -0.08f * radius, 5);
    const auto upper =
        half_round({1.1f * radius, plinth + 0.7f * base}, {1.06f * radius, shaft_from}, 0.1f * radius, 5);
    for (const auto* roll : {&lower, &hollow, &upper}) add_lathe(mesh, *roll, 32, true);
    // The shaft swells a little and is cut by flutes.
    const int columns = flutes * 3;
    add_surface(mesh, columns, 8, [=](float u, float v) {
        const float angle = kTurn * u;
        const float swell = radius * (1 - 0.16f * v * v);
        const float flute =
            0.055f * std::pow(std::abs(std::sin(0.5f * kTurn * static_cast<float>(flutes) * u)), 0.8f);
        const float fade = std::clamp(std::min(v, 1 - v) * 16, 0.0f, 1.0f);
        const float r = swell * (1 - flute * fade);
        return SurfacePoint{{r * std::sin(angle), std::lerp(shaft_from, shaft_to, v), r * std::cos(angle)},
                            {std::round(kTurn * radius) * u, -(shaft_to - shaft_from) * v}};
    });
    add_lathe(
        mesh,
        half_round({0.86f * radius, shaft_to - 0.12f * radius}, {0.86f * radius, shaft_to}, 0.1f * radius, 4),
        32, true);
    add_leaf_capital(mesh, shaft_to, capital, 0.86f * radius);
    const float half = 1.32f * radius;
    add_box(mesh, {-half, height - slab, -half}, {half, height, half});
    return mesh;
}

ArchBay make_arch_bay(float width, float radius, float rise, float thickness) {
    ArchBay bay;
    const float half = width / 2, ring = 0.22f * radius;
    const float outer = radius + ring;
    // From the ring's outside to the frame: angles that hit the frame's corners come at the ends of the three
    // stretches.
    const float corner = std::atan2(rise, half);
    const std::array<std::pair<float, float>, 3> stretches{
        {{0, corner}, {corner, kTurn / 2 - corner}, {kTurn / 2 - corner, kTurn / 2}}};
    const auto frame = [=](float angle) {
        const float c = std::cos(angle), s = std::sin(angle);
        const float reach =
            std::min(std::abs(c) > 1e-5f ? half / std::abs(c) : 1e9f, s > 1e-5f ? rise / s : 1e9f);
        return glm::vec2(c, s) * reach;
    };
    for (float side : {1.0f, -1.0f}) {
        const float z = side * thickness / 2;
        for (const auto& [from, to] : stretches)
            add_surface(bay.wall, 10, 3, [=](float u, float v) {
                const float angle = side > 0 ? std::lerp(to, from, u) : std::lerp(from, to, u);
                const glm::vec2 inner = glm::vec2(std::cos(angle), std::sin(angle)) * outer;
                const glm::vec2 p = glm::mix(inner, frame(angle), v);
                return SurfacePoint{{p.x, p.y, z}, {side * p.x, -p.y}};
            });
        // The ring stands out in two steps; its joints follow the texture.
        const float profile[4][2] = {{0, 0.05f}, {0.45f, 0.05f}, {0.55f, 0.025f}, {1, 0.025f}};
        for (int i = 0; i < 3; ++i)
            add_surface(bay.trim, 32, 1, [=](float u, float v) {
                const float angle = 0.5f * kTurn * (side > 0 ? 1 - u : u);
                const float across = std::lerp(profile[i][0], profile[i + 1][0], v);
                const float out = std::lerp(profile[i][1], profile[i + 1][1], v);
                const float r = radius + ring * across;
                return SurfacePoint{{r * std::cos(angle), r * std::sin(angle), z + side * out},
                                    {0.5f * kTurn * radius * u, -ring * across}};
            });
        add_surface(bay.trim, 32, 1, [=](float u, float v) {
            const float angle = 0.5f * kTurn * (side > 0 ? 1 - u : u);
            return SurfacePoint{
                {outer * std::cos(angle), outer * std::sin(angle), z + side * 0.025f * (1 - v)},
                {0.5f * kTurn * radius * u, -0.025f * v}};
        });
    }
    add_surface(bay.trim, 32, 2, [=](float u, float v) {
        const float angle = 0.5f * kTurn * u;
        return SurfacePoint{
            {radius * std::cos(angle), radius * std::sin(angle), (0.5f - v) * (thickness + 0.1f)},
            {0.5f * kTurn * radius * u, -v * thickness}};
    });
    return bay;
}

Triangles make_hanging(float width, float drop, float phase) {
    Triangles mesh;
    add_surface(mesh, 40, 30, [=](float u, float v) {
        const float down = 1 - v;
        const float folds =
            0.07f * std::sin(kTurn * (5 * u + phase)) + 0.03f * std::sin(kTurn * (11 * u + 2.3f * phase));
        const float sway = 0.10f * std::sin(kTurn * (0.7f * down + phase)) * down;
        const float gather =
            1 - 0.12f * std::sin(0.5f * kTurn * down) - 0.03f * std::cos(kTurn * 3 * u) * down;
        const float hem = 0.04f * std::sin(kTurn * (5 * u + phase + 0.25f)) * down;
        return SurfacePoint{
            {(u - 0.5f) * width * gather, -drop * down + hem, folds * (0.45f + 0.75f * down) + sway},
            {u * width * 1.15f, down * drop}};
    });
    return mesh;
}

Triangles make_vase(int shape) {
    Triangles mesh;
    const float belly = shape % 2 == 0 ? 0.30f : 0.22f, tall = shape % 3 == 0 ? 1.0f : 0.75f;
    std::vector<glm::vec2> outside;
    for (int i = 0; i <= 30; ++i) {
        const float t = static_cast<float>(i) / 30;
        const float body = belly * std::pow(std::sin(0.5f * kTurn * std::min(0.08f + 0.86f * t, 1.0f)), 0.8f);
        const float neck = 0.085f + 0.07f * std::pow(std::max(0.0f, (t - 0.8f) * 5), 2.0f);
        const float foot = 0.06f * std::exp(-t * 25);
        outside.emplace_back(std::max(std::max(body, neck), foot + 0.10f), t * tall);
    }
    add_lathe(mesh, outside, 32, true);
    const glm::vec2 lip = outside.back();
    const std::vector<glm::vec2> inside{
        lip, {lip.x - 0.02f, lip.y}, {0.07f, tall * 0.86f}, {0.07f, tall * 0.7f}, {0.0f, tall * 0.7f}};
    add_lathe(mesh, inside, 32, false);
    return mesh;
}

Triangles make_baluster() {
    Triangles mesh;
    std::vector<glm::vec2> profile;
    for (int i = 0; i <= 10; ++i) {
        const float t = static_cast<float>(i) / 10;
        profile.emplace_back(0.035f + 0.045f * std::pow(std::sin(0.5f * kTurn * std::pow(t, 0.6f)), 2.0f),
                             0.08f + 0.64f * t);
    }
    add_lathe(mesh, profile, 12, true);
    add_box(mesh, {-0.07f, 0, -0.07f}, {0.07f, 0.08f, 0.07f});
    add_box(mesh, {-0.07f, 0.72f, -0.07f}, {0.07f, 0.8f, 0.07f});
    return mesh;
}

Triangles make_pedestal() {
    Triangles mesh;
    add_box(mesh, {-0.34f, 0, -0.34f}, {0.34f, 0.14f, 0.34f});
    add_box(mesh, {-0.27f, 0.14f, -0.27f}, {0.27f, 0.8f, 0.27f});
    add_box(mesh, {-0.33f, 0.8f, -0.33f}, {0.33f, 0.92f, 0.33f});
    return mesh;
}

Triangles make_hanging_lamp(float chain_m) {
    Triangles mesh;
    // Links turn a quarter from one to the next.
    const float link = 0.09f;
    const int links = static_cast<int>(chain_m / link);
    for (int i = 0; i < links; ++i) {
        const float top = -link * static_cast<float>(i);
        const bool turned = i % 2 == 1;
        add_surface(mesh, 10, 5, [=](float u, float v) {
            const float a = kTurn * u, b = kTurn * v;
            const float r = 0.030f + 0.008f * std::cos(b);
            const glm::vec2 across{r * std::cos(a), 0.008f * std::sin(b)};
            const float y = top - 0.5f * link + 1.9f * r * std::sin(a);
            return SurfacePoint{turned ? glm::vec3(-across.y, y, across.x) : glm::vec3(across.x, y, across.y),
                                {u, v}};
        });
    }
    const float y = -chain_m;
    const std::vector<glm::vec2> bowl{{0.02f, y - 0.52f}, {0.16f, y - 0.46f}, {0.27f, y - 0.34f},
                                      {0.31f, y - 0.2f},  {0.25f, y - 0.14f}, {0.22f, y - 0.08f},
                                      {0.08f, y - 0.03f}, {0.03f, y}};
    std::vector<glm::vec2> fine;
    for (std::size_t i = 0; i + 1 < bowl.size(); ++i)
        for (int k = 0; k < 2; ++k) fine.push_back(glm::mix(bowl[i], bowl[i + 1], static_cast<float>(k) / 2));
    fine.push_back(bowl.back());
    add_lathe(mesh, fine, 24, true);
    return mesh;
}

}  // namespace parafovea
