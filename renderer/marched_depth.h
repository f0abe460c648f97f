// How far away a ray-marched scene is, so that what was drawn before can be followed in a moving view. A
// quarter as fine as the screen along each side: a sixteenth of the primary rays, without any shading.
#pragma once

#include "renderer/methods/foveation_method.h"

namespace parafovea {

class MarchedDepth {
  public:
    // `source` is that of the methods that draw the scene.
    MarchedDepth(Gpu& gpu, const ShadingSource& source);

    // Records the marching for a screen, outside rendering. No frame may be running.
    void record(VkCommandBuffer commands, VkDescriptorSet shading_set, VkExtent2D screen);

    // Reversed depth as shared/camera.h has it; in kUseSampled after record().
    const GpuImage& image() const { return image_; }

  private:
    Gpu& gpu_;
    OwnedPipelineLayout layout_;
    OwnedPipeline pipeline_;
    GpuImage image_;
};

}  // namespace parafovea
