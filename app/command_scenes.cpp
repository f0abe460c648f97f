// parafovea scenes: the built-in scenes.
#include <cstdio>
#include <string>

#include "app/commands.h"
#include "renderer/scene_catalog.h"

namespace parafovea {

ScenesCommand::ScenesCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("scenes", "List the built-in scenes with triangles, lights and features");
    command->footer("Example: parafovea scenes");
    command->callback([this] { run(); });
}

void ScenesCommand::run() const {
    std::printf("%-12s %10s %7s  %s\n", "scene", "triangles", "lights", "features");
    for (const SceneSummary& scene : scene_catalog()) {
        const std::string triangles = scene.triangles == 0 ? "ray-marched" : std::to_string(scene.triangles);
        std::string features;
        for (const std::string& feature : scene.features)
            features += (features.empty() ? "" : ", ") + feature;
        std::printf("%-12s %11s %6d  %s\n", scene.name.c_str(), triangles.c_str(), scene.lights,
                    features.c_str());
    }
    std::printf("\nAny glTF 2.0 file (.gltf, .glb) can be named in place of a built-in scene.\n");
}

}  // namespace parafovea
