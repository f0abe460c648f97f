// Small glTF files written here: what each part of the format must become.
#include "renderer/gltf_loader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "renderer/scene_tangents.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace parafovea {
namespace {

// Base64 of the little-endian floats and indices below.
std::string base64(const std::string& bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
    }
    return text;
}

template <typename T>
void append(std::string& bytes, std::initializer_list<T> values) {
    for (T value : values) bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// A file with one buffer: four corners of a unit square (48 bytes), then six 16-bit values (12 bytes).
class GltfFile {
  public:
    explicit GltfFile(std::initializer_list<std::uint16_t> shorts = {0, 1, 2, 0, 2, 3}) {
        append<float>(bytes_, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
        append<std::uint16_t>(bytes_, shorts);
        append<float>(bytes_, {5, 6, 7});
    }

    std::string accessors = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
                               {"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"})";
    std::string primitive = R"({"attributes":{"POSITION":0},"indices":1})";
    std::string nodes = R"({"mesh":0})";
    std::string roots = "0";
    std::string more;

    Scene load() const {
        const TemporaryFolder folder;
        std::ofstream(folder / "test.gltf")
            << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" << roots << R"(]}],"nodes":[)"
            << nodes << R"(],"meshes":[{"name":"square","primitives":[)" << primitive
            << R"(]}],"accessors":[)" << accessors
            << R"(],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},)"
            << R"({"buffer":0,"byteOffset":48,"byteLength":12},)"
            << R"({"buffer":0,"byteOffset":60,"byteLength":12}],"buffers":[{"byteLength":72,)"
            << R"("uri":"data:application/octet-stream;base64,)" << base64(bytes_) << R"("}])" << more << "}";
        return load_gltf((folder / "test.gltf").string());
    }

  private:
    std::string bytes_;
};

TEST(GltfLoader, MultipliesTransformsFromTheRootDown) {
    GltfFile file;
    // Scale in the child, then a quarter turn about z and a shift in the parent.
    file.nodes = R"({"children":[1],"rotation":[0,0,0.70710678,0.70710678],"translation":[10,0,0]},
                    {"mesh":0,"scale":[2,3,4]})";
    const Scene scene = file.load();
    ASSERT_EQ(scene.instances.size(), 1u);
    const glm::vec4 p = scene.instances[0].world_from_mesh * glm::vec4(1, 1, 1, 1);
    EXPECT_NEAR(p.x, 10 - 3, 1e-5);
    EXPECT_NEAR(p.y, 2, 1e-5);
    EXPECT_NEAR(p.z, 4, 1e-5);
}

TEST(GltfLoader, SharesAMeshBetweenTheNodesThatUseIt) {
    GltfFile file;
    file.nodes = R"({"mesh":0},{"mesh":0,"translation":[3,0,0]})";
    file.roots = "0,1";
    const Scene scene = file.load();
    EXPECT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.instances.size(), 2u);
    EXPECT_EQ(triangles_drawn(scene), 4u);
    EXPECT_FLOAT_EQ(world_bounds(scene).high.x, 4);
}

TEST(GltfLoader, PutsSparseValuesInPlace) {
    GltfFile file({2, 0, 0, 0, 0, 0});
    // Vertex 2 (the first of the 16-bit values) moves to (5, 6, 7).
    file.accessors = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":1,
        "indices":{"bufferView":1,"componentType":5123},"values":{"bufferView":2}}})";
    file.primitive = R"({"attributes":{"POSITION":0},"mode":6})";
    const Scene scene = file.load();
    EXPECT_EQ(world_bounds(scene).high, glm::vec3(5, 6, 7));
}

TEST(GltfLoader, UnrollsStripsAndFansKeepingTheirFacing) {
    for (int mode : {5, 6}) {
        GltfFile file;
        file.primitive = R"({"attributes":{"POSITION":0},"mode":)" + std::to_string(mode) + "}";
        const Scene scene = file.load();
        ASSERT_EQ(scene.indices.size(), 6u) << mode;
        // The fan 0 1 2 3 covers the square once, all facing +z. The strip 0 1 2 3 folds over the diagonal.
        const auto facing = [&](std::size_t i) {
            const glm::vec3 a = scene.vertices[scene.indices[i]].position,
                            b = scene.vertices[scene.indices[i + 1]].position,
                            c = scene.vertices[scene.indices[i + 2]].position;
            return glm::cross(b - a, c - a).z;
        };
        EXPECT_FLOAT_EQ(facing(0), 1) << mode;
        EXPECT_FLOAT_EQ(facing(3), mode == 6 ? 1 : -1) << mode;
    }
}

TEST(GltfLoader, GivesFlatNormalsWhereThereAreNone) {
    const Scene scene = GltfFile().load();
    for (const SceneVertex& v : scene.vertices) EXPECT_EQ(v.normal, glm::vec3(0, 0, 1));
}

TEST(GltfLoader, ReadsMaterialsWithTheirExtensions) {
    GltfFile file;
    file.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
    file.more =
        R"(,"extensionsUsed":["KHR_materials_ior"],"materials":[{"pbrMetallicRoughness":{"baseColorFactor":
        [0.1,0.2,0.3,0.4],"metallicFactor":0.25,"roughnessFactor":0.75},"emissiveFactor":[0.5,0,1],"alphaMode":"BLEND",
        "doubleSided":true,"extensions":{"KHR_materials_ior":{"ior":1.33},"KHR_materials_emissive_strength":
        {"emissiveStrength":4},"KHR_materials_transmission":{"transmissionFactor":0.9}}}])";
    const Scene scene = file.load();
    const Material& m = scene.materials[static_cast<std::size_t>(scene.meshes[0].material)];
    EXPECT_EQ(m.base_color, glm::vec4(0.1f, 0.2f, 0.3f, 0.4f));
    EXPECT_FLOAT_EQ(m.metallic, 0.25f);
    EXPECT_FLOAT_EQ(m.roughness, 0.75f);
    EXPECT_EQ(m.emissive, glm::vec3(2, 0, 4));
    EXPECT_EQ(m.alpha_mode, AlphaMode::blend);
    EXPECT_TRUE(m.double_sided);
    EXPECT_FLOAT_EQ(m.ior, 1.33f);
    EXPECT_FLOAT_EQ(m.transmission, 0.9f);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfLoader, ReadsLampsAndTheSun) {
    GltfFile file;
    file.roots = "0,1,2";
    file.nodes = R"({"mesh":0},{"translation":[1,2,3],"extensions":{"KHR_lights_punctual":{"light":0}}},
                    {"extensions":{"KHR_lights_punctual":{"light":1}}})";
    file.more = R"(,"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[
        {"type":"spot","color":[1,0.5,0],"intensity":8,"range":12,"spot":{"innerConeAngle":0.2,"outerConeAngle":0.6}},
        {"type":"directional","color":[1,1,1],"intensity":2}]}})";
    const Scene scene = file.load();
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].kind, LightKind::spot);
    EXPECT_EQ(scene.lights[0].position, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene.lights[0].direction, glm::vec3(0, 0, -1));
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(8, 4, 0));
    EXPECT_FLOAT_EQ(scene.lights[0].range_m, 12);
    EXPECT_FLOAT_EQ(scene.lights[0].outer_cone_rad, 0.6f);
    ASSERT_TRUE(scene.sun.has_value());
    EXPECT_EQ(scene.sun->direction, glm::vec3(0, 0, 1));
    EXPECT_EQ(scene.sun->irradiance, glm::vec3(2));
}

TEST(GltfLoader, TakesTheFilesCameraAndDropsItsScale) {
    GltfFile file;
    file.roots = "0,1";
    file.nodes = R"({"mesh":0},{"camera":0,"translation":[0,1,5],"scale":[2,2,2]})";
    file.more = R"(,"cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}}])";
    const Scene scene = file.load();
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_FLOAT_EQ(scene.cameras[0].vertical_fov_rad, 0.7f);
    EXPECT_EQ(glm::vec3(scene.cameras[0].world_from_camera[3]), glm::vec3(0, 1, 5));
    EXPECT_NEAR(glm::determinant(glm::mat3(scene.cameras[0].world_from_camera)), 1, 1e-5);
}

TEST(GltfLoader, NamesEverythingItDoesNotShowInOneWarning) {
    GltfFile file;
    file.primitive =
        R"({"attributes":{"POSITION":0},"indices":1,"material":0},{"attributes":{"POSITION":0},"mode":0})";
    file.more =
        R"(,"extensionsUsed":["KHR_materials_sheen"],"materials":[{"extensions":{"KHR_materials_sheen":{}}}])";
    const Scene scene = file.load();
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_EQ(scene.warnings[0], "not shown: KHR_materials_sheen, points and lines");
}

TEST(GltfLoader, RefusesAnExtensionThatTheFileCannotDoWithout) {
    GltfFile file;
    file.more =
        R"(,"extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"])";
    EXPECT_THROW(file.load(), std::runtime_error);
}

TEST(GltfLoader, NamesTheFirstOfItsBrokenImagesEveryTime) {
    GltfFile file;
    file.primitive = R"({"attributes":{"POSITION":0},"indices":1,"material":0})";
    // A transparent pixel, and three images that are none.
    const std::string pixel =
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg==";
    file.more =
        R"(,"materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0},"metallicRoughnessTexture":
        {"index":1}},"normalTexture":{"index":2},"emissiveTexture":{"index":3}}],"textures":[{"source":0},
        {"source":1},{"source":2},{"source":3}],"images":[{"name":"sound","uri":"data:image/png;base64,)" +
        pixel + R"("},{"name":"wood","uri":"data:image/png;base64,AAAA"},{"name":"stone","uri":
        "data:image/png;base64,AAAA"},{"name":"glass","uri":"data:image/png;base64,AAAA"}])";
    for (int i = 0; i < 50; ++i) {
        const std::string line = message_of([&] { file.load(); });
        ASSERT_NE(line.find("image 'wood' cannot be decoded ("), std::string::npos) << line;
    }
}

TEST(Tangents, PointAlongTheTexturesUWithTheBitangentUp) {
    Triangles square;
    for (const auto& [x, y] : {std::pair{0.0f, 0.0f}, {1.0f, 0.0f}, {1.0f, 1.0f}, {0.0f, 1.0f}}) {
        SceneVertex v;
        v.position = {x, y, 0};
        v.normal = {0, 0, 1};
        v.uv = {x, 1 - y};  // v points down in the texture
        square.vertices.push_back(v);
    }
    square.indices = {0, 1, 2, 0, 2, 3};
    make_tangents(square);
    for (const SceneVertex& v : square.vertices) {
        EXPECT_NEAR(glm::distance(glm::vec3(v.tangent), glm::vec3(1, 0, 0)), 0, 1e-6);
        const glm::vec3 bitangent = glm::cross(v.normal, glm::vec3(v.tangent)) * v.tangent.w;
        EXPECT_NEAR(glm::distance(bitangent, glm::vec3(0, 1, 0)), 0, 1e-6);
    }
}

TEST(Tangents, OfMirroredHalvesAreKeptApart) {
    // Two squares share an edge; the right one's texture runs backwards.
    Triangles mesh;
    for (const auto& [x, y, u] : {std::tuple{0.0f, 0.0f, 0.0f},
                                  {1.0f, 0.0f, 1.0f},
                                  {1.0f, 1.0f, 1.0f},
                                  {0.0f, 1.0f, 0.0f},
                                  {2.0f, 0.0f, 0.0f},
                                  {2.0f, 1.0f, 0.0f}}) {
        SceneVertex v;
        v.position = {x, y, 0};
        v.normal = {0, 0, 1};
        v.uv = {u, 1 - y};
        mesh.vertices.push_back(v);
    }
    mesh.indices = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
    make_tangents(mesh);
    ASSERT_EQ(mesh.vertices.size(), 8u);
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const SceneVertex& v = mesh.vertices[mesh.indices[i]];
        EXPECT_NEAR(v.tangent.x, i < 6 ? 1 : -1, 1e-6);
        EXPECT_FLOAT_EQ(v.tangent.w, i < 6 ? 1.0f : -1.0f);
    }
}

}  // namespace
}  // namespace parafovea
