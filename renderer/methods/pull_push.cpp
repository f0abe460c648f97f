// Records the two sweeps of pull-push.
#include "renderer/methods/pull_push.h"

#include <array>

#include "shader_code/pull.h"
#include "shader_code/push.h"

namespace parafovea {
namespace {

constexpr Binding kFine{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
constexpr Binding kCoarse{1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};

}  // namespace

PullPush::PullPush(Gpu& gpu, const GpuImage& sparse, VkFormat target_format)
    : nearest_(make_sampler(gpu, {.filter = VK_FILTER_NEAREST})),
      linear_(make_sampler(gpu, {.mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                 .address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      last_push_(gpu, {kFine, kCoarse}) {
    VkExtent2D size = sparse.extent();
    do {
        size = {(size.width + 1) / 2, (size.height + 1) / 2};
        const ImageDescription description{
            .format = sparse.format(),
            .width = size.width,
            .height = size.height,
            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT};
        levels_.push_back({.pulled = GpuImage(gpu, description),
                           .pushed = {},
                           .pull = DescriptorSet(gpu, {kFine}),
                           .push = DescriptorSet(gpu, {kFine, kCoarse})});
        if (size.width > 1 || size.height > 1) levels_.back().pushed = GpuImage(gpu, description);
    } while (size.width > 1 || size.height > 1);

    const auto filled = [&](std::size_t i) {
        return (i + 1 == levels_.size() ? levels_[i].pulled : levels_[i].pushed).view();
    };
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        const GpuImage& finer = i == 0 ? sparse : levels_[i - 1].pulled;
        levels_[i].pull.set_sampled_image(0, finer.view(), nearest_.get());
        if (i + 1 == levels_.size()) break;
        levels_[i].push.set_sampled_image(0, levels_[i].pulled.view(), nearest_.get());
        levels_[i].push.set_sampled_image(1, filled(i + 1), linear_.get());
    }
    last_push_.set_sampled_image(0, sparse.view(), nearest_.get());
    last_push_.set_sampled_image(1, filled(0), linear_.get());

    pull_layout_ = make_pipeline_layout(gpu, {levels_.front().pull.layout()});
    push_layout_ = make_pipeline_layout(gpu, {last_push_.layout()});
    pull_ = make_fullscreen_pipeline(gpu, shader_code::pull, pull_layout_.get(), {sparse.format()});
    push_ = make_fullscreen_pipeline(gpu, shader_code::push, push_layout_.get(), {sparse.format()});
    push_to_target_ = make_fullscreen_pipeline(gpu, shader_code::push, push_layout_.get(), {target_format});
}

void PullPush::record(VkCommandBuffer commands, const GpuImage& target) {
    const auto draw_level = [&](const GpuImage& image, VkPipeline pipeline, const OwnedPipelineLayout& layout,
                                const DescriptorSet& set) {
        image_barrier(commands, image, fresh_ ? kUseNone : kUseSampled, kUseColorTarget);
        begin_rendering(commands, image.extent(), {ColorTarget{.view = image.view(), .discard = true}});
        draw_fullscreen(commands, pipeline, layout.get(), std::array{set.get()});
        vkCmdEndRendering(commands);
        image_barrier(commands, image, kUseColorTarget, kUseSampled);
    };
    for (const Level& level : levels_) draw_level(level.pulled, pull_.get(), pull_layout_, level.pull);
    for (std::size_t i = levels_.size() - 1; i-- > 0;)
        draw_level(levels_[i].pushed, push_.get(), push_layout_, levels_[i].push);
    begin_rendering(commands, target.extent(), {ColorTarget{.view = target.view(), .discard = true}});
    draw_fullscreen(commands, push_to_target_.get(), push_layout_.get(), std::array{last_push_.get()});
    vkCmdEndRendering(commands);
    fresh_ = false;
}

}  // namespace parafovea
