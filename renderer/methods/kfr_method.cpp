// Records the passes of kernel foveated rendering.
#include "renderer/methods/kfr_method.h"

#include <array>
#include <bit>
#include <cassert>
#include <span>
#include <utility>

#include "renderer/methods/method_parameters.h"
#include "shader_code/fullscreen_vert.h"
#include "shader_code/internal_filter.h"
#include "shader_code/pass_1_meshes.h"
#include "shader_code/pass_1_picture.h"
#include "shader_code/pass_1_primitives.h"
#include "shader_code/pass_2.h"
#include "shader_code/pass_2_exact.h"
#include "shader_code/post_filter.h"
#include "shader_code/read_mask.h"

namespace parafovea {
namespace {

constexpr VkFormat kMaskFormat = VK_FORMAT_D16_UNORM;
constexpr VkFormat kLinearFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

std::span<const std::uint32_t> shading_code_for(ShadedThing thing) {
    switch (thing) {
        case ShadedThing::meshes:
            return shader_code::pass_1_meshes;
        case ShadedThing::primitives:
            return shader_code::pass_1_primitives;
        case ShadedThing::picture:
            return shader_code::pass_1_picture;
    }
    return {};
}

std::uint32_t side(int pixels) {
    return static_cast<std::uint32_t>(pixels);
}

// A full-screen pass that runs only where the mask says that a texel is needed: its triangle has depth 0.
GraphicsPipelineDescription masked_pass(std::span<const std::uint32_t> code, VkPipelineLayout layout,
                                        VkFormat format, bool masked) {
    GraphicsPipelineDescription description;
    description.vertex = shader_code::fullscreen_vert;
    description.fragment = code;
    description.layout = layout;
    description.color_formats = {format};
    if (masked) {
        description.depth_format = kMaskFormat;
        description.depth_test = true;
        description.depth_compare = VK_COMPARE_OP_LESS;
    }
    return description;
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
    parameters.check_all_taken();
    return setting;
}

KfrMethod::KfrMethod(Gpu& gpu, const ShadingSource& source, const KfrFormats& formats)
    : gpu_(gpu),
      source_(source),
      formats_(formats),
      map_(gpu, sizeof(shared::KernelMap), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::upload),
      sampler_(make_sampler(gpu, {.filter = formats.exact_bilinear ? VK_FILTER_NEAREST : VK_FILTER_LINEAR,
                                  .mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                  .address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                  .address_v = VK_SAMPLER_ADDRESS_MODE_REPEAT})),
      map_set_(gpu, {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}}),
      reduced_set_(gpu, {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}}),
      resample_set_(gpu,
                    {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}}),
      post_set_(gpu,
                {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}, {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}}),
      mask_layout_(make_pipeline_layout(gpu, {map_set_.layout()})),
      shading_layout_(make_pipeline_layout(gpu, {source.layout, map_set_.layout()})),
      filter_layout_(make_pipeline_layout(gpu, {reduced_set_.layout()})),
      resample_layout_(make_pipeline_layout(gpu, {resample_set_.layout()})),
      post_layout_(make_pipeline_layout(gpu, {post_set_.layout()})) {
    map_set_.set_buffer(0, map_);
    resample_set_.set_buffer(0, map_);
    post_set_.set_buffer(0, map_);
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_OCCLUSION;
    info.queryCount = 1;
    VkQueryPool queries = VK_NULL_HANDLE;
    check_vulkan(vkCreateQueryPool(gpu.device(), &info, nullptr, &queries), "creating a sample counter");
    needed_count_ = {gpu.device(), queries};
}

void KfrMethod::configure(const RenderMethod& method) {
    configure(kfr_setting(method));
}

void KfrMethod::configure(const KfrSetting& setting) {
    if (setting == setting_) return;
    if (setting.kernel != setting_.kernel) map_stale_ = true;
    // Pipelines do not depend on these.
    KfrSetting same_pipelines = setting;
    same_pipelines.kernel.sigma = setting_.kernel.sigma;
    same_pipelines.kernel.alpha = setting_.kernel.alpha;
    same_pipelines.kernel.betas = setting_.kernel.betas;
    if (same_pipelines != setting_) pipelines_stale_ = true;
    setting_ = setting;
}

void KfrMethod::prepare(SizePx screen, PointPx gaze) {
    const PointPx usable = usable_gaze(screen, gaze);
    const SizePx buffer = buffer_size(screen, setting_.kernel);
    if (screen != screen_ || usable != gaze_) map_stale_ = true;
    if (pipelines_stale_ || screen != screen_ || buffer != buffer_) {
        screen_ = screen;
        buffer_ = buffer;
        make_targets();
    }
    gaze_ = usable;
    if (pipelines_stale_) make_pipelines();
    if (map_stale_) {
        map_.write(make_kernel_map(screen_, gaze_, setting_.kernel));
        mask_stale_ = true;
    }
    map_stale_ = false;
    pipelines_stale_ = false;
}

void KfrMethod::make_targets() {
    ImageDescription reduced{.format = formats_.reduced,
                             .width = side(buffer_.width),
                             .height = side(buffer_.height),
                             .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                                      VK_IMAGE_USAGE_TRANSFER_DST_BIT};
    reduced_ = GpuImage(gpu_, reduced);
    reduced_set_.set_sampled_image(0, reduced_.view(), sampler_.get());
    resample_set_.set_sampled_image(1, reduced_.view(), sampler_.get());
    filtered_ = {};
    if (setting_.internal_filter) {
        reduced.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        filtered_ = GpuImage(gpu_, reduced);
    }
    mask_ = {};
    if (setting_.culling) {
        mask_ = GpuImage(gpu_, {.format = kMaskFormat,
                                .width = side(buffer_.width),
                                .height = side(buffer_.height),
                                .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT});
    }
    screen_linear_ = {};
    if (setting_.post_filter) {
        screen_linear_ =
            GpuImage(gpu_, {.format = kLinearFormat,
                            .width = side(screen_.width),
                            .height = side(screen_.height),
                            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
        post_set_.set_sampled_image(1, screen_linear_.view(), sampler_.get());
    }
    reduced_fresh_ = true;
    screen_fresh_ = true;
    mask_stale_ = true;
}

void KfrMethod::make_pipelines() {
    // See map_block.glsl.
    const shared::KernelMap map = make_kernel_map(screen_, gaze_, setting_.kernel);
    const std::vector<ShaderConstant> map_constants{{0, map.kernel}, {1, map.as_printed}};
    if (setting_.culling) {
        GraphicsPipelineDescription mask;
        mask.vertex = shader_code::fullscreen_vert;
        mask.fragment = shader_code::read_mask;
        mask.layout = mask_layout_.get();
        mask.depth_format = kMaskFormat;
        mask.depth_test = true;
        mask.depth_write = true;
        mask.depth_compare = VK_COMPARE_OP_ALWAYS;
        mask.constants = map_constants;
        mask.constants.push_back({2, setting_.internal_filter ? 1U : 0U});
        mask_pipeline_ = make_graphics_pipeline(gpu_, mask);
    }
    GraphicsPipelineDescription shading = masked_pass(shading_code_for(source_.thing), shading_layout_.get(),
                                                      formats_.reduced, setting_.culling);
    shading.constants = source_.constants;
    shading.constants.insert(shading.constants.end(), map_constants.begin(), map_constants.end());
    shading_pipeline_ = make_graphics_pipeline(gpu_, shading);
    if (setting_.internal_filter) {
        filter_pipeline_ =
            make_graphics_pipeline(gpu_, masked_pass(shader_code::internal_filter, filter_layout_.get(),
                                                     formats_.reduced, setting_.culling));
    }
    const std::span<const std::uint32_t> resample =
        formats_.exact_bilinear ? std::span<const std::uint32_t>(shader_code::pass_2_exact)
                                : shader_code::pass_2;
    resample_pipeline_ =
        make_fullscreen_pipeline(gpu_, resample, resample_layout_.get(),
                                 {setting_.post_filter ? kLinearFormat : formats_.target}, map_constants);
    if (setting_.post_filter) {
        post_pipeline_ =
            make_fullscreen_pipeline(gpu_, shader_code::post_filter, post_layout_.get(), {formats_.target},
                                     {{2, std::bit_cast<std::uint32_t>(setting_.post_filter_cap)}});
    }
}

void KfrMethod::record(const MethodFrame& frame) {
    frame.timer->start(frame.commands, "pass_1");
    if (setting_.culling && mask_stale_) record_mask(frame.commands);
    record_shading(frame);
    if (setting_.internal_filter) record_internal_filter(frame.commands);
    reduced_fresh_ = false;
    frame.timer->stop(frame.commands);

    frame.timer->start(frame.commands, "pass_2");
    if (setting_.post_filter) {
        image_barrier(frame.commands, screen_linear_, screen_fresh_ ? kUseNone : kUseSampled,
                      kUseColorTarget);
        record_resampling(frame.commands, screen_linear_);
        image_barrier(frame.commands, screen_linear_, kUseColorTarget, kUseSampled);
        screen_fresh_ = false;
    } else {
        record_resampling(frame.commands, *frame.target);
    }
    frame.timer->stop(frame.commands);

    if (setting_.post_filter) {
        frame.timer->start(frame.commands, "post");
        begin_rendering(frame.commands, frame.target->extent(),
                        {ColorTarget{.view = frame.target->view(), .discard = true}});
        draw_fullscreen(frame.commands, post_pipeline_.get(), post_layout_.get(),
                        std::array{post_set_.get()});
        vkCmdEndRendering(frame.commands);
        frame.timer->stop(frame.commands);
    }
}

void KfrMethod::record_mask(VkCommandBuffer commands) {
    vkCmdResetQueryPool(commands, needed_count_.get(), 0, 1);
    ResourceUse before = kUseDepthTest;
    before.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    image_barrier(commands, mask_, before, kUseDepthTarget);
    const DepthTarget depth{.view = mask_.view(), .clear = true, .clear_depth = 0};
    begin_rendering(commands, mask_.extent(), {}, &depth);
    vkCmdBeginQuery(commands, needed_count_.get(), 0, VK_QUERY_CONTROL_PRECISE_BIT);
    draw_fullscreen(commands, mask_pipeline_.get(), mask_layout_.get(), std::array{map_set_.get()});
    vkCmdEndQuery(commands, needed_count_.get(), 0);
    vkCmdEndRendering(commands);
    image_barrier(commands, mask_, kUseDepthTarget, kUseDepthTest);
    mask_stale_ = false;
}

void KfrMethod::record_shading(const MethodFrame& frame) {
    image_barrier(frame.commands, reduced_, reduced_fresh_ ? kUseNone : kUseSampled, kUseColorTarget);
    const DepthTarget depth{.view = mask_.view(), .read_only = true};
    // What is not shaded keeps its old, finite contents: the sampler may multiply them by 0.
    begin_rendering(frame.commands, reduced_.extent(),
                    {ColorTarget{.view = reduced_.view(), .clear = reduced_fresh_}},
                    setting_.culling ? &depth : nullptr);
    draw_fullscreen(frame.commands, shading_pipeline_.get(), shading_layout_.get(),
                    std::array{frame.shading_set, map_set_.get()});
    vkCmdEndRendering(frame.commands);
    image_barrier(frame.commands, reduced_, kUseColorTarget, kUseSampled);
}

void KfrMethod::record_internal_filter(VkCommandBuffer commands) {
    const std::uint32_t first = side(buffer_.width / 2);
    const VkExtent2D extent{side(buffer_.width) - first, side(buffer_.height)};
    const VkOffset2D offset{static_cast<std::int32_t>(first), 0};
    image_barrier(commands, filtered_, reduced_fresh_ ? kUseNone : kUseTransferSource, kUseColorTarget);
    const DepthTarget depth{.view = mask_.view(), .read_only = true};
    begin_rendering(commands, filtered_.extent(),
                    {ColorTarget{.view = filtered_.view(), .clear = reduced_fresh_}},
                    setting_.culling ? &depth : nullptr);
    const VkRect2D scissor{offset, extent};
    vkCmdSetScissor(commands, 0, 1, &scissor);
    draw_fullscreen(commands, filter_pipeline_.get(), filter_layout_.get(), std::array{reduced_set_.get()});
    vkCmdEndRendering(commands);

    image_barrier(commands, filtered_, kUseColorTarget, kUseTransferSource);
    image_barrier(commands, reduced_, kUseSampled, kUseTransferTarget);
    VkImageCopy copy{};
    copy.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.dstSubresource = copy.srcSubresource;
    copy.srcOffset = {offset.x, offset.y, 0};
    copy.dstOffset = copy.srcOffset;
    copy.extent = {extent.width, extent.height, 1};
    vkCmdCopyImage(commands, filtered_.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, reduced_.get(),
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    image_barrier(commands, reduced_, kUseTransferTarget, kUseSampled);
}

void KfrMethod::record_resampling(VkCommandBuffer commands, const GpuImage& target) {
    begin_rendering(commands, target.extent(), {ColorTarget{.view = target.view(), .discard = true}});
    draw_fullscreen(commands, resample_pipeline_.get(), resample_layout_.get(),
                    std::array{resample_set_.get()});
    vkCmdEndRendering(commands);
}

MethodStatistics KfrMethod::statistics() const {
    MethodStatistics statistics;
    statistics.buffer = buffer_;
    statistics.shaded_samples =
        static_cast<std::uint64_t>(buffer_.width) * static_cast<std::uint64_t>(buffer_.height);
    const auto note = [&](bool built, const char* name, const char* when_built, const char* when_not) {
        (built ? statistics.built : statistics.left_out).push_back({name, built ? when_built : when_not});
    };
    if (setting_.culling) {
        assert(!mask_stale_);
        check_vulkan(vkGetQueryPoolResults(gpu_.device(), needed_count_.get(), 0, 1, sizeof(std::uint64_t),
                                           &statistics.shaded_samples, sizeof(std::uint64_t),
                                           VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                     "counting samples");
    }
    note(setting_.culling, "culling", "only texels that a pixel reads are shaded", "switched off");
    note(setting_.internal_filter, "internal filter", "3x3 Gaussian over the peripheral half",
         "switched off");
    note(setting_.post_filter, "post filter", "Gaussian of Eq. 14", "switched off");
    return statistics;
}

}  // namespace parafovea
