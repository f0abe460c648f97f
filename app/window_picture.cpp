// Copies pictures to the images of a window.
#include "app/window_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "app/window_surface.h"

namespace parafovea {

namespace {

constexpr VkImageSubresourceRange kColor{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

GpuImage one_pixel(Gpu& gpu, std::uint8_t grey) {
    GpuImage image = make_picture_image(gpu, {1, 1});
    const std::array<std::uint8_t, 4> rgba = {grey, grey, grey, 255};
    fill_picture_image(gpu, image, rgba);
    return image;
}

void blit(VkCommandBuffer commands, const GpuImage& from, VkImage to, int left, int top, int right,
          int bottom, VkFilter filter) {
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = {static_cast<std::int32_t>(from.extent().width),
                            static_cast<std::int32_t>(from.extent().height), 1};
    region.dstOffsets[0] = {left, top, 0};
    region.dstOffsets[1] = {right, bottom, 1};
    vkCmdBlitImage(commands, from.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, filter);
}

}  // namespace

GpuImage make_picture_image(Gpu& gpu, SizePx size) {
    ImageDescription description;
    description.width = static_cast<std::uint32_t>(size.width);
    description.height = static_cast<std::uint32_t>(size.height);
    description.usage =
        VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    return GpuImage(gpu, description);
}

void fill_picture_image(Gpu& gpu, const GpuImage& image, std::span<const std::uint8_t> rgba) {
    upload(gpu, image, std::as_bytes(rgba));
    gpu.submit_and_wait(
        [&](VkCommandBuffer commands) { image_barrier(commands, image, kUseSampled, kUseTransferSource); });
}

WindowPicture::WindowPicture(Gpu& gpu, const ViewGeometry& view)
    : picture_size_(view.size),
      patch_px_(patch_side_px(view)),
      white_(one_pixel(gpu, 255)),
      black_(one_pixel(gpu, 0)) {}

void WindowPicture::record(VkCommandBuffer commands, const GpuImage& picture, VkImage target, SizePx window,
                           std::optional<bool> patch, const ResourceUse& after) const {
    image_barrier(commands, target, kColor, kUseNone, kUseTransferTarget);
    const VkClearColorValue black{{0, 0, 0, 1}};
    vkCmdClearColorImage(commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &kColor);
    image_barrier(commands, target, kColor, kUseTransferTarget, kUseTransferTarget);
    const Placement place = placement_of(picture_size_, window);
    const int left = static_cast<int>(place.left_px), top = static_cast<int>(place.top_px);
    const int right = left + static_cast<int>(std::lround(place.scale * picture_size_.width));
    const int bottom = top + static_cast<int>(std::lround(place.scale * picture_size_.height));
    blit(commands, picture, target, left, top, std::min(right, window.width), std::min(bottom, window.height),
         place.scale == 1 ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
    if (patch) {
        image_barrier(commands, target, kColor, kUseTransferTarget, kUseTransferTarget);
        blit(commands, *patch ? white_ : black_, target, 0, std::max(0, window.height - patch_px_),
             std::min(patch_px_, window.width), window.height, VK_FILTER_NEAREST);
    }
    image_barrier(commands, target, kColor, kUseTransferTarget, after);
}

}  // namespace parafovea
