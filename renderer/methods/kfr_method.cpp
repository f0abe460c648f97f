// Records the passes of kernel foveated rendering.
#include "renderer/methods/kfr_method.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "renderer/methods/gaze_disc.h"
#include "renderer/methods/method_parameters.h"
#include "shader_code/internal_filter.h"
#include "shader_code/map_corners_shading_vert.h"
#include "shader_code/map_corners_vert.h"
#include "shader_code/pass_1_compute_meshes.h"
#include "shader_code/pass_1_compute_picture.h"
#include "shader_code/pass_1_compute_primitives.h"
#include "shader_code/pass_1_fine.h"
#include "shader_code/pass_1_meshes.h"
#include "shader_code/pass_1_picture.h"
#include "shader_code/pass_1_pixels_meshes.h"
#include "shader_code/pass_1_pixels_primitives.h"
#include "shader_code/pass_1_primitives.h"
#include "shader_code/pass_2.h"
#include "shader_code/pass_2_exact.h"
#include "shader_code/post_filter.h"
#include "shader_code/read_mask.h"

namespace parafovea {
namespace {

// How many settings may take turns on one screen before buffers are made anew.
constexpr std::size_t kMostTargets = 8;

// Of KfrTargets::counts.
constexpr std::uint32_t kTexelQuery = 0, kDiscQuery = 1;

const ShadingCode kComputeShading{shader_code::pass_1_compute_meshes, shader_code::pass_1_compute_primitives,
                                  shader_code::pass_1_compute_picture};
const ShadingCode kShading{shader_code::pass_1_meshes, shader_code::pass_1_primitives,
                           shader_code::pass_1_picture};
const ShadingCode kPixelShading{shader_code::pass_1_pixels_meshes, shader_code::pass_1_pixels_primitives, {}};

std::uint32_t side(int pixels) {
    return static_cast<std::uint32_t>(pixels);
}

// Of a buffer that is being drawn, draws only the columns in [first, end).
void keep_to_columns(VkCommandBuffer commands, SizePx buffer, std::uint32_t first, std::uint32_t end) {
    const VkRect2D columns{{static_cast<std::int32_t>(first), 0}, {end - first, side(buffer.height)}};
    vkCmdSetScissor(commands, 0, 1, &columns);
}

// Keeps a pass to where the mask says that a texel is needed: its triangle has depth 0.
void keep_to_mask(GraphicsPipelineDescription& pass) {
    pass.depth_format = kKfrMaskFormat;
    pass.depth_test = true;
    pass.depth_compare = VK_COMPARE_OP_LESS;
}

}  // namespace

KfrSetting kfr_setting(const RenderMethod& method) {
    MethodParameters parameters(method);
    KfrSetting setting;
    setting.kernel = parameters.kernel();
    setting.culling = parameters.flag("culling", setting.culling);
    setting.internal_filter = parameters.flag("internal_filter", setting.internal_filter);
    setting.post_filter = parameters.flag("post_filter", setting.post_filter);
    setting.post_filter_cap =
        static_cast<int>(parameters.number("post_filter_cap", setting.post_filter_cap, 3, 39)) | 1;
    const bool mar = setting.kernel.kind == KernelKind::linear_mar;
    setting.inset = parameters.number("inset", mar ? setting.kernel.mar_start + 0.018 : 0, 0, 0.9);
    if (mar && setting.inset < setting.kernel.mar_start + 0.017) {
        throw std::runtime_error(
            "method kfr: with the kernel linear_mar the inset is at least mar_start + 0.018");
    }
    parameters.check_all_taken();
    return setting;
}

KfrMethod::KfrMethod(Gpu& gpu, const ShadingSource& source, const KfrFormats& formats)
    : gpu_(gpu), source_(source), formats_(formats), layouts_(gpu, source.layout), list_maker_(gpu) {}

void KfrMethod::configure(const RenderMethod& method) {
    configure(kfr_setting(method));
}

void KfrMethod::configure(const KfrSetting& setting) {
    setting_ = setting;
}

void KfrMethod::prepare(SizePx screen, PointPx gaze) {
    const PipelineKey key = pipeline_key();
    auto found_pipelines = pipelines_.find(key);
    if (found_pipelines == pipelines_.end())
        found_pipelines = pipelines_.emplace(key, make_pipelines()).first;
    now_ = &found_pipelines->second;

    const auto found = std::ranges::find_if(
        targets_, [&](const KfrTargets& targets) { return targets.serves(setting_, screen); });
    if (found != targets_.end()) {
        targets_.splice(targets_.begin(), targets_, found);
    } else {
        // Another screen makes the old ones useless; many settings on one take turns.
        targets_.remove_if([&](const KfrTargets& targets) { return targets.screen != screen; });
        while (targets_.size() >= kMostTargets) targets_.pop_back();
        targets_.emplace_front(gpu_, formats_, list_maker_, source_.thing, setting_, screen);
    }
    targets_.front().set_gaze(usable_gaze(screen, gaze));
}

KfrMethod::PipelineKey KfrMethod::pipeline_key() const {
    const shared::KernelMap map = make_kernel_map({1, 1}, {}, setting_.kernel);
    return {map.kernel,
            map.as_printed,
            map.doublings,
            setting_.culling ? 1U : 0U,
            setting_.internal_filter ? 1U : 0U,
            setting_.post_filter ? 1U : 0U,
            static_cast<std::uint32_t>(setting_.post_filter_cap),
            setting_.inset > 0 ? 1U : 0U};
}

KfrMethod::Pipelines KfrMethod::make_pipelines() const {
    Pipelines made;
    // See map_block.glsl.
    const shared::KernelMap map = make_kernel_map({1, 1}, {}, setting_.kernel);
    const std::vector<ShaderConstant> map_constants{{0, map.kernel}, {1, map.as_printed}, {3, map.doublings}};
    if (setting_.culling) {
        GraphicsPipelineDescription mask =
            fullscreen_pass(shader_code::read_mask, layouts_.mask.get(), {}, map_constants);
        mask.depth_format = kKfrMaskFormat;
        mask.depth_test = true;
        mask.depth_write = true;
        mask.depth_compare = VK_COMPARE_OP_ALWAYS;
        mask.constants.push_back({2, setting_.internal_filter ? 1U : 0U});
        made.mask = make_graphics_pipeline(gpu_, mask);
    }
    std::vector<ShaderConstant> shading_constants = source_.constants;
    shading_constants.insert(shading_constants.end(), map_constants.begin(), map_constants.end());
    if (formats_.in_compute) {
        made.shading = make_compute_pipeline(gpu_, kComputeShading.of(source_.thing),
                                             layouts_.listed_shading.get(), shading_constants);
    } else {
        GraphicsPipelineDescription shading = fullscreen_pass(
            kShading.of(source_.thing), layouts_.shading.get(), {formats_.reduced}, shading_constants);
        shading.vertex = shader_code::map_corners_shading_vert;
        if (setting_.culling) keep_to_mask(shading);
        made.shading = make_graphics_pipeline(gpu_, shading);
    }
    if (setting_.culling && KfrTargets::takes_light_of_pixels(source_.thing, setting_)) {
        made.pixels = make_fullscreen_pipeline(gpu_, kPixelShading.of(source_.thing), layouts_.shading.get(),
                                               {formats_.reduced}, shading_constants);
        GraphicsPipelineDescription fine = fullscreen_pass(shader_code::pass_1_fine, layouts_.resample.get(),
                                                           {formats_.reduced}, map_constants);
        fine.vertex = shader_code::map_corners_vert;
        made.fine = make_graphics_pipeline(gpu_, fine);
    }
    if (setting_.internal_filter) {
        for (const std::uint32_t along_v : {0U, 1U}) {
            GraphicsPipelineDescription filter = fullscreen_pass(
                shader_code::internal_filter, layouts_.filter.get(), {formats_.reduced}, {{0, along_v}});
            if (setting_.culling) keep_to_mask(filter);
            (along_v == 0 ? made.filter_u : made.filter_v) = make_graphics_pipeline(gpu_, filter);
        }
    }
    GraphicsPipelineDescription resample =
        fullscreen_pass(shader_code::pass_2, layouts_.resample.get(),
                        {setting_.post_filter ? kKfrScreenFormat : formats_.target}, map_constants);
    resample.vertex = shader_code::map_corners_vert;
    if (formats_.exact_bilinear) resample.fragment = shader_code::pass_2_exact;
    made.resample = make_graphics_pipeline(gpu_, resample);
    if (setting_.post_filter) {
        made.post = make_fullscreen_pipeline(gpu_, shader_code::post_filter, layouts_.resample.get(),
                                             {formats_.target},
                                             {{2, std::bit_cast<std::uint32_t>(setting_.post_filter_cap)}});
    }
    if (setting_.inset > 0)
        made.inset =
            make_inset_pipeline(gpu_, source_, layouts_.shading.get(), formats_.target, shading_constants);
    return made;
}

void KfrMethod::record(const MethodFrame& frame) {
    KfrTargets& t = targets_.front();
    frame.timer->start(frame.commands, "pass_1");
    if (t.mask && (t.mask_stale || t.mask_jitter != frame.jitter)) record_mask(frame);
    if (formats_.in_compute)
        record_listed_shading(frame);
    else
        record_shading(frame);
    if (t.culled_columns() > 0) record_fine_columns(frame);
    if (setting_.internal_filter) record_internal_filter(frame.commands);
    frame.timer->stop(frame.commands);

    frame.timer->start(frame.commands, "pass_2");
    if (setting_.post_filter) {
        image_barrier(frame.commands, t.screen_linear, t.fresh ? kUseNone : kUseSampled, kUseColorTarget);
        record_resampling(frame, t.screen_linear);
        image_barrier(frame.commands, t.screen_linear, kUseColorTarget, kUseSampled);
    } else {
        record_resampling(frame, *frame.target);
    }
    frame.timer->stop(frame.commands);

    if (setting_.post_filter) {
        frame.timer->start(frame.commands, "post");
        begin_rendering(frame.commands, frame.target->extent(),
                        {ColorTarget{.view = frame.target->view(), .discard = true}});
        draw_fullscreen(frame.commands, now_->post.get(), layouts_.resample.get(),
                        std::array{t.post_set.get()});
        vkCmdEndRendering(frame.commands);
        frame.timer->stop(frame.commands);
    }
    if (setting_.inset > 0) {
        frame.timer->start(frame.commands, "pass_1");
        record_native_inset(frame, t.block.gaze, t.block.inset_px, now_->inset.get(), layouts_.shading.get(),
                            t.map_set.get(), t.counts, kDiscQuery);
        frame.timer->stop(frame.commands);
    }
    t.fresh = false;
}

void KfrMethod::record_mask(const MethodFrame& frame) {
    KfrTargets& t = targets_.front();
    const VkCommandBuffer commands = frame.commands;
    t.counts.reset(commands, kTexelQuery);
    ResourceUse before = kUseDepthTest;
    before.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    image_barrier(commands, t.mask, before, kUseDepthTarget);
    const DepthTarget depth{
        .view = t.mask.view(), .clear = true, .clear_depth = setting_.culling ? 0.0f : 1.0f};
    begin_rendering(commands, t.mask.extent(), {}, &depth);
    if (setting_.culling) {
        t.counts.begin(commands, kTexelQuery);
        keep_to_columns(commands, t.buffer, t.culled_columns(), side(t.buffer.width));
        push_jitter(commands, layouts_.mask.get(), frame.jitter);
        draw_fullscreen(commands, now_->mask.get(), layouts_.mask.get(), std::array{t.map_set.get()});
        t.counts.end(commands, kTexelQuery);
    }
    vkCmdEndRendering(commands);
    image_barrier(commands, t.mask, kUseDepthTarget, kUseSampled);
    if (t.listed) t.listed->record(commands, list_maker_);
    image_barrier(commands, t.mask, kUseSampled, kUseDepthTest);
    t.mask_stale = false;
    t.mask_jitter = frame.jitter;
}

void KfrMethod::record_shading(const MethodFrame& frame) {
    KfrTargets& t = targets_.front();
    image_barrier(frame.commands, t.reduced, t.fresh ? kUseNone : kUseSampled, kUseColorTarget);
    const DepthTarget depth{.view = t.mask.view(), .read_only = true};
    // What is not shaded keeps its old, finite contents: the sampler may multiply them by 0.
    begin_rendering(frame.commands, t.reduced.extent(),
                    {ColorTarget{.view = t.reduced.view(), .clear = t.fresh}},
                    setting_.culling ? &depth : nullptr);
    keep_to_columns(frame.commands, t.buffer, t.culled_columns(), side(t.buffer.width));
    push_jitter(frame.commands, layouts_.shading.get(), frame.jitter);
    draw_fullscreen(frame.commands, now_->shading.get(), layouts_.shading.get(),
                    std::array{frame.shading_set, t.map_set.get()});
    vkCmdEndRendering(frame.commands);
    image_barrier(frame.commands, t.reduced, kUseColorTarget, kUseSampled);
}

void KfrMethod::record_listed_shading(const MethodFrame& frame) {
    KfrTargets& t = targets_.front();
    const VkCommandBuffer commands = frame.commands;
    if (t.fresh) {
        image_barrier(commands, t.reduced, kUseNone, kUseTransferTarget);
        const VkClearColorValue black{};
        const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(commands, t.reduced.get(), kUseTransferTarget.layout, &black, 1, &all);
        image_barrier(commands, t.reduced, kUseTransferTarget, kUseSampled);
    }
    image_barrier(commands, t.reduced, kUseSampled, kUseComputeStorage);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, now_->shading.get());
    push_jitter(commands, layouts_.listed_shading.get(), frame.jitter);
    const std::array sets{frame.shading_set, t.map_set.get(), t.listed_set.get()};
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layouts_.listed_shading.get(), 0,
                            sets.size(), sets.data(), 0, nullptr);
    t.listed->dispatch(commands);
    image_barrier(commands, t.reduced, kUseComputeStorage, kUseSampled);
}

void KfrMethod::record_fine_columns(const MethodFrame& frame) {
    KfrTargets& t = targets_.front();
    const VkCommandBuffer commands = frame.commands;
    t.counts.reset(commands, kDiscQuery);
    image_barrier(commands, t.fine_pixels, kUseSampledBefore, kUseColorTarget);
    begin_rendering(commands, t.fine_pixels.extent(),
                    {ColorTarget{.view = t.fine_pixels.view(), .discard = true}});
    draw_gaze_disc(frame, t.fine_disc(), now_->pixels.get(), layouts_.shading.get(), t.map_set.get(),
                   t.counts, kDiscQuery);
    vkCmdEndRendering(commands);
    image_barrier(commands, t.fine_pixels, kUseColorTarget, kUseSampled);

    image_barrier(commands, t.reduced, kUseSampled, kUseColorTarget);
    begin_rendering(commands, t.reduced.extent(), {ColorTarget{.view = t.reduced.view()}});
    keep_to_columns(commands, t.buffer, 0, t.culled_columns());
    push_jitter(commands, layouts_.resample.get(), frame.jitter);
    draw_fullscreen(commands, now_->fine.get(), layouts_.resample.get(), std::array{t.fine_set.get()});
    vkCmdEndRendering(commands);
    image_barrier(commands, t.reduced, kUseColorTarget, kUseSampled);
}

void KfrMethod::record_internal_filter(VkCommandBuffer commands) {
    KfrTargets& t = targets_.front();
    const DepthTarget depth{.view = t.mask.view(), .read_only = true};
    const auto filter = [&](VkPipeline pipeline, const DescriptorSet& from, const ColorTarget& to) {
        begin_rendering(commands, t.reduced.extent(), {to}, setting_.culling ? &depth : nullptr);
        keep_to_columns(commands, t.buffer, side(t.buffer.width / 2), side(t.buffer.width));
        draw_fullscreen(commands, pipeline, layouts_.filter.get(), std::array{from.get()});
        vkCmdEndRendering(commands);
    };
    image_barrier(commands, t.filtered_u, t.fresh ? kUseNone : kUseSampled, kUseColorTarget);
    filter(now_->filter_u.get(), t.reduced_set, {.view = t.filtered_u.view(), .clear = t.fresh});
    image_barrier(commands, t.filtered_u, kUseColorTarget, kUseSampled);
    image_barrier(commands, t.reduced, kUseSampled, kUseColorTarget);
    filter(now_->filter_v.get(), t.filtered_u_set, {.view = t.reduced.view()});
    image_barrier(commands, t.reduced, kUseColorTarget, kUseSampled);
}

void KfrMethod::record_resampling(const MethodFrame& frame, const GpuImage& target) {
    KfrTargets& t = targets_.front();
    const VkCommandBuffer commands = frame.commands;
    begin_rendering(commands, target.extent(), {ColorTarget{.view = target.view(), .discard = true}});
    push_jitter(commands, layouts_.resample.get(), frame.jitter);
    draw_fullscreen(commands, now_->resample.get(), layouts_.resample.get(),
                    std::array{t.resample_set.get()});
    vkCmdEndRendering(commands);
}

SampleSpacing KfrMethod::spacing_at(PointPx position) const {
    const shared::KernelMap& map = targets_.front().block;
    const shared::vec2 at{static_cast<float>(position.x), static_cast<float>(position.y)};
    if (std::hypot(at.x - map.gaze.x, at.y - map.gaze.y) < map.inset_px) return {};
    const shared::vec2 spacing = sample_spacing(map, buffer_from_screen(map, at));
    return {spacing.x, spacing.y};
}

MethodStatistics KfrMethod::statistics() const {
    const KfrTargets& t = targets_.front();
    MethodStatistics statistics;
    statistics.buffer = t.buffer;
    statistics.shaded_samples =
        static_cast<std::uint64_t>(t.buffer.width) * static_cast<std::uint64_t>(t.buffer.height);
    const auto note = [&](bool built, const char* name, const char* when_built, const char* when_not) {
        (built ? statistics.built : statistics.left_out).push_back({name, built ? when_built : when_not});
    };
    if (setting_.culling) statistics.shaded_samples = t.counts.count(kTexelQuery);
    if (setting_.inset > 0 || t.culled_columns() > 0) statistics.shaded_samples += t.counts.count(kDiscQuery);
    note(setting_.culling, "culling", "only texels that a pixel reads are shaded", "switched off");
    note(t.culled_columns() > 0, "pixels for fine texels",
         "around the gaze, where texels are finer than pixels, light is found once for those in a pixel",
         !setting_.culling    ? "every texel is shaded"
         : setting_.inset > 0 ? "the inset lies there"
                              : "no texel is finer than pixels, or the gaze is off the screen");
    note(formats_.in_compute, "Pass I in compute shaders", "not a software device, or asked for",
         "a software device is faster with fragments, or the device's compute shaders cannot write the "
         "buffer");
    note(setting_.internal_filter, "internal filter", "3x3 Gaussian over the peripheral half",
         "switched off");
    note(setting_.inset > 0, "native inset", "full resolution around the gaze", "not asked for");
    note(setting_.post_filter, "post filter", "Gaussian of Eq. 14", "switched off");
    return statistics;
}

}  // namespace parafovea
