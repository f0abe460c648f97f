// glTF files of every kind: sound ones load whole, broken ones are refused in one line, none crashes.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "devices/random.h"
#include "renderer/gltf_loader.h"
#include "renderer/scene_catalog.h"
#include "tests/message_of.h"
#include "tests/temporary_folder.h"

namespace parafovea {
namespace {

namespace fs = std::filesystem;

fs::path shared_scenes() {
    return fs::path(PARAFOVEA_SHARED_DIR) / "scenes";
}

std::string refusal(const fs::path& file) {
    return message_of([&] { load_scene(file.string()); });
}

// Whatever loads must hold together: the renderer trusts it.
void expect_consistent(const Scene& scene) {
    ASSERT_FALSE(scene.cameras.empty());
    for (const SceneInstance& i : scene.instances)
        ASSERT_LT(static_cast<std::size_t>(i.mesh), scene.meshes.size());
    for (const SceneMesh& m : scene.meshes) {
        ASSERT_LT(static_cast<std::size_t>(m.material), scene.materials.size());
        ASSERT_LE(std::size_t{m.first_index} + m.index_count, scene.indices.size());
        ASSERT_LE(std::size_t{m.first_vertex} + m.vertex_count, scene.vertices.size());
        ASSERT_EQ(m.index_count % 3, 0u);
        for (std::uint32_t k = 0; k < m.index_count; ++k)
            ASSERT_LT(scene.indices[m.first_index + k], m.vertex_count);
    }
    for (const SceneVertex& v : scene.vertices) {
        ASSERT_TRUE(std::isfinite(v.position.x + v.position.y + v.position.z));
        ASSERT_NEAR(glm::length(v.normal), 1, 1e-3);
    }
    for (const SceneTexture& t : scene.textures)
        ASSERT_LT(static_cast<std::size_t>(t.image), scene.images.size());
    for (const SceneImage& i : scene.images)
        ASSERT_EQ(i.rgba.size(), static_cast<std::size_t>(i.width) * static_cast<std::size_t>(i.height) * 4);
}

struct Sound {
    const char* file;
    std::uint64_t triangles;
    std::size_t images;
};

class SoundFiles : public testing::TestWithParam<Sound> {};

TEST_P(SoundFiles, LoadWithAllTheirTrianglesAndImages) {
    const fs::path file = shared_scenes() / GetParam().file;
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
    const Scene scene = load_scene(file.string());
    EXPECT_EQ(triangles_drawn(scene), GetParam().triangles);
    EXPECT_EQ(scene.images.size(), GetParam().images);
    expect_consistent(scene);
}

// Triangle counts as the files' index accessors and node lists give them.
INSTANTIATE_TEST_SUITE_P(
    Conformance, SoundFiles,
    testing::Values(Sound{"country_kitchen/country_kitchen.glb", 1021734, 13},
                    Sound{"aws_small_house/aws_small_house.glb", 145844, 83},
                    Sound{"conformance/BoxInterleaved/glTF-Binary/BoxInterleaved.glb", 12, 0},
                    Sound{"conformance/BoxTextured/glTF/BoxTextured.gltf", 12, 1},
                    Sound{"conformance/CesiumMilkTruck/glTF-Binary/CesiumMilkTruck.glb", 3624, 1},
                    Sound{"conformance/Duck/glTF-Binary/Duck.glb", 4212, 1},
                    Sound{"conformance/SimpleSparseAccessor/glTF-Embedded/SimpleSparseAccessor.gltf", 12, 0},
                    Sound{"conformance/SimpleMeshes/glTF/SimpleMeshes.gltf", 2, 0},
                    Sound{"conformance/TriangleWithoutIndices/glTF/TriangleWithoutIndices.gltf", 1, 0},
                    Sound{"conformance/BoxVertexColors/glTF-Binary/BoxVertexColors.glb", 12, 0},
                    Sound{"conformance/Cameras/glTF/Cameras.gltf", 2, 0}));

TEST(EveryConformanceFile, LoadsConsistentlyOrIsRefusedInOneLine) {
    const fs::path root = shared_scenes() / "conformance";
    if (!fs::exists(root)) GTEST_SKIP() << root << " is not there";
    int loaded = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root)) {
        const std::string ending = entry.path().extension().string();
        if (ending != ".gltf" && ending != ".glb") continue;
        SCOPED_TRACE(entry.path());
        try {
            expect_consistent(load_scene(entry.path().string()));
            ++loaded;
        } catch (const std::runtime_error& e) {
            const std::string line = e.what();
            EXPECT_EQ(line.find('\n'), std::string::npos) << line;
            EXPECT_NE(line.find(entry.path().filename().string()), std::string::npos) << line;
        }
    }
    EXPECT_GE(loaded, 18);
}

struct Broken {
    const char* file;
    const char* reason;  // a part of the line
};

class BrokenFiles : public testing::TestWithParam<Broken> {};

TEST_P(BrokenFiles, AreRefusedWithTheReason) {
    const fs::path file = shared_scenes() / "conformance/assimp" / GetParam().file;
    if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
    const std::string line = refusal(file);
    EXPECT_NE(line.find(GetParam().reason), std::string::npos) << line;
}

INSTANTIATE_TEST_SUITE_P(
    Assimp, BrokenFiles,
    testing::Values(Broken{"BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "not finite"},
                    Broken{"IndexOutOfRange/IndexOutOfRange.gltf", "index 255 is out of range"},
                    Broken{"IndexOutOfRange/AllIndicesOutOfRange.gltf", "index 65535 is out of range"},
                    Broken{"IncorrectVertexArrays/Cube.gltf", "do not make whole triangles"},
                    Broken{"MissingBin/BoxTextured.gltf", "BoxTextured0.bin"},
                    Broken{"SchemaFailures/sceneWrongType.gltf", "scene: a whole number"},
                    Broken{"wrongTypes/badArray.gltf", "meshes[0].primitives: a list expected"},
                    Broken{"wrongTypes/badExtension.gltf", "KHR_texture_transform: an object expected"},
                    Broken{"wrongTypes/badNumber.gltf", "NormalTextureInfo"},
                    Broken{"wrongTypes/badObject.gltf", "pbrMetallicRoughness: an object expected"},
                    Broken{"wrongTypes/badString.gltf", "scenes[0].name: text expected"},
                    Broken{"wrongTypes/badUint.gltf", "index: a whole number of at least 0"},
                    Broken{"RecursiveNodes/RecursiveNodes.gltf", "its own ancestor"},
                    Broken{"TestNoRootNode/NoScene.gltf", "no triangles"},
                    Broken{"TestNoRootNode/SceneWithoutNodes.gltf", "no triangles"}));

TEST(MissingFiles, AreNamed) {
    EXPECT_NE(
        refusal("/nowhere/at/all.glb").find("/nowhere/at/all.glb: cannot be shown: there is no such file"),
        std::string::npos);
    EXPECT_NE(refusal("atriun").find("there is no scene 'atriun'"), std::string::npos);
}

class DamagedFiles : public testing::Test {
  protected:
    void SetUp() override {
        const fs::path file =
            shared_scenes() / "conformance/BoxTexturedNonPowerOfTwo/glTF-Binary/BoxTextured.glb";
        if (!fs::exists(file)) GTEST_SKIP() << file << " is not there";
        bytes_ = text_of(file);
    }

    void load(const std::string& bytes) {
        const fs::path damaged = folder_.write("damaged.glb", bytes);
        try {
            expect_consistent(load_scene(damaged.string()));
        } catch (const std::runtime_error& e) {
            EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
        }
    }

    TemporaryFolder folder_;
    std::string bytes_;
};

TEST_F(DamagedFiles, OfAnyLengthAreRefused) {
    for (std::size_t length = 0; length < bytes_.size(); length += 1 + length / 40) {
        EXPECT_NE(refusal(folder_.write("damaged.glb", bytes_.substr(0, length))), "")
            << "cut to " << length << " bytes";
    }
}

TEST_F(DamagedFiles, WithFlippedBytesLoadConsistentlyOrAreRefused) {
    Random random(20180501);
    for (int i = 0; i < 400; ++i) {
        std::string bytes = bytes_;
        // The JSON chunk is where damage is most confusing.
        const std::size_t at = random.below(i % 2 == 0 ? 2000 : bytes.size());
        bytes[at] = static_cast<char>(random.below(256));
        SCOPED_TRACE("byte " + std::to_string(at));
        load(bytes);
    }
}

}  // namespace
}  // namespace parafovea
