// Full resolution: one sample per pixel, the reference of every comparison.
#pragma once

#include "renderer/methods/foveation_method.h"

namespace parafovea {

class FullMethod : public FoveationMethod {
  public:
    FullMethod(Gpu& gpu, const ShadingSource& source, VkFormat target_format);

    void configure(const RenderMethod& method) override;
    void prepare(SizePx screen, PointPx gaze) override;
    void record(const MethodFrame& frame) override;
    MethodStatistics statistics() const override;

  private:
    OwnedPipelineLayout layout_;
    OwnedPipeline pipeline_;
    SizePx screen_;
};

}  // namespace parafovea
