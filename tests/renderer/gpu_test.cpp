// The device: what comes back is what was drawn, and what cannot be done is said in one line.
#include "renderer/gpu.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <stdexcept>

#include "renderer/gpu_memory.h"
#include "renderer/gpu_pipeline.h"
#include "tests/message_of.h"

namespace parafovea {
namespace {

TEST(Gpu, NamesItsDeviceAndDriver) {
    const Gpu gpu({.validation = true});
    EXPECT_FALSE(gpu.device_name().empty());
    EXPECT_FALSE(gpu.driver_name().empty());
    EXPECT_TRUE(gpu.validation_messages().empty());
}

TEST(Gpu, SaysInOneLineThatNoDeviceHasTheName) {
    const std::string message = message_of([] { Gpu({.device_name = "abacus"}); });
    EXPECT_NE(message.find("no usable Vulkan device"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST(Gpu, SaysInOneLineThatNoDriverIsInstalled) {
    // In another process: the loader reads these variables once.
    EXPECT_EXIT(
        {
            setenv("VK_ICD_FILENAMES", "/nonexistent.json", 1);
            setenv("VK_DRIVER_FILES", "/nonexistent.json", 1);
            const std::string message = message_of([] { Gpu(); });
            const bool good = message.find("no Vulkan device found") != std::string::npos &&
                              message.find("mesa-vulkan-drivers") != std::string::npos &&
                              message.find('\n') == std::string::npos;
            std::exit(good ? 0 : 1);
        },
        testing::ExitedWithCode(0), "");
}

TEST(Gpu, RecordsWhatValidationSays) {
    Gpu gpu({.validation = true});
    GpuImage image(gpu, {.format = VK_FORMAT_R8G8B8A8_UNORM,
                         .width = 4,
                         .height = 4,
                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        const VkClearColorValue red{{1, 0, 0, 1}};
        const VkImageSubresourceRange range{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        image_barrier(commands, image, kUseNone, kUseTransferTarget);
        // Two writes with nothing between them: a hazard that only synchronization validation sees.
        vkCmdClearColorImage(commands, image.get(), kUseTransferTarget.layout, &red, 1, &range);
        vkCmdClearColorImage(commands, image.get(), kUseTransferTarget.layout, &red, 1, &range);
    });
    ASSERT_FALSE(gpu.validation_messages().empty());
    EXPECT_NE(gpu.validation_messages()[0].find("SYNC-HAZARD"), std::string::npos)
        << gpu.validation_messages()[0];
}

TEST(Gpu, RefusesAnImageLargerThanTheDeviceAllows) {
    Gpu gpu({.validation = true});
    const std::string message = message_of([&] {
        GpuImage(gpu, {.width = gpu.limits().maxImageDimension2D + 1,
                       .height = 1,
                       .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    });
    EXPECT_NE(message.find("too large"), std::string::npos) << message;
    EXPECT_TRUE(gpu.validation_messages().empty());
}

TEST(Gpu, SaysInOneLineThatMemoryIsFullAndStaysUsable) {
    Gpu gpu;
    const std::string message = message_of([&] {
        GpuBuffer(gpu, VkDeviceSize{1} << 50, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device);
    });
    EXPECT_NE(message.find("memory is full"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_TRUE(GpuBuffer(gpu, 1 << 10, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device));
}

TEST(Gpu, SaysInOneLineWhatALostDeviceMeans) {
    const std::string message =
        message_of([] { check_vulkan(VK_ERROR_DEVICE_LOST, "waiting for the device"); });
    EXPECT_NE(message.find("waiting for the device"), std::string::npos) << message;
    EXPECT_NE(message.find("start again"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST(Gpu, CountsMemoryUntilItIsReleased) {
    Gpu gpu;
    const VkDeviceSize before = gpu.allocated_bytes();
    {
        GpuBuffer buffer(gpu, 1 << 20, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, BufferPlace::device);
        GpuBuffer moved = std::move(buffer);
        EXPECT_GE(gpu.allocated_bytes(), before + (1 << 20));
    }
    EXPECT_EQ(gpu.allocated_bytes(), before);
    EXPECT_GE(gpu.peak_allocated_bytes(), before + (1 << 20));
}

TEST(GpuMemory, ImageComesBackAsUploaded) {
    Gpu gpu({.validation = true});
    GpuImage image(gpu, {.format = VK_FORMAT_R8G8B8A8_UNORM,
                         .width = 5,
                         .height = 3,
                         .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                  VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                         .mip_levels = 3});
    std::vector<std::byte> texels(5 * 3 * 4);
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = static_cast<std::byte>(i * 7);
    upload(gpu, image, texels);
    EXPECT_EQ(read_back(gpu, image, kUseSampled), texels);
    EXPECT_TRUE(gpu.validation_messages().empty());
}

}  // namespace
}  // namespace parafovea
