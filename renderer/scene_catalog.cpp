// Finds a scene by its name or its file.
#include "renderer/scene_catalog.h"

#include <chrono>
#include <filesystem>
#include <stdexcept>

#include "renderer/atrium.h"
#include "renderer/gltf_loader.h"
#include "renderer/primitives_scene.h"
#include "renderer/street.h"

namespace parafovea {

namespace {

Scene made_or_read(const std::string& name_or_path) {
    if (name_or_path == "atrium") return make_atrium_scene();
    if (name_or_path == "primitives") return make_primitives_scene();
    if (name_or_path == "street") return make_street_scene();
    const std::string ending = std::filesystem::path(name_or_path).extension().string();
    if (ending == ".gltf" || ending == ".glb") return load_gltf(name_or_path);
    throw std::runtime_error("there is no scene '" + name_or_path +
                             "'; expected primitives, atrium, street, or a .gltf or .glb file");
}

}  // namespace

Scene load_scene(const std::string& name_or_path) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    Scene scene = made_or_read(name_or_path);
    scene.load_s = std::chrono::duration<double>(Clock::now() - start).count();
    return scene;
}

SceneSummary summarise(const Scene& scene) {
    const SceneFeatures f = features_of(scene);
    SceneSummary summary{scene.name, triangles_drawn(scene), (f.sun ? 1 : 0) + f.punctual_lights, {}};
    const auto has = [&](bool it_has, const char* feature) {
        if (it_has) summary.features.emplace_back(feature);
    };
    has(scene.ray_marched, "ray-marched");
    has(scene.ray_marched, "soft shadows");
    has(scene.ray_marched, "ambient occlusion");
    has(!scene.ray_marched && f.sun_shadow, "sun shadow");
    has(f.normal_maps, "normal maps");
    has(f.alpha_mask, "alpha masks");
    has(f.alpha_blend, "blended surfaces");
    has(f.transmission, "transmission");
    has(f.emission, "emission");
    has(f.occlusion_maps, "occlusion maps");
    has(f.vertex_colors, "vertex colours");
    has(!scene.path.empty(), "camera path");
    return summary;
}

std::vector<SceneSummary> scene_catalog() {
    return {summarise(load_scene("primitives")), summarise(load_scene("atrium")),
            summarise(load_scene("street"))};
}

}  // namespace parafovea
