// Marches primary rays into a small depth image.
#include "renderer/marched_depth.h"

#include <array>

#include "shader_code/march_depth.h"

namespace parafovea {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R32_SFLOAT;
constexpr std::uint32_t kPixelsPerTexel = 4;

}  // namespace

MarchedDepth::MarchedDepth(Gpu& gpu, const ShadingSource& source)
    : gpu_(gpu),
      layout_(make_pipeline_layout(gpu, {source.layout}, 2 * sizeof(float))),
      pipeline_(make_fullscreen_pipeline(gpu, shader_code::march_depth, layout_.get(), {kFormat},
                                         source.constants)) {}

void MarchedDepth::record(VkCommandBuffer commands, VkDescriptorSet shading_set, VkExtent2D screen) {
    const VkExtent2D extent{(screen.width + kPixelsPerTexel - 1) / kPixelsPerTexel,
                            (screen.height + kPixelsPerTexel - 1) / kPixelsPerTexel};
    if (!image_ || image_.extent().width != extent.width || image_.extent().height != extent.height) {
        image_ = {};
        image_ = GpuImage(gpu_, {.format = kFormat,
                                 .width = extent.width,
                                 .height = extent.height,
                                 .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
    }
    const std::array pixels_per_texel{static_cast<float>(screen.width) / static_cast<float>(extent.width),
                                      static_cast<float>(screen.height) / static_cast<float>(extent.height)};
    image_barrier(commands, image_, kUseNone, kUseColorTarget);
    begin_rendering(commands, extent, {ColorTarget{.view = image_.view(), .discard = true}});
    vkCmdPushConstants(commands, layout_.get(), kPushConstantStages, 0, sizeof pixels_per_texel,
                       pixels_per_texel.data());
    draw_fullscreen(commands, pipeline_.get(), layout_.get(), std::array{shading_set});
    vkCmdEndRendering(commands);
    image_barrier(commands, image_, kUseColorTarget, kUseSampled);
}

}  // namespace parafovea
