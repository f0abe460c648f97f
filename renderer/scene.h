// A scene as plain data: geometry, materials, textures, lights, sky and cameras. Knows no graphics card.
// World space is right-handed, metres, y up, as in glTF 2.0; colours and radiances are linear RGB (Rec. 709
// primaries).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace parafovea {

struct SceneVertex {
    glm::vec3 position{0};
    glm::vec3 normal{0, 1, 0};
    glm::vec4 tangent{1, 0, 0, 1};  // w: handedness of the bitangent, +1 or -1
    glm::vec2 uv{0};
    glm::u8vec4 color{255};  // linear, multiplies the base colour
};

struct Bounds {
    glm::vec3 low{1e30f};
    glm::vec3 high{-1e30f};

    bool empty() const { return low.x > high.x; }
    glm::vec3 centre() const { return 0.5f * (low + high); }
    float radius() const { return empty() ? 0 : 0.5f * glm::length(high - low); }
    void add(glm::vec3 p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

// A run of triangles of one material, in its own space. Its indices count from `first_vertex`.
struct SceneMesh {
    std::uint32_t first_index = 0;
    std::uint32_t index_count = 0;
    std::uint32_t first_vertex = 0;
    std::uint32_t vertex_count = 0;
    int material = 0;
    Bounds bounds;
};

struct SceneInstance {
    int mesh = 0;
    glm::mat4 world_from_mesh{1};
};

struct SceneImage {
    std::string name;
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgba;  // rows from the top, 4 bytes a pixel
};

enum class TextureWrap { repeat, mirror, clamp };

// An image and how it is read. `srgb`: the RGB bytes are sRGB encoded; they are decoded when sampled.
struct SceneTexture {
    int image = 0;
    bool srgb = false;
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
    bool nearest = false;
};

// A material's reference to a texture; texture < 0 means none. The position looked up is
// offset + rotation * (scale * uv), as KHR_texture_transform orders them.
struct TextureSlot {
    int texture = -1;
    glm::vec2 offset{0};
    glm::vec2 scale{1};
    float rotation_rad = 0;

    explicit operator bool() const { return texture >= 0; }
};

enum class AlphaMode { opaque, mask, blend };

// glTF 2.0 metallic-roughness material (specification, 3.9), with the extensions the renderer models.
struct Material {
    std::string name;
    glm::vec4 base_color{1};
    float metallic = 1;
    float roughness = 1;
    float normal_scale = 1;
    float occlusion_strength = 1;
    glm::vec3 emissive{0};  // radiance, KHR_materials_emissive_strength included
    TextureSlot base_color_texture;
    TextureSlot metallic_roughness_texture;  // G roughness, B metallic
    TextureSlot normal_texture;
    TextureSlot occlusion_texture;  // R
    TextureSlot emissive_texture;
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    float ior = 1.5f;        // KHR_materials_ior
    float transmission = 0;  // KHR_materials_transmission, 0 to 1
};

struct Sun {
    glm::vec3 direction{0, 1, 0};  // from the scene to the sun, unit length
    glm::vec3 irradiance{3};       // on a surface facing it
    bool casts_shadow = true;
};

// A clear sky: radiance by elevation, a horizon band, and the ground's mean radiance below it.
struct Sky {
    glm::vec3 zenith{0.25f, 0.45f, 0.9f};
    glm::vec3 horizon{0.8f, 0.85f, 0.9f};
    glm::vec3 ground{0.25f, 0.23f, 0.2f};
};

enum class LightKind { point, spot };

// KHR_lights_punctual. Intensity is radiant intensity in the units of Sun::irradiance times metres squared.
struct PunctualLight {
    LightKind kind = LightKind::point;
    glm::vec3 position{0};
    glm::vec3 direction{0, -1, 0};  // spot: where it shines
    glm::vec3 intensity{1};
    float range_m = 0;  // 0: unlimited
    float inner_cone_rad = 0;
    float outer_cone_rad = 0.785398f;
    bool casts_shadow = false;
};

// Looks along its own -z, y up.
struct SceneCamera {
    std::string name;
    glm::mat4 world_from_camera{1};
    float vertical_fov_rad = 1.0f;
    float near_m = 0.05f;
};

// One point of a fly-through: where the camera is and looks, at a time from its start.
struct CameraKey {
    float time_s = 0;
    glm::vec3 position{0};
    glm::vec3 target{0, 0, -1};
};

struct Scene {
    std::string name;
    bool ray_marched = false;  // drawn from signed distances; no meshes
    std::vector<SceneVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<SceneMesh> meshes;
    std::vector<SceneInstance> instances;
    std::vector<Material> materials;
    std::vector<SceneImage> images;
    std::vector<SceneTexture> textures;
    std::optional<Sun> sun;
    Sky sky;
    std::vector<PunctualLight> lights;
    std::vector<SceneCamera> cameras;   // never empty after load_scene
    std::vector<CameraKey> path;        // empty, or at least two keys in rising time
    float exposure = 1;                 // multiplies radiance before the tone curve
    double load_s = 0;                  // how long load_scene took
    std::vector<std::string> warnings;  // what the file asks for and the renderer does not model
};

// What the renderer must model to draw a scene; everything else is left out.
struct SceneFeatures {
    bool normal_maps = false;
    bool alpha_mask = false;
    bool alpha_blend = false;
    bool emission = false;
    bool occlusion_maps = false;
    bool transmission = false;
    bool vertex_colors = false;
    bool sun = false;
    bool sun_shadow = false;
    int punctual_lights = 0;
};

SceneFeatures features_of(const Scene& scene);
std::uint64_t triangles_drawn(const Scene& scene);  // every instance counted
Bounds world_bounds(const Scene& scene);
Bounds transformed(const Bounds& bounds, const glm::mat4& matrix);  // a box around the transformed box
SceneCamera camera_looking(glm::vec3 from, glm::vec3 at, float vertical_fov_rad);
// The camera on the scene's path; time is clamped to the path. The scene must have a path.
SceneCamera camera_on_path(const Scene& scene, float time_s);

}  // namespace parafovea
