// Every method whose samples lie on a grid of renderer/shared/sample_grid.h: shade the samples that pixels
// read, then let every pixel read them. What a method does is said by its plan.
#pragma once

#include <array>
#include <cstdint>
#include <list>
#include <map>
#include <memory>

#include "renderer/methods/grid_targets.h"

namespace parafovea {

class GridMethod : public FoveationMethod {
  public:
    GridMethod(Gpu& gpu, const ShadingSource& source, const GridFormats& formats, GridPlanner planner);

    void configure(const RenderMethod& method) override;
    void prepare(SizePx screen, PointPx gaze) override;
    void record(const MethodFrame& frame) override;
    SampleSpacing spacing_at(PointPx position) const override;
    MethodStatistics statistics() const override;

  private:
    struct Pipelines {
        std::array<OwnedPipeline, 2> mask;  // of each round
        OwnedPipeline detail;               // tiles by detail
        OwnedPipeline coarse;               // rings by detail: shades the first round
        OwnedPipeline predict;              // and guesses the second
        OwnedPipeline shading;
        OwnedPipeline resolve;
        OwnedPipeline inset;
    };
    using PipelineKey = std::array<std::uint32_t, 4>;

    Pipelines make_pipelines(const GridPlan& plan) const;
    GridTargets& targets() { return *targets_.front(); }
    void add_ring_rounds(const GridPlan& plan, const GraphicsPipelineDescription& mask,
                         const GraphicsPipelineDescription& shading, Pipelines& made) const;
    void record_mask(const MethodFrame& frame, std::uint32_t round, const GpuImage& mask,
                     VkPipelineLayout layout, VkDescriptorSet set);
    void record_shading(const MethodFrame& frame, std::uint32_t round);
    void record_tiles_by_detail(const MethodFrame& frame);
    void record_rings_by_detail(const MethodFrame& frame);
    void record_detail(const MethodFrame& frame);
    void record_reading(const MethodFrame& frame);

    Gpu& gpu_;
    ShadingSource source_;
    GridFormats formats_;
    GridPlanner planner_;
    RenderMethod method_;
    GridSets sets_;  // for their layouts
    OwnedPipelineLayout mask_layout_;
    OwnedPipelineLayout shading_layout_;
    OwnedPipelineLayout reading_layout_;
    OwnedPipelineLayout refining_layout_;
    OwnedPipelineLayout inset_layout_;
    std::map<PipelineKey, Pipelines> pipelines_;
    std::list<std::unique_ptr<GridTargets>> targets_;  // the last used first, so that settings may take turns
    Pipelines* now_ = nullptr;                         // what prepare() chose
};

}  // namespace parafovea
