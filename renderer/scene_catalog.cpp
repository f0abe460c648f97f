// Finds a scene by its name or its file.
#include "renderer/scene_catalog.h"

#include <filesystem>
#include <stdexcept>

#include "renderer/gltf_loader.h"
#include "renderer/primitives_scene.h"

namespace parafovea {

Scene load_scene(const std::string& name_or_path) {
    if (name_or_path == "primitives") return make_primitives_scene();
    const std::string ending = std::filesystem::path(name_or_path).extension().string();
    if (ending == ".gltf" || ending == ".glb") return load_gltf(name_or_path);
    throw std::runtime_error("there is no scene '" + name_or_path +
                             "'; expected primitives, atrium, or a .gltf or .glb file");
}

}  // namespace parafovea
