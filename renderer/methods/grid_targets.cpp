// Makes the images and sets of methods on sample grids.
#include "renderer/methods/grid_targets.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace parafovea {
namespace {

constexpr Binding kGridBlock{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER};
constexpr Binding kRows{1, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
constexpr Binding kTileLayers{2, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
constexpr Binding kSamples{3, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};

GpuImage image_of(Gpu& gpu, SizePx size, VkFormat format, VkImageUsageFlags usage) {
    return GpuImage(gpu, {.format = format,
                          .width = static_cast<std::uint32_t>(size.width),
                          .height = static_cast<std::uint32_t>(size.height),
                          .usage = usage});
}

SizePx tiles_of(SizePx screen) {
    const int tile = static_cast<int>(shared::kTilePx);
    return {(screen.width + tile - 1) / tile, (screen.height + tile - 1) / tile};
}

}  // namespace

GridSets::GridSets(Gpu& gpu)
    : placing(gpu, {kGridBlock, kRows, kTileLayers}),
      reading(gpu, {kGridBlock, kRows, kTileLayers, kSamples}),
      refining(gpu, {kGridBlock, kRows, kTileLayers, kSamples}),
      inset(gpu, {kGridBlock}) {}

GridTargets::GridTargets(Gpu& gpu, const GridFormats& formats, const RenderMethod& wanted,
                         SizePx wanted_screen, const GridPlan& first_plan)
    : method(wanted),
      screen(wanted_screen),
      plan(first_plan),
      sets(gpu),
      grid(gpu, sizeof(shared::SampleGrid), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::upload),
      samples_of_row(gpu, sizeof(float) * std::max<std::size_t>(1, plan.samples_of_row.size()),
                     VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::upload),
      inset_map(gpu, sizeof(shared::KernelMap), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, BufferPlace::upload),
      mask(image_of(gpu, plan.buffer, kGridMaskFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT)),
      samples(image_of(gpu, plan.buffer, formats.samples,
                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT)),
      counts(gpu, 3),
      sampler(make_sampler(gpu, {.mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                 .address_u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                 .address_v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      nearest(make_sampler(gpu, {.filter = VK_FILTER_NEAREST, .mipmap = VK_SAMPLER_MIPMAP_MODE_NEAREST})) {
    for (DescriptorSet* set : {&sets.placing, &sets.reading, &sets.refining}) {
        set->set_buffer(0, grid);
        set->set_buffer(1, samples_of_row);
    }
    sets.reading.set_sampled_image(3, samples.view(), sampler.get());
    sets.inset.set_buffer(0, inset_map);
    // Something stands at every binding, read or not.
    layer_of_tile =
        image_of(gpu, plan.kind == shared::kGridTiles ? tiles_of(screen) : SizePx{1, 1}, kTileLayerFormat,
                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
    for (DescriptorSet* set : {&sets.placing, &sets.reading, &sets.refining})
        set->set_sampled_image(2, layer_of_tile.view(), nearest.get());
    if (plan.coarse != SizePx{}) {
        coarse = image_of(gpu, plan.coarse, formats.samples,
                          VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
        coarse_mask =
            image_of(gpu, plan.coarse, kGridMaskFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        sets.refining.set_sampled_image(3, coarse.view(), sampler.get());
    }
    if (plan.kind == shared::kGridScattered) fill = std::make_unique<PullPush>(gpu, samples, formats.target);
}

void GridTargets::set_plan(const GridPlan& wanted) {
    const shared::vec2 old_gaze = plan.grid.gaze, new_gaze = wanted.grid.gaze;
    if (has_plan_ && old_gaze.x == new_gaze.x && old_gaze.y == new_gaze.y) return;
    plan = wanted;
    has_plan_ = true;
    mask_stale = true;
    grid.write(plan.grid);
    if (!plan.samples_of_row.empty()) samples_of_row.write(std::span<const float>(plan.samples_of_row));
    shared::KernelMap map{};
    map.screen_size = plan.grid.screen_size;
    map.gaze = plan.grid.gaze;
    map.inset_px = plan.grid.inset_px;
    map.inset_rim_px = plan.grid.inset_rim_px;
    inset_map.write(map);
}

}  // namespace parafovea
