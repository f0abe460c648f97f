// Shadow maps, drawn once and kept while the scene stands still: the sun's of the whole scene, and the
// lamps'.
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

// Shadow maps of the lamps that cast shadows, as far as there are layers: spot lamps, seen along their cones,
// drawn once.
class LampShadows {
  public:
    LampShadows(Gpu& gpu, const std::vector<PunctualLight>& lights);

    const GpuImage& maps() const { return maps_; }
    // The layer of each light, -1 for none; and each layer's clip space from the world.
    const std::vector<int>& layers() const { return layers_; }
    const std::vector<glm::mat4>& clip_from_world() const { return clip_from_world_; }

    void record(VkCommandBuffer commands, Gpu& gpu, SceneResources& resources) const;

  private:
    std::vector<int> layers_;
    std::vector<glm::mat4> clip_from_world_;
    GpuImage maps_;
    std::vector<OwnedImageView> views_;
};

// False only if the box lies wholly outside one of the frustum's planes, the near one left aside.
bool may_be_seen(const Bounds& box, const glm::mat4& clip_from_world);

}  // namespace parafovea
