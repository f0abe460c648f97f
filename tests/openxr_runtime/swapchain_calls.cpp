// Swapchains of Vulkan images on the application's device, and pictures taken of them.
#include <array>
#include <filesystem>
#include <functional>

#include "tests/openxr_runtime/calls.h"

namespace parafovea::headset {

namespace {

constexpr std::uint32_t kImageCount = 3;
constexpr std::int64_t kFormats[] = {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_SRGB,
                                     VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_B8G8R8A8_UNORM};

// Finds a function of the session's Vulkan by its own name.
#define VULKAN(session, name) vulkan<PFN_##name>(*(session).instance, (session).graphics.instance, #name)

VkImageUsageFlags usage_of(XrSwapchainUsageFlags wanted) {
    VkImageUsageFlags usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;  // to take pictures of it
    if (wanted & XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT) usage |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    if (wanted & XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT) usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if (wanted & XR_SWAPCHAIN_USAGE_SAMPLED_BIT) usage |= VK_IMAGE_USAGE_SAMPLED_BIT;
    return usage;
}

std::optional<std::uint32_t> memory_type(const Session& session, std::uint32_t allowed,
                                         VkMemoryPropertyFlags needed) {
    VkPhysicalDeviceMemoryProperties memory;
    VULKAN(session, vkGetPhysicalDeviceMemoryProperties)(session.graphics.physical_device, &memory);
    for (std::uint32_t i = 0; i < memory.memoryTypeCount; ++i)
        if ((allowed >> i & 1) != 0 && (memory.memoryTypes[i].propertyFlags & needed) == needed) return i;
    return std::nullopt;
}

VkResult submit_and_wait(const Session& session, const std::function<void(VkCommandBuffer)>& record) {
    const Graphics& graphics = session.graphics;
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = graphics.pool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkResult result = VULKAN(session, vkAllocateCommandBuffers)(graphics.device, &allocate, &commands);
    if (result != VK_SUCCESS) return result;
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    result = VULKAN(session, vkBeginCommandBuffer)(commands, &begin);
    if (result == VK_SUCCESS) {
        record(commands);
        result = VULKAN(session, vkEndCommandBuffer)(commands);
    }
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    if (result == VK_SUCCESS)
        result = VULKAN(session, vkQueueSubmit)(graphics.queue, 1, &submit, VK_NULL_HANDLE);
    if (result == VK_SUCCESS) result = VULKAN(session, vkQueueWaitIdle)(graphics.queue);
    VULKAN(session, vkFreeCommandBuffers)(graphics.device, graphics.pool, 1, &commands);
    return result;
}

void change_layout(const Session& session, VkCommandBuffer commands, VkImage image, VkImageLayout before,
                   VkImageLayout after) {
    VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.oldLayout = before;
    barrier.newLayout = after;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0,
                                VK_REMAINING_ARRAY_LAYERS};
    VULKAN(session, vkCmdPipelineBarrier)
    (commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0,
     nullptr, 1, &barrier);
}

bool make_image(Swapchain& swapchain) {
    const Session& session = *swapchain.session;
    const XrSwapchainCreateInfo& wanted = swapchain.info;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = static_cast<VkFormat>(wanted.format);
    info.extent = {wanted.width, wanted.height, 1};
    info.mipLevels = wanted.mipCount;
    info.arrayLayers = wanted.arraySize;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage_of(wanted.usageFlags);
    VkImage image = VK_NULL_HANDLE;
    if (VULKAN(session, vkCreateImage)(session.graphics.device, &info, nullptr, &image) != VK_SUCCESS)
        return false;
    swapchain.images.push_back(image);
    VkMemoryRequirements requirements;
    VULKAN(session, vkGetImageMemoryRequirements)(session.graphics.device, image, &requirements);
    const auto type = memory_type(session, requirements.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    if (!type) return false;
    VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    allocate.allocationSize = requirements.size;
    allocate.memoryTypeIndex = *type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    if (VULKAN(session, vkAllocateMemory)(session.graphics.device, &allocate, nullptr, &memory) != VK_SUCCESS)
        return false;
    swapchain.memory.push_back(memory);
    return VULKAN(session, vkBindImageMemory)(session.graphics.device, image, memory, 0) == VK_SUCCESS;
}

void free_images(Swapchain& swapchain) {
    const Session& session = *swapchain.session;
    VULKAN(session, vkDeviceWaitIdle)(session.graphics.device);
    for (const VkImage image : swapchain.images)
        VULKAN(session, vkDestroyImage)(session.graphics.device, image, nullptr);
    for (const VkDeviceMemory memory : swapchain.memory)
        VULKAN(session, vkFreeMemory)(session.graphics.device, memory, nullptr);
}

void write_ppm(const std::filesystem::path& path, const XrExtent2Di& size, const std::uint8_t* texels,
               bool bgr) {
    std::ofstream out(path, std::ios::binary);
    out << "P6\n" << size.width << ' ' << size.height << "\n255\n";
    std::string row(static_cast<std::size_t>(size.width) * 3, '\0');
    for (int y = 0; y < size.height; ++y) {
        for (std::size_t x = 0; x < static_cast<std::size_t>(size.width); ++x, texels += 4)
            for (std::size_t c = 0; c < 3; ++c) row[3 * x + c] = static_cast<char>(texels[bgr ? 2 - c : c]);
        out << row;
    }
}

}  // namespace

XrResult enumerate_swapchain_formats(XrSession, std::uint32_t capacity, std::uint32_t* count,
                                     std::int64_t* formats) {
    return enumerate<std::int64_t>(kFormats, capacity, count, formats);
}

XrResult create_swapchain(XrSession handle, const XrSwapchainCreateInfo* info, XrSwapchain* out) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (std::ranges::find(kFormats, info->format) == std::end(kFormats))
        return XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED;
    if (info->faceCount != 1 || info->sampleCount != 1 || info->width == 0 || info->height == 0 ||
        info->width > 4096 || info->height > 4096 || info->arraySize == 0 || info->mipCount == 0)
        return XR_ERROR_FEATURE_UNSUPPORTED;
    auto swapchain = std::make_unique<Swapchain>();
    swapchain->session = &session;
    swapchain->info = *info;
    bool made = true;
    for (std::uint32_t i = 0; made && i < kImageCount; ++i) made = make_image(*swapchain);
    made = made && submit_and_wait(session, [&](VkCommandBuffer commands) {
                       for (const VkImage image : swapchain->images)
                           change_layout(session, commands, image, VK_IMAGE_LAYOUT_UNDEFINED,
                                         VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
                   }) == VK_SUCCESS;
    if (!made) {
        free_images(*swapchain);
        return XR_ERROR_OUT_OF_MEMORY;
    }
    *out = handle_of<XrSwapchain>(swapchain.get());
    session.swapchains.push_back(std::move(swapchain));
    return XR_SUCCESS;
}

XrResult destroy_swapchain(XrSwapchain handle) {
    if (handle == XR_NULL_HANDLE) return XR_ERROR_HANDLE_INVALID;
    Swapchain& swapchain = *object_of<Swapchain>(handle);
    Session& session = *swapchain.session;
    const std::lock_guard lock(session.instance->mutex);
    free_images(swapchain);
    std::erase_if(session.swapchains, [&](const auto& owned) { return owned.get() == &swapchain; });
    return XR_SUCCESS;
}

XrResult enumerate_swapchain_images(XrSwapchain handle, std::uint32_t capacity, std::uint32_t* count,
                                    XrSwapchainImageBaseHeader* images) {
    const Swapchain& swapchain = *object_of<Swapchain>(handle);
    *count = static_cast<std::uint32_t>(swapchain.images.size());
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < *count) return XR_ERROR_SIZE_INSUFFICIENT;
    auto* vulkan_images = reinterpret_cast<XrSwapchainImageVulkanKHR*>(images);
    for (std::uint32_t i = 0; i < *count; ++i) vulkan_images[i].image = swapchain.images[i];
    return XR_SUCCESS;
}

XrResult acquire_swapchain_image(XrSwapchain handle, const XrSwapchainImageAcquireInfo*,
                                 std::uint32_t* index) {
    Swapchain& swapchain = *object_of<Swapchain>(handle);
    const std::lock_guard lock(swapchain.session->instance->mutex);
    if (swapchain.session->lost) return XR_ERROR_SESSION_LOST;
    if (swapchain.acquired.size() == swapchain.images.size()) return XR_ERROR_CALL_ORDER_INVALID;
    *index = swapchain.next;
    swapchain.acquired.push_back(swapchain.next);
    swapchain.next = (swapchain.next + 1) % static_cast<std::uint32_t>(swapchain.images.size());
    return XR_SUCCESS;
}

XrResult wait_swapchain_image(XrSwapchain handle, const XrSwapchainImageWaitInfo*) {
    Swapchain& swapchain = *object_of<Swapchain>(handle);
    const std::lock_guard lock(swapchain.session->instance->mutex);
    if (swapchain.session->lost) return XR_ERROR_SESSION_LOST;
    if (swapchain.acquired.empty() || swapchain.waited) return XR_ERROR_CALL_ORDER_INVALID;
    swapchain.waited = true;
    return XR_SUCCESS;
}

XrResult release_swapchain_image(XrSwapchain handle, const XrSwapchainImageReleaseInfo*) {
    Swapchain& swapchain = *object_of<Swapchain>(handle);
    const std::lock_guard lock(swapchain.session->instance->mutex);
    if (swapchain.session->lost) return XR_ERROR_SESSION_LOST;
    if (!swapchain.waited) return XR_ERROR_CALL_ORDER_INVALID;
    swapchain.released = swapchain.acquired.front();
    swapchain.acquired.pop_front();
    swapchain.waited = false;
    return XR_SUCCESS;
}

VkResult capture_layer(const Session& session, const XrCompositionLayerProjection& layer,
                       std::int64_t frame) {
    const VkDevice device = session.graphics.device;
    for (std::uint32_t i = 0; i < layer.viewCount; ++i) {
        const XrSwapchainSubImage& part = layer.views[i].subImage;
        const Swapchain& swapchain = *object_of<Swapchain>(part.swapchain);
        const VkImage image = swapchain.images[*swapchain.released];
        const XrExtent2Di size = part.imageRect.extent;

        // A buffer that the CPU can read.
        VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
        info.size = static_cast<VkDeviceSize>(size.width) * static_cast<VkDeviceSize>(size.height) * 4;
        info.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        VkBuffer buffer = VK_NULL_HANDLE;
        VkDeviceMemory memory = VK_NULL_HANDLE;
        VkResult result = VULKAN(session, vkCreateBuffer)(device, &info, nullptr, &buffer);
        if (result != VK_SUCCESS) return result;
        VkMemoryRequirements requirements;
        VULKAN(session, vkGetBufferMemoryRequirements)(device, buffer, &requirements);
        const auto type =
            memory_type(session, requirements.memoryTypeBits,
                        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
        allocate.allocationSize = requirements.size;
        allocate.memoryTypeIndex = type.value_or(0);
        result = VULKAN(session, vkAllocateMemory)(device, &allocate, nullptr, &memory);
        if (result == VK_SUCCESS) result = VULKAN(session, vkBindBufferMemory)(device, buffer, memory, 0);

        // Copy, and leave the image as it was.
        if (result == VK_SUCCESS) {
            result = submit_and_wait(session, [&](VkCommandBuffer commands) {
                change_layout(session, commands, image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                              VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
                VkBufferImageCopy copy{};
                copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, part.imageArrayIndex, 1};
                copy.imageOffset = {part.imageRect.offset.x, part.imageRect.offset.y, 0};
                copy.imageExtent = {static_cast<std::uint32_t>(size.width),
                                    static_cast<std::uint32_t>(size.height), 1};
                VULKAN(session, vkCmdCopyImageToBuffer)
                (commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer, 1, &copy);
                change_layout(session, commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                              VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
            });
        }
        void* mapped = nullptr;
        if (result == VK_SUCCESS)
            result = VULKAN(session, vkMapMemory)(device, memory, 0, VK_WHOLE_SIZE, 0, &mapped);
        if (result == VK_SUCCESS) {
            const std::string name = "frame_" + std::to_string(frame) + "_view_" + std::to_string(i) + ".ppm";
            const auto format = static_cast<VkFormat>(swapchain.info.format);
            write_ppm(session.instance->settings.capture / name, size, static_cast<std::uint8_t*>(mapped),
                      format == VK_FORMAT_B8G8R8A8_SRGB || format == VK_FORMAT_B8G8R8A8_UNORM);
        }
        VULKAN(session, vkDestroyBuffer)(device, buffer, nullptr);
        VULKAN(session, vkFreeMemory)(device, memory, nullptr);
        if (result != VK_SUCCESS) return result;
    }
    return VK_SUCCESS;
}

}  // namespace parafovea::headset
