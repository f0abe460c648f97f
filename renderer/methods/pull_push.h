// Fills the gaps of a picture of which only some pixels are known: Gortler et al. 1996, "The Lumigraph",
// Section 3.4.
#pragma once

#include <vector>

#include "devices/geometry.h"
#include "renderer/gpu_pipeline.h"

namespace parafovea {

class PullPush {
  public:
    // For pictures like `sparse`, whose alpha is 1 where a pixel is known and 0 elsewhere.
    PullPush(Gpu& gpu, const GpuImage& sparse, VkFormat target_format);

    // Fills `target`, which is in kUseColorTarget before and after; `sparse` is in kUseSampled.
    void record(VkCommandBuffer commands, const GpuImage& target);

  private:
    struct Level {
        GpuImage pulled;     // means of four, alpha: known
        GpuImage pushed;     // the same, filled; the coarsest level has none
        DescriptorSet pull;  // 0: the finer level
        DescriptorSet push;  // 0: this level, 1: the coarser one, filled
    };

    std::vector<Level> levels_;  // half the size, a quarter, ... one pixel
    OwnedSampler nearest_;
    OwnedSampler linear_;
    DescriptorSet last_push_;  // 0: the sparse picture, 1: the first level, filled
    OwnedPipelineLayout pull_layout_;
    OwnedPipelineLayout push_layout_;
    OwnedPipeline pull_;
    OwnedPipeline push_;
    OwnedPipeline push_to_target_;
    bool fresh_ = true;
};

}  // namespace parafovea
