// Light and camera of the ray-marched court.
#include "renderer/primitives_scene.h"

namespace parafovea {

Scene make_primitives_scene() {
    Scene scene;
    scene.name = "primitives";
    scene.ray_marched = true;
    scene.sun = Sun{glm::normalize(glm::vec3(0.42f, 0.80f, 0.52f)), glm::vec3(3.3f, 3.05f, 2.7f), true};
    scene.sky = Sky{{0.20f, 0.36f, 0.70f}, {0.62f, 0.70f, 0.80f}, {0.22f, 0.19f, 0.16f}};
    scene.exposure = 0.72f;
    scene.cameras.push_back(camera_looking({0, 2.1f, 6.6f}, {0, 0.55f, -1.4f}, 1.17f));
    scene.cameras.front().name = "court";
    scene.path = {{0, {0, 2.1f, 6.6f}, {0, 0.55f, -1.4f}},
                  {3, {-2.4f, 1.9f, 5.6f}, {0.6f, 0.6f, -1.4f}},
                  {6, {-2.8f, 1.6f, 4.4f}, {1.6f, 0.7f, -1.2f}},
                  {9, {2.6f, 1.7f, 5.0f}, {-0.8f, 0.7f, -1.4f}},
                  {12, {0, 2.1f, 6.6f}, {0, 0.55f, -1.4f}}};
    return scene;
}

}  // namespace parafovea
