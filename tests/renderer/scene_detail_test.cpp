// Pieces and levels of detail: nothing is lost, nothing lies farther off than stated, pictures stay the same.
#include "renderer/scene_detail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <set>

#include "renderer/frame_renderer.h"
#include "renderer/scene_shapes.h"
#include "renderer/street_parts.h"

namespace parafovea {
namespace {

using Corners = std::array<std::uint32_t, 3>;

Scene scene_of(const Triangles& mesh) {
    Scene scene;
    scene.materials.push_back({});
    scene.materials[0].base_color = {0.7f, 0.6f, 0.5f, 1};
    scene.materials[0].metallic = 0;
    scene.sun = Sun{glm::normalize(glm::vec3(0.4f, 0.5f, 0.8f)), glm::vec3(2), false};
    scene.instances.push_back({append_mesh(scene, mesh, 0), glm::mat4(1)});
    scene.cameras.push_back(camera_looking({0, 0, 6}, {0, 0, 0}, 0.6f));
    return scene;
}

// A ball with a seam and bumps: u = 0 and u = 1 are the same places up to rounding.
Triangles bumpy_ball() {
    Triangles mesh;
    add_surface(mesh, 60, 40, [](float u, float v) {
        const float a = 6.2831853f * u, b = 3.1415927f * std::clamp(v, 1e-3f, 1 - 1e-3f);
        const float r = 1 + 0.05f * std::sin(5 * a) * std::sin(b) * std::sin(4 * b);
        return SurfacePoint{r * glm::vec3(std::sin(b) * std::sin(a), -std::cos(b), std::sin(b) * std::cos(a)),
                            {u, -v}};
    });
    return mesh;
}

Triangles street_things() {
    Triangles all = make_balcony_rail(1.9f, 0.75f);
    add_transformed(all, make_leaves(300, {0.5f, 0.4f, 0.5f}, 0.1f, 3),
                    glm::translate(glm::mat4(1), {0, 1, 0}));
    add_transformed(all, make_cobbles(1.2f, 1.2f, 5), glm::mat4(1));
    return all;
}

std::multiset<Corners> triangles_of(std::span<const std::uint32_t> indices) {
    std::multiset<Corners> set;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        set.insert({indices[i], indices[i + 1], indices[i + 2]});
    return set;
}

std::span<const std::uint32_t> indices_of(const SceneDetail& detail, const DetailLevel& level) {
    return std::span(detail.indices).subspan(level.first_index, level.index_count);
}

// Distance from a point to a triangle by the least of many of its points and then of finer ones around it.
double distance_to(glm::dvec3 p, glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    double u = 1.0 / 3, v = 1.0 / 3, reach = 1;
    const auto away = [&](double x, double y) { return glm::distance(p, a + x * (b - a) + y * (c - a)); };
    for (int round = 0; round < 22; ++round, reach *= 0.6) {
        double best_u = u, best_v = v;
        for (int i = -3; i <= 3; ++i) {
            for (int j = -3; j <= 3; ++j) {
                const double x = std::clamp(u + reach * i / 3, 0.0, 1.0);
                const double y = std::clamp(v + reach * j / 3, 0.0, 1 - x);
                if (away(x, y) < away(best_u, best_v)) best_u = x, best_v = y;
            }
        }
        u = best_u, v = best_v;
    }
    return away(u, v);
}

TEST(Pieces, HoldEveryTriangleOfTheMeshOnce) {
    const Scene scene = scene_of(street_things());
    const SceneMesh& mesh = scene.meshes[0];
    const SceneDetail detail = make_detail(scene, true);
    ASSERT_GT(detail.pieces[0].size(), 1u);
    const auto whole = std::span(detail.indices).subspan(detail.first_index[0], mesh.index_count);
    EXPECT_EQ(triangles_of(whole),
              triangles_of(std::span(scene.indices).subspan(mesh.first_index, mesh.index_count)));
    std::uint32_t next = detail.first_index[0];
    for (const MeshPiece& piece : detail.pieces[0]) {
        EXPECT_EQ(piece.levels.front().first_index, next);
        EXPECT_EQ(piece.levels.front().error_m, 0);
        next += piece.levels.front().index_count;
    }
    EXPECT_EQ(next, detail.first_index[0] + mesh.index_count);
}

TEST(Pieces, DrawTheOutermostPartsFirst) {
    const Scene scene = scene_of(make_leaves(500, {1, 1, 1}, 0.02f, 3));
    const SceneDetail detail = make_detail(scene, false);
    ASSERT_EQ(detail.pieces[0].size(), 1u);
    // Leaves of two triangles, small beside the crown of radius 1.
    double last = 2, first = 0;
    for (std::size_t i = 0; i < detail.indices.size(); i += 6) {
        const double out = glm::length(scene.vertices[detail.indices[i]].position);
        if (i == 0) first = out;
        EXPECT_LT(out, last + 0.06);
        last = out;
    }
    EXPECT_GT(first, last + 0.5);
}

TEST(Pieces, NeverCutASurface) {
    const Scene scene = scene_of(street_things());
    const SceneDetail detail = make_detail(scene, false);
    std::map<std::array<float, 3>, std::size_t> piece_at;
    for (std::size_t i = 0; i < detail.pieces[0].size(); ++i) {
        ASSERT_EQ(detail.pieces[0][i].levels.size(), 1u);
        for (std::uint32_t v : indices_of(detail, detail.pieces[0][i].levels[0])) {
            const glm::vec3 p = scene.vertices[v].position;
            const auto [found, is_new] = piece_at.try_emplace({p.x, p.y, p.z}, i);
            EXPECT_EQ(found->second, i);
            const Bounds& box = detail.pieces[0][i].bounds;
            EXPECT_TRUE(glm::all(glm::lessThanEqual(box.low, p)) &&
                        glm::all(glm::lessThanEqual(p, box.high)));
        }
    }
}

TEST(Levels, FallInTrianglesAndRiseInError) {
    for (const Triangles& shape : {bumpy_ball(), street_things()}) {
        const SceneDetail detail = make_detail(scene_of(shape), true);
        std::size_t most_levels = 0;
        for (const MeshPiece& piece : detail.pieces[0]) {
            most_levels = std::max(most_levels, piece.levels.size());
            for (std::size_t i = 1; i < piece.levels.size(); ++i) {
                EXPECT_LT(piece.levels[i].index_count, piece.levels[i - 1].index_count);
                EXPECT_GT(piece.levels[i].error_m, piece.levels[i - 1].error_m);
                EXPECT_EQ(&level_for(piece, piece.levels[i].error_m), &piece.levels[i]);
                EXPECT_EQ(&level_for(piece, std::nextafter(piece.levels[i].error_m, 0.0f)),
                          &piece.levels[i - 1]);
            }
            EXPECT_EQ(&level_for(piece, 0), &piece.levels[0]);
        }
        EXPECT_GE(most_levels, 4u);
    }
}

TEST(Levels, LeaveNoVertexFartherOffThanTheySay) {
    const Scene scene = scene_of(bumpy_ball());
    const SceneDetail detail = make_detail(scene, true);
    ASSERT_EQ(detail.pieces[0].size(), 1u);
    for (const DetailLevel& level : detail.pieces[0][0].levels) {
        const auto left = indices_of(detail, level);
        double largest = 0;
        for (std::size_t v = 0; v < scene.vertices.size(); v += 211) {
            const glm::dvec3 p{scene.vertices[v].position};
            double nearest = 1e9;
            for (std::size_t i = 0; i < left.size(); i += 3) {
                const glm::dvec3 a{scene.vertices[left[i]].position}, b{scene.vertices[left[i + 1]].position},
                    c{scene.vertices[left[i + 2]].position};
                // A corner farther away than the triangle's longest edge rules it out.
                if (glm::distance(p, a) > nearest + std::max(glm::distance(a, b), glm::distance(a, c)))
                    continue;
                nearest = std::min(nearest, distance_to(p, a, b, c));
            }
            largest = std::max(largest, nearest);
        }
        EXPECT_LE(largest, level.error_m + 2e-5);
    }
    EXPECT_LT(detail.pieces[0][0].levels.back().index_count,
              detail.pieces[0][0].levels.front().index_count / 4);
}

TEST(Levels, AreTheSameOnEveryCallAndAbsentUnlessAskedFor) {
    const Scene scene = scene_of(street_things());
    const SceneDetail a = make_detail(scene, true), b = make_detail(scene, true);
    EXPECT_EQ(a.indices, b.indices);
    EXPECT_EQ(make_detail(scene, false).indices.size(), scene.indices.size());
}

TEST(Levels, AreNotMadeOfLeavesOrSmallThings) {
    for (const Triangles& shape : {make_leaves(400, {1, 1, 1}, 0.1f, 3), make_ball(1, 5, 4)}) {
        const SceneDetail detail = make_detail(scene_of(shape), true);
        for (const MeshPiece& piece : detail.pieces[0]) EXPECT_EQ(piece.levels.size(), 1u);
    }
}

struct Drawn {
    Image image;
    std::uint64_t triangles = 0;
};

Drawn drawn(Gpu& gpu, const Scene& scene, double error_px) {
    const SizePx size{160, 90};
    FrameRenderer renderer(gpu, scene, {.most_detail_error_px = error_px});
    const RenderedFrame frame =
        renderer.render(size, view_through(scene.cameras[0], size), {}, centre_of(size));
    return {frame.image, frame.statistics.triangles};
}

// How many bytes of a pixel lie outside what its neighbourhood shows in the other picture, by more than a
// tolerance.
int strangers(const Image& image, const Image& other) {
    int count = 0;
    for (int y = 1; y + 1 < image.size.height; ++y) {
        for (int x = 1; x + 1 < image.size.width; ++x) {
            for (int c = 0; c < 3; ++c) {
                int low = 255, high = 0;
                for (int dy = -1; dy <= 1; ++dy) {
                    for (int dx = -1; dx <= 1; ++dx) {
                        const int byte = other.rgba[static_cast<std::size_t>(
                            ((y + dy) * image.size.width + x + dx) * 4 + c)];
                        low = std::min(low, byte);
                        high = std::max(high, byte);
                    }
                }
                const int byte = image.rgba[static_cast<std::size_t>((y * image.size.width + x) * 4 + c)];
                count += byte < low - 20 || byte > high + 20;
            }
        }
    }
    return count;
}

double mean_difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(a.rgba[i] - b.rgba[i]);
    return sum / static_cast<double>(a.rgba.size());
}

TEST(Levels, ShowThePictureOfFullDetailWithFewerTriangles) {
    Gpu gpu({.validation = true});
    Scene scene = scene_of(bumpy_ball());
    scene.instances.clear();
    // Near and far, squeezed, turned over, and seen from both sides.
    const glm::vec3 scales[] = {{1, 1, 1}, {-0.5f, 0.5f, 0.5f}, {0.2f, 0.9f, 0.4f}, {0.3f, 0.3f, -0.3f}};
    const glm::vec3 places[] = {{-1.6f, 0, 0}, {0.8f, 0.6f, 1}, {2.0f, -0.3f, -1}, {0.6f, -0.9f, -8}};
    for (int i = 0; i < 4; ++i) {
        scene.instances.push_back(
            {0,
             glm::scale(glm::rotate(glm::translate(glm::mat4(1), places[i]), 0.7f, {1, 2, 0}), scales[i])});
    }
    for (const bool double_sided : {false, true}) {
        scene.materials[0].double_sided = double_sided;
        const Drawn full = drawn(gpu, scene, 0), half_px = drawn(gpu, scene, 0.5),
                    coarse = drawn(gpu, scene, 8);
        EXPECT_EQ(full.triangles, 4 * scene.indices.size() / 3);
        EXPECT_LT(half_px.triangles, 0.6 * static_cast<double>(full.triangles));
        EXPECT_LT(coarse.triangles, half_px.triangles);
        EXPECT_LT(mean_difference(half_px.image, full.image), 0.8);
        EXPECT_EQ(strangers(half_px.image, full.image), 0);
        // The measure sees what is too coarse.
        EXPECT_GT(strangers(coarse.image, full.image), 20);
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(Levels, AreLeftOutWhereEverythingIsForced) {
    Gpu gpu;
    const Scene scene = scene_of(bumpy_ball());
    ScenePasses forced(gpu, scene, {.force_everything = true}), lean(gpu, scene);
    const SizePx size{160, 90};
    const CameraView view = view_through(scene.cameras[0], size);
    forced.set_view(size, view);
    lean.set_view(size, view);
    EXPECT_EQ(forced.triangles_in_view(), scene.indices.size() / 3);
    EXPECT_EQ(lean.full_triangles_in_view(), scene.indices.size() / 3);
    EXPECT_LT(lean.triangles_in_view(), lean.full_triangles_in_view());
    // Nearer, more of them.
    CameraView near_view = view;
    near_view.world_from_eye[3].z = 2.5f;
    const std::uint64_t far_triangles = lean.triangles_in_view();
    lean.set_view(size, near_view);
    EXPECT_GT(lean.triangles_in_view(), far_triangles);
}

}  // namespace
}  // namespace parafovea
