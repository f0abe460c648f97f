// Makes the images and sets of kernel foveated rendering.
#include "renderer/methods/kfr_targets.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace parafovea {
namespace {

constexpr float kLargestRimPx = 8;

constexpr Binding kMapBinding{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};
constexpr Binding kFirstImage{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
constexpr Binding kReduced{2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};  // see pass_1_listed.glsl
constexpr Binding kSecondImage{1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};

GpuImage image_of(Gpu& gpu, SizePx size, VkFormat format, VkImageUsageFlags usage) {
    return GpuImage(gpu, {.format = format,
                          .width = static_cast<std::uint32_t>(size.width),
                          .height = static_cast<std::uint32_t>(size.height),
                          .usage = usage});
}

}  // namespace

KfrTargets::KfrTargets(Gpu& gpu, const KfrFormats& formats, const TexelList::Maker& list_maker,
                       const KfrSetting& wanted, SizePx wanted_screen)
    : setting(wanted),
      screen(wanted_screen),
      buffer(buffer_size(wanted_screen, wanted.kernel)),
      map(gpu, sizeof(shared::KernelMap), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::upload),
      counts(gpu, 2),
      sampler(make_sampler(gpu, {.filter = formats.exact_bilinear ? VK_FILTER_NEAREST : VK_FILTER_LINEAR,
                                 .mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                 .address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .address_v = VK_SAMPLER_ADDRESS_MODE_REPEAT})),
      map_set(gpu, {kMapBinding}),
      listed_set(gpu, {TexelList::kHeaderBinding, TexelList::kListBinding, kReduced}),
      reduced_set(gpu, {kFirstImage}),
      filtered_u_set(gpu, {kFirstImage}),
      resample_set(gpu, {kMapBinding, kSecondImage}),
      post_set(gpu, {kMapBinding, kSecondImage}) {
    const VkImageUsageFlags drawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    reduced = image_of(gpu, buffer, formats.reduced,
                       drawn | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                           (formats.lists ? VK_IMAGE_USAGE_STORAGE_BIT : 0));
    if (setting.internal_filter) {
        filtered_u = image_of(gpu, buffer, formats.reduced, drawn | VK_IMAGE_USAGE_SAMPLED_BIT);
        filtered_u_set.set_sampled_image(0, filtered_u.view(), sampler.get());
    }
    if (setting.culling || formats.in_compute) {
        mask = image_of(gpu, buffer, kKfrMaskFormat,
                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    }
    listed_columns = formats.in_compute ? mask.extent().width : mask && formats.lists ? strewn_columns() : 0;
    if (listed_columns > 0) {
        listed.emplace(gpu, list_maker, mask, listed_columns);
        listed->bind_to(listed_set);
        listed_set.set_storage_image(kReduced.binding, reduced.view());
    }
    if (setting.post_filter) {
        screen_linear = image_of(gpu, screen, kKfrScreenFormat, drawn | VK_IMAGE_USAGE_SAMPLED_BIT);
        post_set.set_sampled_image(1, screen_linear.view(), sampler.get());
    }
    map_set.set_buffer(0, map);
    reduced_set.set_sampled_image(0, reduced.view(), sampler.get());
    resample_set.set_buffer(0, map);
    resample_set.set_sampled_image(1, reduced.view(), sampler.get());
    post_set.set_buffer(0, map);
}

// How many columns lie so close to the gaze that pixels leave many of their texels out: those whose rows are
// less than kStrewnBelowPx apart. The gaze in the middle of the screen has the most. Beyond, a list would
// save hardly a block, and writing storage images costs llvmpipe more (56 ns a texel).
std::uint32_t KfrTargets::strewn_columns() const {
    constexpr float kStrewnBelowPx = 0.75f;
    const float radius = kStrewnBelowPx * static_cast<float>(buffer.height) / (2 * std::numbers::pi_v<float>);
    if (setting.inset * shorter_side_px(screen) > radius) return 0;
    const shared::KernelMap centred = make_kernel_map(screen, centre_of(screen), setting.kernel);
    const float u = buffer_from_screen(centred, {centred.gaze.x + radius, centred.gaze.y}).x;
    return std::min(static_cast<std::uint32_t>(std::ceil(u / 4)) * 4, mask.extent().width);
}

void KfrTargets::set_gaze(PointPx wanted) {
    if (has_gaze_ && wanted == gaze) return;
    gaze = wanted;
    has_gaze_ = true;
    mask_stale = true;
    block = make_kernel_map(screen, gaze, setting.kernel);
    block.inset_px = static_cast<float>(setting.inset * shorter_side_px(screen));
    block.inset_rim_px = std::min(kLargestRimPx, 0.5f * block.inset_px);
    map.write(block);
}

KfrLayouts::KfrLayouts(Gpu& gpu, VkDescriptorSetLayout shading_layout)
    : map_set(gpu, {kMapBinding}),
      listed_set(gpu, {TexelList::kHeaderBinding, TexelList::kListBinding, kReduced}),
      reduced_set(gpu, {kFirstImage}),
      map_and_image_set(gpu, {kMapBinding, kSecondImage}),
      mask(make_pipeline_layout(gpu, {map_set.layout()}, sizeof(Jitter))),
      shading(make_pipeline_layout(gpu, {shading_layout, map_set.layout()}, sizeof(Jitter))),
      listed_shading(
          make_pipeline_layout(gpu, {shading_layout, map_set.layout(), listed_set.layout()}, sizeof(Jitter))),
      filter(make_pipeline_layout(gpu, {reduced_set.layout()})),
      resample(make_pipeline_layout(gpu, {map_and_image_set.layout()}, sizeof(Jitter))) {}

}  // namespace parafovea
