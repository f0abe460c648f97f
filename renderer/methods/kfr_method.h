// Kernel foveated rendering (Meng, Du, Zwicker, Varshney 2018): shade a reduced log-polar buffer, then
// stretch it over the screen. With exact culling: texels that no pixel reads are not shaded, those that must
// look alike are shaded once, and the picture is the same.
#pragma once

#include <array>
#include <cstdint>
#include <list>
#include <map>

#include "renderer/methods/kfr_targets.h"

namespace parafovea {

// Parameters: those of MethodParameters::kernel(), culling, internal_filter, post_filter, post_filter_cap,
// inset.
KfrSetting kfr_setting(const RenderMethod& method);

class KfrMethod : public FoveationMethod {
  public:
    KfrMethod(Gpu& gpu, const ShadingSource& source, const KfrFormats& formats);

    void configure(const RenderMethod& method) override;
    void configure(const KfrSetting& setting);  // already checked
    void prepare(SizePx screen, PointPx gaze) override;
    void record(const MethodFrame& frame) override;
    SampleSpacing spacing_at(PointPx position) const override;
    MethodStatistics statistics() const override;

  private:
    struct Pipelines {
        OwnedPipeline mask;
        OwnedPipeline shading;  // in compute shaders: of a list
        OwnedPipeline pixels;
        OwnedPipeline fine;
        OwnedPipeline filter_u;
        OwnedPipeline filter_v;
        OwnedPipeline resample;
        OwnedPipeline post;
        OwnedPipeline inset;
    };
    // What pipelines depend on: sigma, alpha and the betas are read at run time.
    using PipelineKey = std::array<std::uint32_t, 8>;

    PipelineKey pipeline_key() const;
    Pipelines make_pipelines() const;
    void record_mask(const MethodFrame& frame);
    void record_shading(const MethodFrame& frame);
    void record_listed_shading(const MethodFrame& frame);
    void record_fine_columns(const MethodFrame& frame);
    void record_internal_filter(VkCommandBuffer commands);
    void record_resampling(const MethodFrame& frame, const GpuImage& target);

    Gpu& gpu_;
    ShadingSource source_;
    KfrFormats formats_;
    KfrSetting setting_;
    KfrLayouts layouts_;
    TexelList::Maker list_maker_;
    std::map<PipelineKey, Pipelines> pipelines_;
    std::list<KfrTargets> targets_;  // the last used first, so that settings may take turns
    Pipelines* now_ = nullptr;       // what prepare() chose
};

}  // namespace parafovea
