// Records the passes of methods on sample grids.
#include "renderer/methods/grid_method.h"

#include <algorithm>
#include <span>
#include <stdexcept>
#include <utility>

#include "renderer/methods/gaze_disc.h"
#include "shader_code/grid_mask.h"
#include "shader_code/grid_mask_detail.h"
#include "shader_code/grid_mask_rings.h"
#include "shader_code/grid_resolve.h"
#include "shader_code/grid_resolve_detail.h"
#include "shader_code/grid_shade_meshes.h"
#include "shader_code/grid_shade_picture.h"
#include "shader_code/grid_shade_primitives.h"
#include "shader_code/ring_predict.h"
#include "shader_code/tile_detail.h"

namespace parafovea {
namespace {

// How many settings may take turns on one screen before buffers are made anew.
constexpr std::size_t kMostTargets = 4;
constexpr std::uint32_t kInsetQuery = 2;

using Code = std::span<const std::uint32_t>;

const ShadingCode kShading{shader_code::grid_shade_meshes, shader_code::grid_shade_primitives,
                           shader_code::grid_shade_picture};

std::vector<ShaderConstant> joined(std::vector<ShaderConstant> a, const std::vector<ShaderConstant>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

}  // namespace

GridMethod::GridMethod(Gpu& gpu, const ShadingSource& source, const GridFormats& formats, GridPlanner planner)
    : gpu_(gpu),
      source_(source),
      formats_(formats),
      planner_(planner),
      sets_(gpu),
      mask_layout_(make_pipeline_layout(gpu, {sets_.placing.layout()}, sizeof(Jitter))),
      shading_layout_(make_pipeline_layout(gpu, {source.layout, sets_.placing.layout()}, sizeof(Jitter))),
      reading_layout_(make_pipeline_layout(gpu, {sets_.reading.layout()}, sizeof(Jitter))),
      refining_layout_(make_pipeline_layout(gpu, {sets_.refining.layout()}, sizeof(Jitter))),
      inset_layout_(make_pipeline_layout(gpu, {source.layout, sets_.inset.layout()}, sizeof(Jitter))) {}

void GridMethod::configure(const RenderMethod& method) {
    if (method == method_) return;
    MethodParameters parameters(method);
    planner_(parameters, {64, 64}, {32, 32});
    parameters.check_all_taken();
    method_ = method;
}

void GridMethod::prepare(SizePx screen, PointPx gaze) {
    MethodParameters parameters(method_);
    const GridPlan plan = planner_(parameters, screen, gaze);
    const PipelineKey key{plan.kind, plan.culling ? 1U : 0U, plan.interpolate_tiles ? 1U : 0U,
                          plan.look_at_detail ? 1U : 0U};
    auto found_pipelines = pipelines_.find(key);
    if (found_pipelines == pipelines_.end())
        found_pipelines = pipelines_.emplace(key, make_pipelines(plan)).first;
    now_ = &found_pipelines->second;

    const auto found =
        std::ranges::find_if(targets_, [&](const auto& t) { return t->serves(method_, screen); });
    if (found != targets_.end()) {
        targets_.splice(targets_.begin(), targets_, found);
    } else {
        // Another screen makes the old ones useless; many settings on one take turns.
        std::erase_if(targets_, [&](const auto& t) { return t->screen != screen; });
        while (targets_.size() >= kMostTargets) targets_.pop_back();
        targets_.push_front(std::make_unique<GridTargets>(gpu_, formats_, method_, screen, plan));
    }
    targets().set_plan(plan);
}

GridMethod::Pipelines GridMethod::make_pipelines(const GridPlan& plan) const {
    Pipelines made;
    // See sample_grid.glsl and grid_mask.frag.
    const std::vector<ShaderConstant> constants{
        {0, plan.kind}, {1, plan.interpolate_tiles ? 1U : 0U}, {2, plan.culling ? 1U : 0U}};

    GraphicsPipelineDescription mask =
        fullscreen_pass(shader_code::grid_mask, mask_layout_.get(), {},
                        joined(constants, {{3, plan.look_at_detail ? 1U : 0U}}));
    mask.depth_format = kGridMaskFormat;
    mask.depth_test = true;
    mask.depth_write = true;
    mask.depth_compare = VK_COMPARE_OP_ALWAYS;
    made.mask[0] = make_graphics_pipeline(gpu_, mask);
    const bool tiles_by_detail = plan.look_at_detail && plan.kind == shared::kGridTiles;
    if (tiles_by_detail) {
        mask.fragment = shader_code::grid_mask_detail;
        mask.constants = joined(constants, {{3, 2}});
        made.mask[1] = make_graphics_pipeline(gpu_, mask);
    }

    GraphicsPipelineDescription shading =
        fullscreen_pass(kShading.of(source_.thing), shading_layout_.get(), {formats_.samples},
                        joined(source_.constants, constants));
    shading.depth_format = kGridMaskFormat;
    shading.depth_test = true;
    shading.depth_compare = VK_COMPARE_OP_LESS;
    made.shading = make_graphics_pipeline(gpu_, shading);

    if (plan.look_at_detail && !tiles_by_detail) add_ring_rounds(plan, mask, shading, made);
    if (tiles_by_detail) {
        made.detail = make_fullscreen_pipeline(gpu_, shader_code::tile_detail, reading_layout_.get(),
                                               {kTileLayerFormat}, constants);
    }
    if (plan.kind != shared::kGridScattered) {
        made.resolve = make_fullscreen_pipeline(
            gpu_, tiles_by_detail ? Code(shader_code::grid_resolve_detail) : Code(shader_code::grid_resolve),
            reading_layout_.get(), {formats_.target}, constants);
    }
    if (plan.grid.inset_px > 0)
        made.inset =
            make_inset_pipeline(gpu_, source_, inset_layout_.get(), formats_.target, source_.constants);
    return made;
}

void GridMethod::add_ring_rounds(const GridPlan& plan, const GraphicsPipelineDescription& mask,
                                 const GraphicsPipelineDescription& shading, Pipelines& made) const {
    GraphicsPipelineDescription finer_mask = mask;
    finer_mask.fragment = shader_code::grid_mask_rings;
    finer_mask.layout = refining_layout_.get();
    finer_mask.constants = {{0, plan.kind}, {2, plan.culling ? 1U : 0U}, {3, 2}};
    made.mask[1] = make_graphics_pipeline(gpu_, finer_mask);

    GraphicsPipelineDescription coarse = shading;
    coarse.constants.push_back({4, 1});
    made.coarse = make_graphics_pipeline(gpu_, coarse);

    // Runs where the mask is tested, without a test of its own.
    GraphicsPipelineDescription predict = shading;
    predict.fragment = shader_code::ring_predict;
    predict.layout = refining_layout_.get();
    predict.depth_test = false;
    predict.constants = {{0, plan.kind}};
    made.predict = make_graphics_pipeline(gpu_, predict);
}

void GridMethod::record(const MethodFrame& frame) {
    GridTargets& t = targets();
    frame.timer->start(frame.commands, "pass_1");
    if (t.plan.coarse != SizePx{}) {
        record_rings_by_detail(frame);
    } else if (t.plan.look_at_detail) {
        record_tiles_by_detail(frame);
    } else {
        if (t.mask_stale || t.mask_jitter != frame.jitter)
            record_mask(frame, 0, t.mask, mask_layout_.get(), t.sets.placing.get());
        record_shading(frame, 0);
    }
    frame.timer->stop(frame.commands);

    frame.timer->start(frame.commands, "pass_2");
    if (t.fill)
        t.fill->record(frame.commands, *frame.target);
    else
        record_reading(frame);
    frame.timer->stop(frame.commands);

    if (t.plan.grid.inset_px > 0) {
        frame.timer->start(frame.commands, "pass_1");
        record_native_inset(frame, t.plan.grid.gaze, t.plan.grid.inset_px, now_->inset.get(),
                            inset_layout_.get(), t.sets.inset.get(), t.counts, kInsetQuery);
        frame.timer->stop(frame.commands);
    }
    t.fresh = false;
}

// A mask that follows the detail is another in every frame.
void GridMethod::record_tiles_by_detail(const MethodFrame& frame) {
    GridTargets& t = targets();
    record_mask(frame, 0, t.mask, mask_layout_.get(), t.sets.placing.get());
    record_shading(frame, 0);
    record_detail(frame);
    record_mask(frame, 1, t.mask, mask_layout_.get(), t.sets.placing.get());
    record_shading(frame, 1);
}

void GridMethod::record_rings_by_detail(const MethodFrame& frame) {
    GridTargets& t = targets();
    if (t.mask_stale || t.mask_jitter != frame.jitter)
        record_mask(frame, 0, t.coarse_mask, mask_layout_.get(), t.sets.placing.get());
    image_barrier(frame.commands, t.coarse, t.fresh ? kUseNone : kUseSampled, kUseColorTarget);
    const DepthTarget coarse_depth{.view = t.coarse_mask.view(), .read_only = true};
    begin_rendering(frame.commands, t.coarse.extent(),
                    {ColorTarget{.view = t.coarse.view(), .clear = t.fresh}}, &coarse_depth);
    push_jitter(frame.commands, shading_layout_.get(), frame.jitter);
    draw_fullscreen(frame.commands, now_->coarse.get(), shading_layout_.get(),
                    std::array{frame.shading_set, t.sets.placing.get()});
    vkCmdEndRendering(frame.commands);
    image_barrier(frame.commands, t.coarse, kUseColorTarget, kUseSampled);

    record_mask(frame, 1, t.mask, refining_layout_.get(), t.sets.refining.get());
    image_barrier(frame.commands, t.samples, t.fresh ? kUseNone : kUseSampled, kUseColorTarget);
    const DepthTarget depth{.view = t.mask.view(), .read_only = true};
    begin_rendering(frame.commands, t.samples.extent(),
                    {ColorTarget{.view = t.samples.view(), .discard = true}}, &depth);
    push_jitter(frame.commands, refining_layout_.get(), frame.jitter);
    draw_fullscreen(frame.commands, now_->predict.get(), refining_layout_.get(),
                    std::array{t.sets.refining.get()});
    push_jitter(frame.commands, shading_layout_.get(), frame.jitter);
    draw_fullscreen(frame.commands, now_->shading.get(), shading_layout_.get(),
                    std::array{frame.shading_set, t.sets.placing.get()});
    vkCmdEndRendering(frame.commands);
    image_barrier(frame.commands, t.samples, kUseColorTarget, kUseSampled);
}

void GridMethod::record_mask(const MethodFrame& frame, std::uint32_t round, const GpuImage& mask,
                             VkPipelineLayout layout, VkDescriptorSet set) {
    GridTargets& t = targets();
    t.counts.reset(frame.commands, round);
    ResourceUse before = kUseDepthTest;
    before.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    image_barrier(frame.commands, mask, before, kUseDepthTarget);
    const DepthTarget depth{.view = mask.view(), .clear = true, .clear_depth = 0};
    begin_rendering(frame.commands, mask.extent(), {}, &depth);
    t.counts.begin(frame.commands, round);
    push_jitter(frame.commands, layout, frame.jitter);
    draw_fullscreen(frame.commands, now_->mask[round].get(), layout, std::array{set});
    t.counts.end(frame.commands, round);
    vkCmdEndRendering(frame.commands);
    image_barrier(frame.commands, mask, kUseDepthTarget, kUseDepthTest);
    t.mask_stale = false;
    t.mask_jitter = frame.jitter;
}

void GridMethod::record_shading(const MethodFrame& frame, std::uint32_t round) {
    GridTargets& t = targets();
    const bool first = t.fresh && round == 0;
    image_barrier(frame.commands, t.samples, first ? kUseNone : kUseSampled, kUseColorTarget);
    const DepthTarget depth{.view = t.mask.view(), .read_only = true};
    // What is not shaded keeps its old, finite contents, which the sampler may multiply by 0; a scattered
    // grid tells by its alpha of 0 what was not shaded.
    begin_rendering(frame.commands, t.samples.extent(),
                    {ColorTarget{.view = t.samples.view(), .clear = first || t.fill != nullptr}}, &depth);
    push_jitter(frame.commands, shading_layout_.get(), frame.jitter);
    draw_fullscreen(frame.commands, now_->shading.get(), shading_layout_.get(),
                    std::array{frame.shading_set, t.sets.placing.get()});
    vkCmdEndRendering(frame.commands);
    image_barrier(frame.commands, t.samples, kUseColorTarget, kUseSampled);
}

void GridMethod::record_detail(const MethodFrame& frame) {
    GridTargets& t = targets();
    image_barrier(frame.commands, t.layer_of_tile, t.fresh ? kUseNone : kUseSampled, kUseColorTarget);
    begin_rendering(frame.commands, t.layer_of_tile.extent(),
                    {ColorTarget{.view = t.layer_of_tile.view(), .discard = true}});
    push_jitter(frame.commands, reading_layout_.get(), frame.jitter);
    draw_fullscreen(frame.commands, now_->detail.get(), reading_layout_.get(),
                    std::array{t.sets.reading.get()});
    vkCmdEndRendering(frame.commands);
    image_barrier(frame.commands, t.layer_of_tile, kUseColorTarget, kUseSampled);
}

void GridMethod::record_reading(const MethodFrame& frame) {
    begin_rendering(frame.commands, frame.target->extent(),
                    {ColorTarget{.view = frame.target->view(), .discard = true}});
    push_jitter(frame.commands, reading_layout_.get(), frame.jitter);
    draw_fullscreen(frame.commands, now_->resolve.get(), reading_layout_.get(),
                    std::array{targets().sets.reading.get()});
    vkCmdEndRendering(frame.commands);
}

SampleSpacing GridMethod::spacing_at(PointPx position) const {
    return spacing_of(targets_.front()->plan, position);
}

MethodStatistics GridMethod::statistics() const {
    const GridTargets& t = *targets_.front();
    MethodStatistics statistics;
    statistics.buffer = t.plan.buffer;
    statistics.shaded_samples = t.counts.count(0);
    if (t.plan.look_at_detail) statistics.shaded_samples += t.counts.count(1);
    if (t.plan.grid.inset_px > 0) statistics.shaded_samples += t.counts.count(kInsetQuery);
    const auto note = [&](bool built, const char* name, const char* when_built, const char* when_not) {
        (built ? statistics.built : statistics.left_out).push_back({name, built ? when_built : when_not});
    };
    const bool tiles = t.plan.kind == shared::kGridTiles;
    const bool scattered = t.fill != nullptr;
    if (!scattered)
        note(t.plan.culling, "culling", "only samples that a pixel reads are shaded", "switched off");
    note(t.plan.grid.inset_px > 0, "native inset", "full resolution around the gaze",
         "not part of this method");
    note(tiles, "coarse pixels", "tiles of 16x16 in one of three reductions, drawn by shaders",
         "not part of this method");
    note(t.plan.look_at_detail, "samples by detail",
         "where coarse samples show too little contrast there are no finer ones", "not asked for");
    note(scattered, "pull-push", "fills the pixels that are not shaded", "not part of this method");
    if (tiles)
        statistics.left_out.push_back({"VK_KHR_fragment_shading_rate", "the same rates on every device"});
    return statistics;
}

}  // namespace parafovea
