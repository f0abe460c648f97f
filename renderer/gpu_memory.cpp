// Allocates buffers and images and moves bytes between them and the CPU.
#include "renderer/gpu_memory.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

namespace parafovea {
namespace {

VkImageAspectFlags aspect_of(VkFormat format) {
    switch (format) {
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_D32_SFLOAT:
        case VK_FORMAT_X8_D24_UNORM_PACK32:
            return VK_IMAGE_ASPECT_DEPTH_BIT;
        default:
            return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

VkImageSubresourceRange whole_of(const GpuImage& image) {
    return {image.aspect(), 0, image.mip_levels(), 0, image.layers()};
}

OwnedImageView create_view(Gpu& gpu, VkImage image, VkFormat format, VkImageViewType type,
                           const VkImageSubresourceRange& range) {
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = image;
    info.viewType = type;
    info.format = format;
    info.subresourceRange = range;
    VkImageView view = VK_NULL_HANDLE;
    check_vulkan(vkCreateImageView(gpu.device(), &info, nullptr, &view), "creating an image view");
    return {gpu.device(), view};
}

// Says in one line why an image cannot be made, before the driver is asked.
void check_image_size(const Gpu& gpu, const ImageDescription& d) {
    assert(d.width > 0 && d.height > 0 && d.layers > 0 && d.mip_levels > 0);
    const std::uint32_t limit = gpu.limits().maxImageDimension2D;
    if (d.width > limit || d.height > limit) {
        throw std::runtime_error("an image of " + std::to_string(d.width) + "x" + std::to_string(d.height) +
                                 " is too large: " + gpu.device_name() + " allows at most " +
                                 std::to_string(limit) + " pixels per side");
    }
    if (d.layers > gpu.limits().maxImageArrayLayers) {
        throw std::runtime_error("an image of " + std::to_string(d.layers) +
                                 " layers is too large: " + gpu.device_name() + " allows at most " +
                                 std::to_string(gpu.limits().maxImageArrayLayers) + " layers");
    }
}

}  // namespace

GpuMemory::GpuMemory(Gpu& gpu, const VkMemoryRequirements& requirements, VkMemoryPropertyFlags required,
                     VkMemoryPropertyFlags wanted)
    : gpu_(&gpu), bytes_(requirements.size) {
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    info.allocationSize = requirements.size;
    info.memoryTypeIndex = gpu.memory_type(requirements.memoryTypeBits, required, wanted);
    VkDeviceMemory memory = VK_NULL_HANDLE;
    const VkResult result = vkAllocateMemory(gpu.device(), &info, nullptr, &memory);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) {
        throw std::runtime_error("out of memory on " + gpu.device_name() + ": " +
                                 std::to_string(requirements.size >> 20) + " MiB more were needed beside " +
                                 std::to_string(gpu.allocated_bytes() >> 20) +
                                 " MiB in use; use a smaller picture or scene");
    }
    check_vulkan(result, "allocating memory");
    memory_ = {gpu.device(), memory};
    gpu.count_allocation(bytes_);
}

GpuMemory::GpuMemory(GpuMemory&& other) noexcept
    : gpu_(std::exchange(other.gpu_, nullptr)), bytes_(other.bytes_), memory_(std::move(other.memory_)) {}

GpuMemory& GpuMemory::operator=(GpuMemory&& other) noexcept {
    std::swap(gpu_, other.gpu_);
    std::swap(bytes_, other.bytes_);
    memory_ = std::move(other.memory_);
    return *this;
}

GpuMemory::~GpuMemory() {
    if (gpu_ != nullptr && memory_) gpu_->count_release(bytes_);
}

GpuBuffer::GpuBuffer(Gpu& gpu, VkDeviceSize bytes, VkBufferUsageFlags usage, BufferPlace place)
    : bytes_(bytes) {
    assert(bytes > 0);
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = bytes;
    info.usage = usage | (place == BufferPlace::device ? VK_BUFFER_USAGE_TRANSFER_DST_BIT : 0);
    VkBuffer buffer = VK_NULL_HANDLE;
    check_vulkan(vkCreateBuffer(gpu.device(), &info, nullptr, &buffer), "creating a buffer");
    buffer_ = {gpu.device(), buffer};
    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(gpu.device(), buffer, &requirements);
    const VkMemoryPropertyFlags mapped =
        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    switch (place) {
        case BufferPlace::device:
            memory_ = GpuMemory(gpu, requirements, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
            break;
        case BufferPlace::upload:
            memory_ = GpuMemory(gpu, requirements, mapped, 0);
            break;
        case BufferPlace::readback:
            memory_ = GpuMemory(gpu, requirements, mapped, VK_MEMORY_PROPERTY_HOST_CACHED_BIT);
            break;
    }
    check_vulkan(vkBindBufferMemory(gpu.device(), buffer, memory_.get(), 0), "binding a buffer's memory");
    if (place != BufferPlace::device) {
        void* address = nullptr;
        check_vulkan(vkMapMemory(gpu.device(), memory_.get(), 0, VK_WHOLE_SIZE, 0, &address),
                     "mapping memory");
        mapped_ = static_cast<std::byte*>(address);
    }
}

void GpuBuffer::write_bytes(std::span<const std::byte> bytes) {
    assert(mapped_ != nullptr && bytes.size() <= bytes_);
    std::memcpy(mapped_, bytes.data(), bytes.size());
}

GpuImage::GpuImage(Gpu& gpu, const ImageDescription& description)
    : description_(description), aspect_(aspect_of(description.format)) {
    check_image_size(gpu, description);
    if (description_.layers > 1 && description_.view_type == VK_IMAGE_VIEW_TYPE_2D) {
        description_.view_type = VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    }
    const bool cube = description_.view_type == VK_IMAGE_VIEW_TYPE_CUBE ||
                      description_.view_type == VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.flags = cube ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = description_.format;
    info.extent = {description_.width, description_.height, 1};
    info.mipLevels = description_.mip_levels;
    info.arrayLayers = description_.layers;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.tiling = VK_IMAGE_TILING_OPTIMAL;
    info.usage = description_.usage;
    VkImage image = VK_NULL_HANDLE;
    check_vulkan(vkCreateImage(gpu.device(), &info, nullptr, &image), "creating an image");
    image_ = {gpu.device(), image};
    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(gpu.device(), image, &requirements);
    memory_ = GpuMemory(gpu, requirements, 0, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    check_vulkan(vkBindImageMemory(gpu.device(), image, memory_.get(), 0), "binding an image's memory");
    view_ = create_view(gpu, image, description_.format, description_.view_type, whole_of(*this));
}

OwnedImageView GpuImage::make_view(Gpu& gpu, std::uint32_t layer, std::uint32_t mip_level) const {
    return create_view(gpu, get(), format(), VK_IMAGE_VIEW_TYPE_2D, {aspect_, mip_level, 1, layer, 1});
}

void image_barrier(VkCommandBuffer commands, VkImage image, const VkImageSubresourceRange& range,
                   const ResourceUse& before, const ResourceUse& after) {
    VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    barrier.srcStageMask = before.stages;
    barrier.srcAccessMask = before.accesses;
    barrier.dstStageMask = after.stages;
    barrier.dstAccessMask = after.accesses;
    barrier.oldLayout = before.layout;
    barrier.newLayout = after.layout;
    barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = range;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

void image_barrier(VkCommandBuffer commands, const GpuImage& image, const ResourceUse& before,
                   const ResourceUse& after) {
    image_barrier(commands, image.get(), whole_of(image), before, after);
}

void memory_barrier(VkCommandBuffer commands, const ResourceUse& before, const ResourceUse& after) {
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = before.stages;
    barrier.srcAccessMask = before.accesses;
    barrier.dstStageMask = after.stages;
    barrier.dstAccessMask = after.accesses;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

void upload(Gpu& gpu, const GpuBuffer& buffer, std::span<const std::byte> bytes) {
    assert(bytes.size() <= buffer.size_bytes());
    if (bytes.empty()) return;
    GpuBuffer staging(gpu, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferPlace::upload);
    staging.write(bytes);
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        const VkBufferCopy copy{0, 0, bytes.size()};
        vkCmdCopyBuffer(commands, staging.get(), buffer.get(), 1, &copy);
        memory_barrier(
            commands, kUseTransferTarget,
            {VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
             VK_IMAGE_LAYOUT_UNDEFINED});
    });
}

void upload(Gpu& gpu, const GpuImage& image, std::span<const std::byte> texels, std::uint32_t first_layer,
            std::uint32_t layer_count) {
    const VkExtent2D extent = image.extent();
    assert(texels.size() ==
           std::size_t{extent.width} * extent.height * layer_count * bytes_per_texel(image.format()));
    GpuBuffer staging(gpu, texels.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, BufferPlace::upload);
    staging.write(texels);
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        const auto levels = [&](std::uint32_t first, std::uint32_t count) {
            return VkImageSubresourceRange{image.aspect(), first, count, first_layer, layer_count};
        };
        image_barrier(commands, image.get(), levels(0, image.mip_levels()), kUseNone, kUseTransferTarget);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {image.aspect(), 0, first_layer, layer_count};
        copy.imageExtent = {extent.width, extent.height, 1};
        vkCmdCopyBufferToImage(commands, staging.get(), image.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                               &copy);

        // Halve each level into the next.
        const auto side = [](std::uint32_t pixels, std::uint32_t level) {
            return static_cast<std::int32_t>(std::max(pixels >> level, 1u));
        };
        for (std::uint32_t level = 1; level < image.mip_levels(); ++level) {
            image_barrier(commands, image.get(), levels(level - 1, 1), kUseTransferTarget,
                          kUseTransferSource);
            VkImageBlit blit{};
            blit.srcSubresource = {image.aspect(), level - 1, first_layer, layer_count};
            blit.srcOffsets[1] = {side(extent.width, level - 1), side(extent.height, level - 1), 1};
            blit.dstSubresource = {image.aspect(), level, first_layer, layer_count};
            blit.dstOffsets[1] = {side(extent.width, level), side(extent.height, level), 1};
            vkCmdBlitImage(commands, image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image.get(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
            image_barrier(commands, image.get(), levels(level - 1, 1), kUseTransferSource, kUseSampled);
        }
        image_barrier(commands, image.get(), levels(image.mip_levels() - 1, 1), kUseTransferTarget,
                      kUseSampled);
    });
}

std::uint32_t bytes_per_texel(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8_UNORM:
        case VK_FORMAT_R8_UINT:
            return 1;
        case VK_FORMAT_R8G8_UNORM:
        case VK_FORMAT_R16_SFLOAT:
        case VK_FORMAT_R16_UNORM:
        case VK_FORMAT_D16_UNORM:
            return 2;
        case VK_FORMAT_R8G8B8A8_UNORM:
        case VK_FORMAT_R8G8B8A8_SRGB:
        case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
        case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
        case VK_FORMAT_R16G16_SFLOAT:
        case VK_FORMAT_R16G16_SNORM:
        case VK_FORMAT_R32_SFLOAT:
        case VK_FORMAT_R32_UINT:
        case VK_FORMAT_D32_SFLOAT:
            return 4;
        case VK_FORMAT_R16G16B16A16_SFLOAT:
        case VK_FORMAT_R16G16B16A16_UNORM:
        case VK_FORMAT_R32G32_SFLOAT:
        case VK_FORMAT_R32G32_UINT:
            return 8;
        case VK_FORMAT_R32G32B32A32_SFLOAT:
        case VK_FORMAT_R32G32B32A32_UINT:
            return 16;
        default:
            assert(!"bytes_per_texel: a format that is not used here");
            return 0;
    }
}

std::vector<std::byte> read_back(Gpu& gpu, const GpuImage& image, const ResourceUse& use) {
    const VkExtent2D extent = image.extent();
    std::vector<std::byte> bytes(std::size_t{extent.width} * extent.height * bytes_per_texel(image.format()));
    GpuBuffer staging(gpu, bytes.size(), VK_BUFFER_USAGE_TRANSFER_DST_BIT, BufferPlace::readback);
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        const VkImageSubresourceRange range{image.aspect(), 0, 1, 0, 1};
        image_barrier(commands, image.get(), range, use, kUseTransferSource);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {image.aspect(), 0, 0, 1};
        copy.imageExtent = {extent.width, extent.height, 1};
        vkCmdCopyImageToBuffer(commands, image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.get(), 1,
                               &copy);
        image_barrier(commands, image.get(), range, kUseTransferSource, use);
        memory_barrier(commands, kUseTransferTarget, kUseHostRead);
    });
    std::memcpy(bytes.data(), staging.mapped(), bytes.size());
    return bytes;
}

VkFormat display_linear_format(const Gpu& gpu) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(gpu.physical_device(), VK_FORMAT_R16G16B16A16_UNORM, &properties);
    const VkFormatFeatureFlags needed =
        VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    return (properties.optimalTilingFeatures & needed) == needed ? VK_FORMAT_R16G16B16A16_UNORM
                                                                 : VK_FORMAT_R16G16B16A16_SFLOAT;
}

OwnedSampler make_sampler(Gpu& gpu, const SamplerDescription& description) {
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = description.filter;
    info.minFilter = description.filter;
    info.mipmapMode = description.mipmap;
    info.addressModeU = description.address_u;
    info.addressModeV = description.address_v;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.maxLod = VK_LOD_CLAMP_NONE;
    if (gpu.features().samplerAnisotropy && description.max_anisotropy > 1) {
        info.anisotropyEnable = VK_TRUE;
        info.maxAnisotropy = std::min(description.max_anisotropy, gpu.limits().maxSamplerAnisotropy);
    }
    if (description.compare) {
        info.compareEnable = VK_TRUE;
        info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    }
    VkSampler sampler = VK_NULL_HANDLE;
    check_vulkan(vkCreateSampler(gpu.device(), &info, nullptr, &sampler), "creating a sampler");
    return {gpu.device(), sampler};
}

}  // namespace parafovea
