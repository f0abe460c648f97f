// What stands in a window: the participant's picture in the middle of black, and the photodiode's patch.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "app/photodiode_patch.h"
#include "devices/geometry.h"
#include "renderer/gpu.h"
#include "renderer/gpu_memory.h"

namespace parafovea {

// An image of the device that pictures are copied to and blitted from; it is left in kUseTransferSource.
GpuImage make_picture_image(Gpu& gpu, SizePx size);
void fill_picture_image(Gpu& gpu, const GpuImage& image, std::span<const std::uint8_t> rgba);

class WindowPicture {
  public:
    // Borrows the device for its lifetime.
    WindowPicture(Gpu& gpu, const ViewGeometry& view);

    // Commands that fill the target, whose contents may be undefined, and leave it in `after`. The picture
    // has the view's size and is in kUseTransferSource; it stands where placement_of says. The patch stands
    // in the lower left corner of the window, where a photodiode reaches it; absent: no patch.
    void record(VkCommandBuffer commands, const GpuImage& picture, VkImage target, SizePx window,
                std::optional<bool> patch, const ResourceUse& after) const;

  private:
    SizePx picture_size_;
    int patch_px_;
    GpuImage white_, black_;  // one pixel each
};

}  // namespace parafovea
