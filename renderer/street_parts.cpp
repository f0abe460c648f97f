// Builds cobbles, windows, balconies, lamp posts, furniture, glass and plants.
#include "renderer/street_parts.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "renderer/scene_patterns.h"

namespace parafovea {
namespace {

constexpr float kTurn = 2 * std::numbers::pi_v<float>;

float noise(int i, int j, std::uint32_t seed) {
    return lattice_noise(i, j, seed);
}

void add_bar(Triangles& mesh, glm::vec3 low, glm::vec3 high) {
    add_box(mesh, low, high);
}

}  // namespace

Triangles make_tube(const std::function<glm::vec3(float)>& path, float radius, int along, int around) {
    Triangles mesh;
    add_surface(mesh, around, along, [&](float u, float v) {
        const glm::vec3 p = path(v), ahead = path(v + 0.01f) - path(v - 0.01f);
        const glm::vec3 t = glm::normalize(ahead);
        const glm::vec3 side =
            glm::normalize(glm::cross(std::abs(t.y) < 0.95f ? glm::vec3(0, 1, 0) : glm::vec3(1, 0, 0), t));
        const float a = kTurn * u;
        return SurfacePoint{p + radius * (std::cos(a) * side + std::sin(a) * glm::cross(t, side)),
                            {u * 0.2f, -v}};
    });
    return mesh;
}

Triangles make_ball(float radius, int around, int along) {
    Triangles mesh;
    add_surface(mesh, around, along, [=](float u, float v) {
        const float a = kTurn * u, b = 0.5f * kTurn * std::clamp(v, 1e-3f, 1 - 1e-3f);
        return SurfacePoint{
            radius * glm::vec3(std::sin(b) * std::sin(a), -std::cos(b), std::sin(b) * std::cos(a)), {u, -v}};
    });
    return mesh;
}

Triangles make_cobbles(float width, float length, std::uint32_t seed) {
    Triangles mesh;
    const int columns = static_cast<int>(width / 0.16f), rows = static_cast<int>(length / 0.125f);
    const float dx = width / static_cast<float>(columns), dz = length / static_cast<float>(rows);
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const float gap = 0.012f;
            const float shift = (j % 2 == 0 ? 0.25f : -0.25f) * dx;
            // Half stones at the row's ends keep the patch's outline straight enough to be laid side by side.
            const float x0 = std::max(static_cast<float>(i) * dx + shift, 0.0f) + gap;
            const float x1 = std::min(static_cast<float>(i + 1) * dx + shift, width) - gap;
            const float z0 = static_cast<float>(j) * dz + gap, z1 = static_cast<float>(j + 1) * dz - gap;
            const float top = 0.018f * (noise(i, j, seed) - 0.5f),
                        lean_x = 0.05f * (noise(i, j, seed + 1) - 0.5f),
                        lean_z = 0.05f * (noise(i, j, seed + 2) - 0.5f);
            add_surface(mesh, 4, 4, [=](float u, float v) {
                const float a = 2 * u - 1, b = 2 * v - 1;
                const float dome = (1 - a * a * a * a) * (1 - b * b * b * b);
                const float x = std::lerp(x0, x1, u), z = std::lerp(z1, z0, v);
                return SurfacePoint{
                    {x, -0.03f + dome * (0.03f + top + lean_x * a * 0.5f + lean_z * b * 0.5f), z}, {x, z}};
            });
        }
    }
    return mesh;
}

Triangles make_window_frame(float width, float height) {
    Triangles mesh;
    const float w = width / 2;
    for (float side : {-1.0f, 1.0f}) {
        const float x = side * w;
        add_bar(mesh, {std::min(x, x + side * 0.12f), 0, 0}, {std::max(x, x + side * 0.12f), height, 0.10f});
    }
    add_bar(mesh, {-w - 0.18f, -0.12f, 0}, {w + 0.18f, 0, 0.20f});
    add_bar(mesh, {-w - 0.16f, height, 0}, {w + 0.16f, height + 0.14f, 0.14f});
    add_bar(mesh, {-w - 0.22f, height + 0.14f, 0}, {w + 0.22f, height + 0.2f, 0.22f});
    // Brackets under the cap, glazing bars over the pane.
    for (float x : {-w - 0.1f, w + 0.02f}) {
        const Triangles scroll = make_tube(
            [=](float t) {
                const float a = kTurn * (0.25f + 0.9f * t);
                return glm::vec3(x + 0.04f, height + 0.05f + 0.07f * std::sin(a) * (1 - 0.6f * t),
                                 0.12f + 0.07f * std::cos(a) * (1 - 0.6f * t));
            },
            0.02f, 10, 6);
        add_transformed(mesh, scroll, glm::mat4(1));
    }
    add_bar(mesh, {-0.025f, 0, 0.02f}, {0.025f, height, 0.06f});
    for (int i = 1; i < 3; ++i) {
        const float y = height * static_cast<float>(i) / 3;
        add_bar(mesh, {-w, y - 0.018f, 0.02f}, {w, y + 0.018f, 0.05f});
    }
    return mesh;
}

Triangles make_shutter(float width, float height) {
    Triangles mesh;
    add_bar(mesh, {0, 0, 0}, {0.05f, height, 0.04f});
    add_bar(mesh, {width - 0.05f, 0, 0}, {width, height, 0.04f});
    const int slats = static_cast<int>(height / 0.07f);
    for (int i = 0; i < slats; ++i) {
        Triangles slat;
        add_box(slat, {0.05f, -0.03f, -0.006f}, {width - 0.05f, 0.03f, 0.006f});
        const float y = height * (static_cast<float>(i) + 0.5f) / static_cast<float>(slats);
        add_transformed(mesh, slat,
                        glm::rotate(glm::translate(glm::mat4(1), {0, y, 0.02f}), -0.7f, {1, 0, 0}));
    }
    return mesh;
}

Triangles make_balcony_rail(float width, float depth) {
    Triangles mesh;
    const auto stretch = [&](glm::vec3 from, glm::vec3 to) {
        const float length = glm::distance(from, to);
        const int bars = std::max(2, static_cast<int>(length / 0.125f));
        for (int i = 0; i <= bars; ++i) {
            const glm::vec3 foot = glm::mix(from, to, static_cast<float>(i) / static_cast<float>(bars));
            // Each bar bellies outwards and carries a collar.
            add_transformed(mesh,
                            make_tube(
                                [&](float t) {
                                    return foot +
                                           glm::vec3(0, 0.95f * t,
                                                     0.07f * std::sin(0.5f * kTurn * std::min(2 * t, 1.0f)));
                                },
                                0.011f, 8, 5),
                            glm::mat4(1));
            add_transformed(mesh, make_ball(0.026f, 7, 4),
                            glm::translate(glm::mat4(1), foot + glm::vec3(0, 0.62f, 0)));
        }
    };
    const float w = width / 2;
    stretch({-w, 0, depth}, {w, 0, depth});
    stretch({-w, 0, 0.05f}, {-w, 0, depth});
    stretch({w, 0, depth}, {w, 0, 0.05f});
    add_bar(mesh, {-w - 0.02f, 0.94f, depth - 0.025f}, {w + 0.02f, 0.98f, depth + 0.03f});
    add_bar(mesh, {-w - 0.02f, 0.94f, 0}, {-w + 0.02f, 0.98f, depth});
    add_bar(mesh, {w - 0.02f, 0.94f, 0}, {w + 0.02f, 0.98f, depth});
    return mesh;
}

Triangles make_lamp_post(float height) {
    Triangles mesh;
    std::vector<glm::vec2> profile;
    const float pole = height - 0.35f;
    for (int i = 0; i <= 40; ++i) {
        const float t = static_cast<float>(i) / 40, y = pole * t;
        float r = 0.05f - 0.015f * t;
        r += 0.09f * std::exp(-y * 5) + 0.03f * std::exp(-std::pow((y - 0.9f) * 14, 2.0f)) +
             0.025f * std::exp(-std::pow((y - pole + 0.2f) * 16, 2.0f));
        profile.emplace_back(r, y);
    }
    add_lathe(mesh, profile, 18, true);
    // Cage, roof and finial of the lantern.
    for (int i = 0; i < 6; ++i) {
        const float a = kTurn * static_cast<float>(i) / 6;
        const glm::vec3 low{0.11f * std::sin(a), pole, 0.11f * std::cos(a)},
            high{0.2f * std::sin(a), pole + 0.5f, 0.2f * std::cos(a)};
        add_transformed(mesh, make_tube([&](float t) { return glm::mix(low, high, t); }, 0.011f, 2, 5),
                        glm::mat4(1));
    }
    const std::vector<glm::vec2> roof{{0.25f, pole + 0.5f},  {0.16f, pole + 0.62f},  {0.06f, pole + 0.68f},
                                      {0.03f, pole + 0.74f}, {0.045f, pole + 0.79f}, {0.0f, pole + 0.86f}};
    add_lathe(mesh, roof, 18, false);
    for (float side : {-1.0f, 1.0f})
        add_transformed(mesh,
                        make_tube(
                            [=](float t) {
                                const float a = kTurn * t * 1.2f;
                                return glm::vec3(side * (0.08f + 0.16f * (1 - t) * std::sin(a * 0.5f)),
                                                 pole - 0.5f + 0.35f * t, 0);
                            },
                            0.012f, 14, 6),
                        glm::mat4(1));
    return mesh;
}

Triangles make_lantern_panes(float height) {
    Triangles mesh;
    const float pole = height - 0.35f;
    const std::vector<glm::vec2> panes{{0.105f, pole + 0.01f}, {0.19f, pole + 0.49f}};
    add_lathe(mesh, panes, 6, false);
    return mesh;
}

Triangles make_cafe_chair() {
    Triangles mesh;
    const auto tube = [&](const std::function<glm::vec3(float)>& path, int along) {
        add_transformed(mesh, make_tube(path, 0.012f, along, 6), glm::mat4(1));
    };
    for (float side : {-1.0f, 1.0f}) {
        tube([=](float t) { return glm::vec3(side * (0.2f - 0.02f * t), 0.45f * t, 0.2f - 0.02f * t); }, 4);
        tube(
            [=](float t) {
                return glm::vec3(side * (0.2f - 0.03f * t), 0.9f * t,
                                 -0.22f - 0.05f * t + 0.08f * std::sin(0.5f * kTurn * t));
            },
            8);
    }
    tube(
        [](float t) {
            return glm::vec3(0.17f * std::cos(0.5f * kTurn * t), 0.88f + 0.06f * std::sin(0.5f * kTurn * t),
                             -0.27f);
        },
        10);
    // Woven seat and back.
    for (int i = 0; i < 9; ++i) {
        const float x = -0.17f + 0.0425f * static_cast<float>(i);
        tube(
            [=](float t) {
                return glm::vec3(x, 0.45f - 0.012f * std::sin(0.5f * kTurn * t), -0.19f + 0.38f * t);
            },
            5);
        if (i % 2 == 0)
            tube([=](float t) { return glm::vec3(x, 0.5f + 0.4f * t, -0.25f - 0.02f * std::sin(kTurn * t)); },
                 5);
    }
    for (int i = 0; i < 8; ++i) {
        const float z = -0.18f + 0.052f * static_cast<float>(i);
        tube(
            [=](float t) {
                return glm::vec3(-0.18f + 0.36f * t, 0.455f - 0.012f * std::sin(0.5f * kTurn * t), z);
            },
            5);
    }
    return mesh;
}

Triangles make_cafe_table() {
    Triangles mesh;
    const std::vector<glm::vec2> top{
        {0.0f, 0.70f}, {0.33f, 0.70f}, {0.34f, 0.715f}, {0.33f, 0.73f}, {0.0f, 0.73f}};
    add_lathe(mesh, top, 36, false);
    std::vector<glm::vec2> stem;
    for (int i = 0; i <= 24; ++i) {
        const float t = static_cast<float>(i) / 24;
        stem.emplace_back(
            0.025f + 0.02f * std::pow(std::sin(kTurn * 1.5f * t), 2.0f) + 0.2f * std::exp(-t * 22),
            0.70f * t);
    }
    add_lathe(mesh, stem, 14, true);
    return mesh;
}

Triangles make_bottle() {
    Triangles mesh;
    std::vector<glm::vec2> profile{{0.0f, 0.0f}, {0.036f, 0.002f}};
    for (int i = 0; i <= 14; ++i) {
        const float t = static_cast<float>(i) / 14;
        const float r =
            t < 0.55f ? 0.038f : std::lerp(0.038f, 0.014f, std::clamp((t - 0.55f) / 0.2f, 0.0f, 1.0f));
        profile.emplace_back(r, 0.01f + 0.29f * t);
    }
    add_lathe(mesh, profile, 18, true);
    return mesh;
}

Triangles make_wine_glass() {
    Triangles mesh;
    std::vector<glm::vec2> profile{{0.032f, 0.0f}, {0.008f, 0.006f}, {0.004f, 0.02f}, {0.004f, 0.08f}};
    for (int i = 0; i <= 10; ++i) {
        const float t = static_cast<float>(i) / 10;
        profile.emplace_back(0.006f + 0.032f * std::sin(0.25f * kTurn * std::min(t * 1.5f, 1.3f)),
                             0.085f + 0.085f * t);
    }
    add_lathe(mesh, profile, 18, true);
    return mesh;
}

Triangles make_awning(float width, float depth, float drop) {
    Triangles mesh;
    add_surface(mesh, 24, 10, [=](float u, float v) {
        const float out = (1 - v) * depth;
        const float sag = 0.05f * std::sin(0.5f * kTurn * v) * (1 + 0.3f * std::cos(kTurn * 3 * u));
        return SurfacePoint{{(u - 0.5f) * width, -drop * (1 - v) - sag, out}, {u * width, (1 - v) * depth}};
    });
    add_surface(mesh, 48, 4, [=](float u, float v) {
        const float scallop = 0.08f * std::abs(std::sin(0.5f * kTurn * u * width / 0.4f));
        return SurfacePoint{{(u - 0.5f) * width, -drop - (1 - v) * (0.14f + scallop),
                             depth + 0.015f * std::sin(kTurn * 4 * u)},
                            {u * width, (1 - v) * 0.2f}};
    });
    return mesh;
}

Triangles make_leaves(int count, glm::vec3 reach, float size_m, std::uint32_t seed) {
    Triangles mesh;
    for (int i = 0; i < count; ++i) {
        const float y = 2 * noise(i, 0, seed) - 1, a = kTurn * noise(i, 1, seed);
        const float r = std::sqrt(1 - y * y), deep = std::pow(noise(i, 2, seed), 0.35f);
        const glm::vec3 out{r * std::cos(a), y, r * std::sin(a)};
        const glm::vec3 droop{noise(i, 3, seed) - 0.5f, -0.4f * noise(i, 4, seed), noise(i, 5, seed) - 0.5f};
        const glm::vec3 along = glm::normalize(out + 1.1f * droop);
        const glm::vec3 across =
            glm::normalize(glm::cross(along, glm::vec3(0.2f, 1, noise(i, 6, seed) - 0.5f)));
        const float size = size_m * (0.7f + 0.6f * noise(i, 7, seed));
        const glm::vec3 foot = out * reach * deep;
        const glm::vec3 fold = glm::cross(across, along) * (0.25f * size);
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const glm::vec3 corners[4] = {foot, foot + 0.5f * size * along + 0.3f * size * across - fold,
                                      foot + size * along,
                                      foot + 0.5f * size * along - 0.3f * size * across - fold};
        const glm::vec2 uvs[4] = {{0.5f, 1}, {1, 0.5f}, {0.5f, 0}, {0, 0.5f}};
        const glm::vec3 normal = glm::normalize(glm::cross(along, across) + 0.6f * out);
        for (int k = 0; k < 4; ++k) {
            SceneVertex v;
            v.position = corners[k];
            v.uv = uvs[k];
            v.normal = glm::dot(normal, glm::cross(corners[1] - corners[0], corners[2] - corners[0])) < 0
                           ? -normal
                           : normal;
            mesh.vertices.push_back(v);
        }
        mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    }
    return mesh;
}

Triangles make_trunk(float height, std::uint32_t seed) {
    Triangles mesh;
    const auto limb = [&](glm::vec3 from, glm::vec3 to, float thick, int index) {
        const float bend = 0.25f * (noise(index, 9, seed) - 0.5f);
        add_transformed(mesh,
                        make_tube(
                            [=](float t) {
                                return glm::mix(from, to, t) +
                                       glm::vec3(bend * std::sin(0.5f * kTurn * t), 0,
                                                 bend * std::cos(0.5f * kTurn * t) - bend);
                            },
                            thick, 10, 9),
                        glm::mat4(1));
    };
    limb({0, 0, 0}, {0, height, 0}, 0.11f, 0);
    for (int i = 1; i < 7; ++i) {
        const float a = kTurn * static_cast<float>(i) * 0.381f;
        const float y = height * (0.6f + 0.06f * static_cast<float>(i));
        limb({0, y, 0}, {1.1f * std::cos(a), y + 0.9f, 1.1f * std::sin(a)}, 0.045f, i);
    }
    return mesh;
}

}  // namespace parafovea
