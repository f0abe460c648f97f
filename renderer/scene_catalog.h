// The scenes the program can show: the built-in ones by name, everything else by its file.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/scene.h"

namespace parafovea {

// A built-in name, or the path of a glTF 2.0 file (.gltf or .glb). Throws std::runtime_error with one line if
// there is no such scene or the file is broken.
Scene load_scene(const std::string& name_or_path);

struct SceneSummary {
    std::string name;
    std::uint64_t triangles = 0;  // 0: ray-marched
    int lights = 0;               // the sun and the punctual lights
    std::vector<std::string> features;
};

// Every built-in scene.
std::vector<SceneSummary> scene_catalog();
SceneSummary summarise(const Scene& scene);

}  // namespace parafovea
