// Contrast preservation for any foveated picture: what blur takes from the periphery's contrast is given
// back.
//
// Source: Patney et al. 2016, "Towards Foveated Rendering for Gaze-Tracked Virtual Reality", supplement,
// section 1: its code, whose gain is 1 + f_e |sigma|, not its printed formula, which is not 1 in the fovea.
// sigma, the degree of foveation, is half of what the method's samples lie farther apart than pixels,
// radially and tangentially; the mean is a separable Gaussian of 2 |sigma|, at most 8 pixels. A method that
// samples every pixel is left as it is.
#pragma once

#include "renderer/spacing_grid.h"

namespace parafovea {

class ContrastStage {
  public:
    ContrastStage(Gpu& gpu, VkFormat target_format);

    // Records both passes, outside rendering. No frame may be running. `picture` is in kUseSampled, `target`,
    // of the same size, in kUseColorTarget before and after.
    void record(VkCommandBuffer commands, const GpuImage& picture, const SpacingGrid& spacing,
                double gain_per_px, const GpuImage& target);

  private:
    OwnedSampler sampler_;
    DescriptorSet set_;
    OwnedPipelineLayout layout_;
    OwnedPipeline mean_pipeline_;
    OwnedPipeline boost_pipeline_;
    GpuBuffer spacing_;
    Gpu& gpu_;
    GpuImage mean_of_rows_;
    bool mean_is_new_ = true;
};

}  // namespace parafovea
