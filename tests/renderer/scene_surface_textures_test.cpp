// Reading textures for each sample changes no picture, and is left where a scene does not allow it.
#include "renderer/scene_surface_textures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/frame_renderer.h"
#include "renderer/scene_tangents.h"

namespace parafovea {
namespace {

int add_texture(Scene& scene, int size, bool srgb, int kind) {
    SceneImage image{"texture", size, size, {}};
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const bool odd = ((x * 8 / size) + (y * 8 / size)) % 2 != 0;
            const std::uint8_t value = odd ? 220 : 90;
            if (kind == 0)
                image.rgba.insert(image.rgba.end(),
                                  {value, 140, static_cast<std::uint8_t>(255 - value), 255});
            if (kind == 1)
                image.rgba.insert(image.rgba.end(),
                                  {value, value, static_cast<std::uint8_t>(odd ? 0 : 60), 255});
            if (kind == 2)
                image.rgba.insert(image.rgba.end(),
                                  {static_cast<std::uint8_t>(odd ? 200 : 60), 150, 215, 255});
        }
    }
    scene.images.push_back(std::move(image));
    scene.textures.push_back({static_cast<int>(scene.images.size()) - 1, srgb});
    return static_cast<int>(scene.textures.size()) - 1;
}

// A bent sheet with every kind of texture, of two sizes, seen from its front or from behind.
Scene textured_scene(bool from_behind = false) {
    Scene scene;
    scene.sun = Sun{glm::normalize(glm::vec3(0.4f, 0.5f, 0.8f)), glm::vec3(2), true};
    Material m;
    m.base_color = {0.9f, 0.8f, 0.7f, 1};
    m.metallic = 0.8f;
    m.roughness = 0.9f;
    m.normal_scale = 0.7f;
    m.occlusion_strength = 0.6f;
    m.emissive = {0.1f, 0.02f, 0.05f};
    m.double_sided = true;
    m.base_color_texture.texture = add_texture(scene, 64, true, 0);
    m.metallic_roughness_texture.texture = add_texture(scene, 32, false, 1);
    m.normal_texture.texture = add_texture(scene, 64, false, 2);
    m.occlusion_texture.texture = m.metallic_roughness_texture.texture;
    m.emissive_texture.texture = add_texture(scene, 16, true, 0);
    scene.materials.push_back(m);
    Triangles sheet;
    constexpr int kCells = 12;
    for (int j = 0; j <= kCells; ++j) {
        for (int i = 0; i <= kCells; ++i) {
            const float u = static_cast<float>(i) / kCells, v = static_cast<float>(j) / kCells;
            SceneVertex vertex;
            vertex.position = {2 * u - 1, 1 - 2 * v, 0.3f * std::sin(4 * u) - 0.4f * v};
            vertex.normal = glm::normalize(glm::vec3(-0.6f * std::cos(4 * u), -0.2f, 1));
            vertex.uv = {1.7f * u - 0.4f, 1.3f * v};
            sheet.vertices.push_back(vertex);
        }
    }
    for (std::uint32_t j = 0; j < kCells; ++j) {
        for (std::uint32_t i = 0; i < kCells; ++i) {
            const std::uint32_t a = j * (kCells + 1) + i, b = a + kCells + 1;
            sheet.indices.insert(sheet.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    }
    make_tangents(sheet);
    scene.instances.push_back({append_mesh(scene, sheet, 0), glm::mat4(1)});
    scene.cameras.push_back(camera_looking({0.4f, 0.2f, from_behind ? -4.0f : 4.0f}, {0, 0, 0}, 0.6f));
    return scene;
}

Image render(Gpu& gpu, const Scene& scene, bool late) {
    const SizePx size{160, 120};
    FrameRenderer renderer(gpu, scene, {.late_textures = late});
    return renderer.render(size, view_through(scene.cameras[0], size), {}, centre_of(size)).image;
}

double psnr_db(const Image& a, const Image& b) {
    double squares = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) squares += std::pow(a.rgba[i] - b.rgba[i], 2);
    return 10 * std::log10(255.0 * 255.0 * static_cast<double>(a.rgba.size()) / std::max(squares, 1e-9));
}

TEST(SurfaceTextures, ReadForEachSampleGiveThePictureThatTheGBufferGives) {
    Gpu gpu({.validation = true});
    for (const bool from_behind : {false, true}) {
        const Scene scene = textured_scene(from_behind);
        ASSERT_TRUE(can_read_textures_late(scene));
        const Image early = render(gpu, scene, false);
        const double same = psnr_db(early, render(gpu, scene, true));
        EXPECT_GT(same, 40.0) << from_behind;

        // The measure sees a normal map.
        Scene flat = scene;
        flat.materials[0].normal_texture.texture = -1;
        EXPECT_LT(psnr_db(early, render(gpu, flat, true)), same - 10) << from_behind;
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

// The same sheet with its textures and its texture coordinates turned over, so that its tangents are
// left-handed, and a mesh of another size under an instance that sets it right. The normal map's red is
// negated with its sides, unless `bumps_stay`.
Scene turned_over(Scene scene, bool bumps_stay) {
    const int bumps =
        scene.textures[static_cast<std::size_t>(scene.materials[0].normal_texture.texture)].image;
    for (std::size_t i = 0; i < scene.images.size(); ++i) {
        SceneImage& image = scene.images[i];
        const SceneImage before = image;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                for (int c = 0; c < 4; ++c) {
                    const auto at = [&](int column) {
                        return static_cast<std::size_t>(4 * (y * image.width + column) + c);
                    };
                    const std::uint8_t value = before.rgba[at(image.width - 1 - x)];
                    const bool negate = c == 0 && static_cast<int>(i) == bumps && !bumps_stay;
                    image.rgba[at(x)] = negate ? static_cast<std::uint8_t>(255 - value) : value;
                }
            }
        }
    }
    constexpr float kLarger = 32;
    SceneMesh& mesh = scene.meshes[0];
    for (SceneVertex& v : scene.vertices) {
        v.position *= kLarger;
        v.uv.x = -v.uv.x;
        v.tangent = -v.tangent;
    }
    mesh.bounds = {kLarger * mesh.bounds.low, kLarger * mesh.bounds.high};
    scene.instances[0].world_from_mesh = glm::scale(glm::mat4(1), glm::vec3(1 / kLarger));
    return scene;
}

TEST(SurfaceTextures, LookTheSameTurnedOverWithTheirCoordinates) {
    Gpu gpu({.validation = true});
    const Scene scene = textured_scene();
    ASSERT_GT(scene.vertices[0].tangent.w * scene.vertices[100].tangent.w, 0);
    for (const bool late : {false, true}) {
        const Image image = render(gpu, scene, late);
        EXPECT_GT(psnr_db(image, render(gpu, turned_over(scene, false), late)), 45) << late;
        // The measure sees which way the bumps go.
        EXPECT_LT(psnr_db(image, render(gpu, turned_over(scene, true), late)), 35) << late;
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(SurfaceTextures, StayWithTheGBufferWhereASceneNeedsIt) {
    const Scene scene = textured_scene();
    EXPECT_TRUE(can_read_textures_late(scene));
    Scene moved = scene;
    moved.materials[0].base_color_texture.offset = {0.5f, 0};
    EXPECT_FALSE(can_read_textures_late(moved));
    Scene clamped = scene;
    clamped.textures[0].wrap_v = TextureWrap::clamp;
    EXPECT_FALSE(can_read_textures_late(clamped));
    Scene colored = scene;
    colored.vertices[0].color = {255, 0, 0, 255};
    EXPECT_FALSE(can_read_textures_late(colored));
    Scene uneven = scene;
    uneven.images[1] = {"uneven", 24, 24, std::vector<std::uint8_t>(24 * 24 * 4, 128)};
    EXPECT_FALSE(can_read_textures_late(uneven));
    Scene plain = scene;
    plain.materials = {Material{}};
    EXPECT_FALSE(can_read_textures_late(plain));
}

TEST(SurfaceTextures, AreFilteredOverTheSpacingOfSamples) {
    Gpu gpu({.validation = true});
    // Far from the gaze, coarse samples see the mean of a texture, not one texel or another.
    const Scene scene = textured_scene();
    const SizePx size{320, 240};
    const RenderMethod coarse{"kfr", {{"sigma", 4}, {"internal_filter", 0}}, {}};
    const auto error_with = [&](bool filter) {
        FrameRenderer renderer(gpu, scene, {.filter_over_spacing = filter, .late_textures = true});
        const CameraView view = view_through(scene.cameras[0], size);
        const Image full = renderer.render(size, view, {}, {0, 0}).image;
        return psnr_db(full, renderer.render(size, view, coarse, {0, 0}).image);
    };
    EXPECT_GT(error_with(true), error_with(false));
    EXPECT_TRUE(gpu.validation_messages().empty());
}

}  // namespace
}  // namespace parafovea
