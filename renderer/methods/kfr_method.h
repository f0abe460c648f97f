// Kernel foveated rendering (Meng, Du, Zwicker, Varshney 2018): shade a reduced log-polar buffer, then
// stretch it over the screen. With exact culling: texels that no pixel reads are not shaded, and the picture
// is the same.
#pragma once

#include <optional>

#include "renderer/kernel_setting.h"
#include "renderer/methods/foveation_method.h"

namespace parafovea {

struct KfrSetting {
    KernelSetting kernel;
    bool culling = true;          // shade only texels that are read
    bool internal_filter = true;  // 3x3 Gaussian over the peripheral half of the buffer
    bool post_filter = false;     // Eq. 14 on the screen
    int post_filter_cap = 11;     // its largest width in pixels, odd

    bool operator==(const KfrSetting&) const = default;
};

// Parameters: those of MethodParameters::kernel(), culling, internal_filter, post_filter, post_filter_cap.
KfrSetting kfr_setting(const RenderMethod& method);

// How the result is stored.
struct KfrFormats {
    VkFormat target = VK_FORMAT_R8G8B8A8_SRGB;
    VkFormat reduced =
        VK_FORMAT_R16G16B16A16_UNORM;  // display-linear values in [0, 1]; finer than halves near 1
    bool exact_bilinear = false;  // Pass II interpolates with full float weights instead of the sampler's
};

class KfrMethod : public FoveationMethod {
  public:
    KfrMethod(Gpu& gpu, const ShadingSource& source, const KfrFormats& formats);

    void configure(const RenderMethod& method) override;
    void configure(const KfrSetting& setting);  // already checked
    void prepare(SizePx screen, PointPx gaze) override;
    void record(const MethodFrame& frame) override;
    MethodStatistics statistics() const override;

  private:
    void make_targets();
    void make_pipelines();
    void record_mask(VkCommandBuffer commands);
    void record_shading(const MethodFrame& frame);
    void record_internal_filter(VkCommandBuffer commands);
    void record_resampling(VkCommandBuffer commands, const GpuImage& target);

    Gpu& gpu_;
    ShadingSource source_;
    KfrFormats formats_;
    KfrSetting setting_;
    SizePx screen_;
    PointPx gaze_;
    SizePx buffer_;
    bool map_stale_ = true;
    bool mask_stale_ = true;
    bool pipelines_stale_ = true;
    bool reduced_fresh_ = true;  // the buffer's images have never been written
    bool screen_fresh_ = true;

    GpuBuffer map_;
    GpuImage mask_;           // depth 1 where a texel is needed, else 0
    GpuImage reduced_;        // what Pass I shades and Pass II reads
    GpuImage filtered_;       // the internal filter's result, then copied to reduced_
    GpuImage screen_linear_;  // Pass II's result for the post filter
    OwnedQueryPool needed_count_;

    OwnedSampler sampler_;
    DescriptorSet map_set_;
    DescriptorSet reduced_set_;  // for the internal filter
    DescriptorSet resample_set_;
    DescriptorSet post_set_;
    OwnedPipelineLayout mask_layout_;
    OwnedPipelineLayout shading_layout_;
    OwnedPipelineLayout filter_layout_;
    OwnedPipelineLayout resample_layout_;
    OwnedPipelineLayout post_layout_;
    OwnedPipeline mask_pipeline_;
    OwnedPipeline shading_pipeline_;
    OwnedPipeline filter_pipeline_;
    OwnedPipeline resample_pipeline_;
    OwnedPipeline post_pipeline_;
};

}  // namespace parafovea
