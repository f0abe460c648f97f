// The needed texels of a reduced buffer, listed on the device, so that compute shaders take one after
// another.
#pragma once

#include <cstdint>

#include "devices/geometry.h"
#include "renderer/gpu_pipeline.h"

namespace parafovea {

class TexelList {
  public:
    // What texel_list.glsl declares, for sets of shaders that read a list.
    static constexpr Binding kHeaderBinding{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};
    static constexpr Binding kListBinding{1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};

    // The shaders that make lists; one for all lists.
    struct Maker {
        explicit Maker(Gpu& gpu);

        DescriptorSet set;  // for its layout
        OwnedPipelineLayout layout;
        OwnedPipeline words;
        OwnedPipeline rows;
        OwnedPipeline list;
        OwnedSampler nearest;
    };

    // Of a mask: a depth image that is above 0 where a texel is needed.
    TexelList(Gpu& gpu, const Maker& maker, const GpuImage& mask);

    void bind_to(DescriptorSet& reading) const;

    // Outside rendering, with the mask in kUseSampled: makes the list. Then compute shaders may read it.
    void record(VkCommandBuffer commands, const Maker& maker) const;

    // Runs a compute shader in groups of kTexelsPerGroup, whose pipeline and sets are bound, over the list.
    void dispatch(VkCommandBuffer commands) const;

  private:
    std::uint32_t height_, words_of_row_;
    GpuBuffer header_;
    GpuImage listed_;
    GpuBuffer words_;
    GpuBuffer first_of_row_;
    VkSampler nearest_;
    DescriptorSet set_;
};

}  // namespace parafovea
