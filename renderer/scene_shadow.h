// The sun's shadow map of a whole scene, drawn once and kept while the scene stands still.
#pragma once

#include "renderer/scene_resources.h"

namespace parafovea {

class SunShadow {
  public:
    // The map covers every instance; its matrix, texture position and depth from world, goes to the lighting
    // block.
    SunShadow(Gpu& gpu, const SceneResources& resources, glm::vec3 to_sun);

    const GpuImage& map() const { return map_; }
    const glm::mat4& map_from_world() const { return map_from_world_; }
    float texel_m() const { return texel_m_; }

    // Draws the map; afterwards it can be sampled.
    void record(VkCommandBuffer commands, Gpu& gpu, SceneResources& resources) const;

  private:
    GpuImage map_;
    glm::mat4 clip_from_world_{1};
    glm::mat4 map_from_world_{1};
    float texel_m_ = 0;
};

// Pushes what the geometry shaders need of an instance.
void push_instance(VkCommandBuffer commands, const SceneResources& resources, const DrawInstance& instance,
                   const glm::mat4& clip_from_world);

}  // namespace parafovea
