// Reads glTF 2.0 files (.gltf with its side files, or .glb) into a Scene.
#pragma once

#include <string>

#include "renderer/scene.h"

namespace parafovea {

// Geometry, materials, textures, cameras and lights of the file's default scene. What the renderer does not
// model is named in Scene::warnings, in one line. A file without lights gets a sun and a sky; one without
// cameras a camera that frames it. Throws std::runtime_error with one line when the file is missing, broken
// or needs an extension that is not supported.
Scene load_gltf(const std::string& path);

}  // namespace parafovea
