// Records the two passes of contrast preservation.
#include "renderer/contrast_stage.h"

#include <array>
#include <cassert>
#include <span>

#include "shader_code/contrast_boost.h"
#include "shader_code/contrast_mean.h"

namespace parafovea {
namespace {

constexpr std::size_t kGridCells = std::size_t{shared::kSpacingColumns} * shared::kSpacingRows;

}  // namespace

ContrastStage::ContrastStage(Gpu& gpu, VkFormat target_format)
    : sampler_(make_sampler(gpu, {.filter = VK_FILTER_NEAREST,
                                  .mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                  .address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                  .address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      set_(gpu, {{0, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                 {1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
                 {2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}}),
      layout_(make_pipeline_layout(gpu, {set_.layout()}, sizeof(float))),
      mean_pipeline_(make_fullscreen_pipeline(gpu, shader_code::contrast_mean, layout_.get(),
                                              {display_linear_format(gpu)})),
      boost_pipeline_(
          make_fullscreen_pipeline(gpu, shader_code::contrast_boost, layout_.get(), {target_format})),
      spacing_(gpu, kGridCells * sizeof(shared::vec2), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
               BufferPlace::upload),
      gpu_(gpu) {
    set_.set_buffer(0, spacing_);
}

void ContrastStage::record(VkCommandBuffer commands, const GpuImage& picture, const SpacingGrid& spacing,
                           double gain_per_px, const GpuImage& target) {
    assert(spacing.size() == kGridCells);
    const VkExtent2D extent = target.extent();
    if (!mean_of_rows_ || mean_of_rows_.extent().width != extent.width ||
        mean_of_rows_.extent().height != extent.height) {
        mean_of_rows_ = {};
        mean_of_rows_ =
            GpuImage(gpu_, {.format = display_linear_format(gpu_),
                            .width = extent.width,
                            .height = extent.height,
                            .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
        mean_is_new_ = true;
    }
    spacing_.write(std::span<const shared::vec2>(spacing));
    set_.set_sampled_image(1, picture.view(), sampler_.get());
    set_.set_sampled_image(2, mean_of_rows_.view(), sampler_.get());
    const auto gain = static_cast<float>(gain_per_px);
    vkCmdPushConstants(commands, layout_.get(), kPushConstantStages, 0, sizeof gain, &gain);

    image_barrier(commands, mean_of_rows_, mean_is_new_ ? kUseNone : kUseSampled, kUseColorTarget);
    begin_rendering(commands, extent, {ColorTarget{.view = mean_of_rows_.view(), .discard = true}});
    draw_fullscreen(commands, mean_pipeline_.get(), layout_.get(), std::array{set_.get()});
    vkCmdEndRendering(commands);
    image_barrier(commands, mean_of_rows_, kUseColorTarget, kUseSampled);
    mean_is_new_ = false;

    begin_rendering(commands, extent, {ColorTarget{.view = target.view(), .discard = true}});
    draw_fullscreen(commands, boost_pipeline_.get(), layout_.get(), std::array{set_.get()});
    vkCmdEndRendering(commands);
}

}  // namespace parafovea
