// Buffers and images with their memory, and how bytes get into and out of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/gpu.h"

namespace parafovea {

using OwnedMemory = Owned<VkDeviceMemory, vkFreeMemory>;
using OwnedBuffer = Owned<VkBuffer, vkDestroyBuffer>;
using OwnedImage = Owned<VkImage, vkDestroyImage>;
using OwnedImageView = Owned<VkImageView, vkDestroyImageView>;
using OwnedSampler = Owned<VkSampler, vkDestroySampler>;

// Device memory of one resource, counted in its Gpu.
class GpuMemory {
  public:
    GpuMemory() = default;
    GpuMemory(Gpu& gpu, const VkMemoryRequirements& requirements, VkMemoryPropertyFlags required,
              VkMemoryPropertyFlags wanted);
    GpuMemory(GpuMemory&& other) noexcept;
    GpuMemory& operator=(GpuMemory&& other) noexcept;
    ~GpuMemory();

    VkDeviceMemory get() const { return memory_.get(); }

  private:
    Gpu* gpu_ = nullptr;
    VkDeviceSize bytes_ = 0;
    OwnedMemory memory_;
};

enum class BufferPlace {
    device,    // fast for the device; filled by upload()
    upload,    // mapped; written by the CPU, read by the device (uniforms that change each frame)
    readback,  // mapped and cached; written by the device, read by the CPU after submit_and_wait()
};

// A buffer of at least one byte. Throws if memory runs out.
class GpuBuffer {
  public:
    GpuBuffer() = default;
    GpuBuffer(Gpu& gpu, VkDeviceSize bytes, VkBufferUsageFlags usage, BufferPlace place);

    VkBuffer get() const { return buffer_.get(); }
    VkDeviceSize size_bytes() const { return bytes_; }
    std::byte* mapped() const { return mapped_; }  // nullptr for BufferPlace::device
    explicit operator bool() const { return static_cast<bool>(buffer_); }

    // Copies a plain value or array to the mapped memory.
    template <typename T>
    void write(const T& value) {
        write_bytes(std::as_bytes(std::span<const T, 1>(&value, 1)));
    }
    template <typename T>
    void write(std::span<const T> values) {
        write_bytes(std::as_bytes(values));
    }

  private:
    void write_bytes(std::span<const std::byte> bytes);

    GpuMemory memory_;
    OwnedBuffer buffer_;
    VkDeviceSize bytes_ = 0;
    std::byte* mapped_ = nullptr;
};

struct ImageDescription {
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    std::uint32_t width = 1;
    std::uint32_t height = 1;
    VkImageUsageFlags usage = 0;
    std::uint32_t mip_levels = 1;
    std::uint32_t layers = 1;
    // View type 2D for one layer, 2D_ARRAY for more; ask for CUBE, CUBE_ARRAY or 2D_ARRAY with one layer
    // here.
    VkImageViewType view_type = VK_IMAGE_VIEW_TYPE_2D;
};

// An optimally tiled image with a view of all its levels and layers. Throws if the device does not allow the
// size or memory runs out.
class GpuImage {
  public:
    GpuImage() = default;
    GpuImage(Gpu& gpu, const ImageDescription& description);

    VkImage get() const { return image_.get(); }
    VkImageView view() const { return view_.get(); }
    VkFormat format() const { return description_.format; }
    VkExtent2D extent() const { return {description_.width, description_.height}; }
    std::uint32_t mip_levels() const { return description_.mip_levels; }
    std::uint32_t layers() const { return description_.layers; }
    VkImageAspectFlags aspect() const { return aspect_; }
    explicit operator bool() const { return static_cast<bool>(image_); }

    // A view of one layer and level, for rendering into it.
    OwnedImageView make_view(Gpu& gpu, std::uint32_t layer, std::uint32_t mip_level = 0) const;

  private:
    ImageDescription description_;
    VkImageAspectFlags aspect_ = 0;
    GpuMemory memory_;
    OwnedImage image_;
    OwnedImageView view_;
};

// For display-linear values in [0, 1], to be drawn and sampled: fixed point with 16 bits each, which is finer
// than halves where it is seen; halves where the device cannot draw to that.
VkFormat display_linear_format(const Gpu& gpu);

// How an image or buffer is used before or after a barrier: pipeline stages, accesses and (images) layout.
struct ResourceUse {
    VkPipelineStageFlags2 stages = 0;
    VkAccessFlags2 accesses = 0;
    VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;
};

// Contents before are of no interest.
inline constexpr ResourceUse kUseNone{VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_UNDEFINED};
inline constexpr ResourceUse kUseColorTarget{
    VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT,
    VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
inline constexpr ResourceUse kUseDepthTarget{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
    VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL};
// Depth tested but not written, nor sampled.
inline constexpr ResourceUse kUseDepthTest{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL};
// Sampled or fetched in fragment or compute shaders.
inline constexpr ResourceUse kUseSampled{
    VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_SHADER_SAMPLED_READ_BIT, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
// Sampled, if ever used; what it held is of no interest.
inline constexpr ResourceUse kUseSampledBefore{kUseSampled.stages, kUseSampled.accesses,
                                               VK_IMAGE_LAYOUT_UNDEFINED};
// A storage image or buffer in compute shaders.
inline constexpr ResourceUse kUseComputeStorage{
    VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT, VK_IMAGE_LAYOUT_GENERAL};
inline constexpr ResourceUse kUseTransferSource{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                                VK_ACCESS_2_TRANSFER_READ_BIT,
                                                VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL};
inline constexpr ResourceUse kUseTransferTarget{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                                VK_ACCESS_2_TRANSFER_WRITE_BIT,
                                                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL};
// Read by the CPU after submit_and_wait().
inline constexpr ResourceUse kUseHostRead{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT,
                                          VK_IMAGE_LAYOUT_UNDEFINED};

// Waits for one use of an image and makes it ready for the next: all levels and layers, or those given.
void image_barrier(VkCommandBuffer commands, const GpuImage& image, const ResourceUse& before,
                   const ResourceUse& after);
void image_barrier(VkCommandBuffer commands, VkImage image, const VkImageSubresourceRange& range,
                   const ResourceUse& before, const ResourceUse& after);

// The same for memory that is not an image (layouts are ignored).
void memory_barrier(VkCommandBuffer commands, const ResourceUse& before, const ResourceUse& after);

// Fills a device buffer. Waits until it is done.
void upload(Gpu& gpu, const GpuBuffer& buffer, std::span<const std::byte> bytes);
template <typename T>
void upload(Gpu& gpu, const GpuBuffer& buffer, std::span<const T> values) {
    upload(gpu, buffer, std::as_bytes(values));
}

// Fills level 0 of layers [first_layer, first_layer + layer_count) with tightly packed texels, makes the
// other levels by halving (linear filtering; only if the image has them), and leaves those layers in
// kUseSampled. The image needs TRANSFER_DST and, with levels, TRANSFER_SRC usage. Waits until it is done.
void upload(Gpu& gpu, const GpuImage& image, std::span<const std::byte> texels, std::uint32_t first_layer = 0,
            std::uint32_t layer_count = 1);

// Bytes per texel of the uncompressed formats used here; asserts on others.
std::uint32_t bytes_per_texel(VkFormat format);

// Reads level 0 of layer 0, tightly packed. The image is in `use` before and after. Waits until it is done.
std::vector<std::byte> read_back(Gpu& gpu, const GpuImage& image, const ResourceUse& use);

struct SamplerDescription {
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerMipmapMode mipmap = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    VkSamplerAddressMode address_u = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    VkSamplerAddressMode address_v = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    float max_anisotropy = 1;  // reduced to what the device has
    bool compare = false;      // a shadow sampler: LESS_OR_EQUAL
};
OwnedSampler make_sampler(Gpu& gpu, const SamplerDescription& description);

}  // namespace parafovea
