// Makes the images and sets of kernel foveated rendering.
#include "renderer/methods/kfr_targets.h"

#include <algorithm>
#include <cmath>

namespace parafovea {
namespace {

constexpr float kLargestRimPx = 8;

// Up to what area of the screen each, in pixels, texels have the light of the pixel that they lie in. In
// meshes, cut into pixels anyway, they look no different for it, up to a whole one (less what shaders may
// round otherwise). Where each sample has rays of its own, pixels' light is nearer to full resolution up to
// about half a pixel (PSNR of `primitives`, 16 rays a sample), beyond that between neighbours is.
float most_fine_area(ShadedThing thing) {
    return thing == ShadedThing::meshes ? 0.998f : 0.5f;
}

// How many columns, from the first, have no larger texels, however samples are shifted. Of the first half,
// which the internal filter leaves alone.
std::uint32_t columns_finer_than(const shared::KernelMap& map, float most_area) {
    const auto is_fine = [&](float u) {
        const shared::vec2 spacing = sample_spacing(map, {u, 0});
        return spacing.x * spacing.y <= most_area;
    };
    const auto most = static_cast<std::uint32_t>(map.buffer_size.x) / 2;
    std::uint32_t columns = 0;
    if (!is_fine(0)) return columns;
    for (; columns < most; ++columns) {
        const auto u = static_cast<float>(columns);
        if (!is_fine(u + 0.5f) || !is_fine(u + 1)) break;
    }
    return columns;
}

// The pixels that those columns lie in are at most so far from the gaze's, along either axis.
float reach_of_columns(const shared::KernelMap& map, std::uint32_t columns) {
    return columns == 0 ? 0 : std::ceil(radius_of_column(map, static_cast<float>(columns))) + 1;
}

constexpr Binding kMapBinding{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};
constexpr Binding kFirstImage{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
constexpr Binding kReduced{2, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};  // see pass_1.comp
constexpr Binding kSecondImage{1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};

GpuImage image_of(Gpu& gpu, SizePx size, VkFormat format, VkImageUsageFlags usage) {
    return GpuImage(gpu, {.format = format,
                          .width = static_cast<std::uint32_t>(size.width),
                          .height = static_cast<std::uint32_t>(size.height),
                          .usage = usage});
}

}  // namespace

KfrTargets::KfrTargets(Gpu& gpu, const KfrFormats& formats, const TexelList::Maker& list_maker,
                       ShadedThing thing, const KfrSetting& wanted, SizePx wanted_screen)
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
      fine_set(gpu, {kMapBinding, kSecondImage}),
      resample_set(gpu, {kMapBinding, kSecondImage}),
      post_set(gpu, {kMapBinding, kSecondImage}) {
    const VkImageUsageFlags drawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    reduced = image_of(gpu, buffer, formats.reduced,
                       drawn | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                           (formats.in_compute ? VK_IMAGE_USAGE_STORAGE_BIT : 0));
    if (setting.internal_filter) {
        filtered_u = image_of(gpu, buffer, formats.reduced, drawn | VK_IMAGE_USAGE_SAMPLED_BIT);
        filtered_u_set.set_sampled_image(0, filtered_u.view(), sampler.get());
    }
    if (setting.culling || formats.in_compute) {
        mask = image_of(gpu, buffer, kKfrMaskFormat,
                        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    }
    if (takes_light_of_pixels(thing, setting)) {
        // The gaze in the middle of the screen has the most.
        const shared::KernelMap centred = make_kernel_map(screen, centre_of(screen), setting.kernel);
        most_fine_area_ = most_fine_area(thing);
        most_fine_px_ = reach_of_columns(centred, columns_finer_than(centred, most_fine_area_));
    }
    if (setting.culling && most_fine_px_ > 0) {
        const int side = 2 * static_cast<int>(most_fine_px_) + 1;
        fine_pixels = image_of(gpu, {side, side}, formats.reduced, drawn | VK_IMAGE_USAGE_SAMPLED_BIT);
        fine_set.set_buffer(0, map);
        fine_set.set_sampled_image(1, fine_pixels.view(), sampler.get());
    }
    if (formats.in_compute) {
        listed.emplace(gpu, list_maker, mask);
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

void KfrTargets::set_gaze(PointPx wanted) {
    if (has_gaze_ && wanted == gaze) return;
    gaze = wanted;
    has_gaze_ = true;
    mask_stale = true;
    block = make_kernel_map(screen, gaze, setting.kernel);
    block.inset_px = static_cast<float>(setting.inset * shorter_side_px(screen));
    block.inset_rim_px = std::min(kLargestRimPx, 0.5f * block.inset_px);
    if (most_fine_px_ > 0) set_fine_columns();
    map.write(block);
}

void KfrTargets::set_fine_columns() {
    // Samples off the screen take its edge, which is as near only to a gaze on it.
    const bool on_screen = gaze.x >= 0 && gaze.y >= 0 && gaze.x <= screen.width && gaze.y <= screen.height;
    std::uint32_t columns = on_screen ? columns_finer_than(block, most_fine_area_) : 0;
    while (reach_of_columns(block, columns) > most_fine_px_) --columns;
    block.fine_columns = static_cast<float>(columns);
    fine_px_ = reach_of_columns(block, columns);
    block.fine_corner = {std::floor(block.gaze.x) - fine_px_, std::floor(block.gaze.y) - fine_px_};
}

GazeDisc KfrTargets::fine_disc() const {
    const shared::vec2 corner = block.fine_corner;
    const float left = std::max(-corner.x, 0.0f), top = std::max(-corner.y, 0.0f);
    const float square = 2 * fine_px_ + 1;
    const float right = std::min(block.screen_size.x - corner.x, square);
    const float bottom = std::min(block.screen_size.y - corner.y, square);
    return {.centre = {block.gaze.x - corner.x, block.gaze.y - corner.y},
            // The middle of a pixel is up to 0.71 from what lies in it, and the screen's edge moves samples
            // by as much.
            .radius_px = fine_px_ + 0.5f,
            .within = {{static_cast<std::int32_t>(left), static_cast<std::int32_t>(top)},
                       {static_cast<std::uint32_t>(right - left), static_cast<std::uint32_t>(bottom - top)}}};
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
