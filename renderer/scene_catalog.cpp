// Finds a scene by its name or its file.
#include "renderer/scene_catalog.h"

#include <stdexcept>

#include "renderer/primitives_scene.h"

namespace parafovea {

Scene load_scene(const std::string& name_or_path) {
    if (name_or_path == "primitives") return make_primitives_scene();
    throw std::runtime_error("there is no scene '" + name_or_path + "'");
}

}  // namespace parafovea
