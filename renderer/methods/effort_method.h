// Full resolution with cheaper samples away from the gaze: fewer occlusion samples or fewer steps along rays
// (Swafford et al. 2016, methods 2 and 4). Only ray-marched scenes have such loops; any other scene is drawn
// as it is.
#pragma once

#include "renderer/methods/foveation_method.h"
#include "renderer/shared/effort.h"

namespace parafovea {

enum class SavedEffort { occlusion, steps };

// Parameters: mar_slope (how fast the effort falls, for each shorter side of the screen of distance),
// mar_start (from where on, share of that side), least (no less than this share). Slope and start are those
// of a screen one pixel wide.
shared::EffortFalloff effort_falloff(const RenderMethod& method);

class EffortMethod : public FoveationMethod {
  public:
    EffortMethod(Gpu& gpu, const ShadingSource& source, VkFormat target_format, SavedEffort saved);

    void configure(const RenderMethod& method) override;
    void prepare(SizePx screen, PointPx gaze) override;
    void record(const MethodFrame& frame) override;
    MethodStatistics statistics() const override;

  private:
    bool has_loops_;
    SavedEffort saved_;
    DescriptorSet set_;  // 0: falloff
    GpuBuffer block_;
    OwnedPipelineLayout layout_;
    OwnedPipeline pipeline_;
    shared::EffortFalloff falloff_{};
    SizePx screen_;
};

}  // namespace parafovea
