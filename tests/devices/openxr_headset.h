// Puts the simulated headset, under OpenXR's and Vulkan's validation layers, before a test.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/clock.h"
#include "devices/openxr/openxr_session.h"
#include "renderer/gpu.h"
#include "tests/temporary_folder.h"

namespace parafovea {

// The simulated headset under OpenXR's validation layer, which writes to a file that is read at the end.
class ValidationLayers {
  public:
    // For the next OpenXrInstance.
    void use(const std::string& settings) const {
        setenv("XR_RUNTIME_JSON", SIMULATED_HEADSET_JSON, 1);
        setenv("XR_ENABLE_API_LAYERS", "XR_APILAYER_LUNARG_core_validation", 1);
        setenv("XR_CORE_VALIDATION_EXPORT_TYPE", "text", 1);
        setenv("XR_CORE_VALIDATION_FILE_NAME", openxr_messages().c_str(), 1);
        const std::string all =
            "log=" + frames().string() + ";control=" + control().string() + ";" + settings;
        setenv("PARAFOVEA_HEADSET", all.c_str(), 1);
    }

    // Lets an event happen at the headset's next frame.
    void happen(const std::string& event) const {
        std::ofstream(control(), std::ios::app) << event << std::endl;
    }

    // Once the instance is gone.
    void expect_silence() const { EXPECT_EQ(text_of(openxr_messages()), ""); }

    // The runtime's own account: a line a frame after the header.
    std::filesystem::path frames() const { return folder_ / "frames.csv"; }

  private:
    std::filesystem::path openxr_messages() const { return folder_ / "openxr.txt"; }
    std::filesystem::path control() const { return folder_ / "control.txt"; }

    TemporaryFolder folder_;
};

// Everything up to a Vulkan device that the runtime made. Both validation layers must have said nothing.
class Headset {
  public:
    explicit Headset(const std::string& settings) {
        layers_.use(settings);
        instance_.emplace();
        GpuOptions options;
        options.validation = true;
        options.maker = {[this](const auto& info, VkInstance& made) {
                             return instance_->make_vulkan_instance(info, made);
                         },
                         [this](VkInstance vulkan, VkPhysicalDevice& chosen) {
                             return instance_->choose_vulkan_device(vulkan, chosen);
                         },
                         [this](VkPhysicalDevice physical, const auto& info, VkDevice& made) {
                             return instance_->make_vulkan_device(physical, info, made);
                         }};
        gpu_ = std::make_unique<Gpu>(options);
    }

    // The session must be gone by now.
    ~Headset() {
        EXPECT_THAT(gpu_->validation_messages(), testing::IsEmpty());
        gpu_.reset();
        instance_.reset();
        layers_.expect_silence();
    }

    const OpenXrInstance& instance() const { return *instance_; }
    Gpu& gpu() { return *gpu_; }
    OpenXrVulkan vulkan() const {
        return {gpu_->instance(), gpu_->physical_device(), gpu_->device(), gpu_->queue_family()};
    }
    std::filesystem::path log_path() const { return layers_.frames(); }

  private:
    ValidationLayers layers_;
    std::optional<OpenXrInstance> instance_;
    std::unique_ptr<Gpu> gpu_;
};

// Fills a view's image with one colour.
inline void draw_colour(Gpu& gpu, VkImage image, std::array<float, 4> rgba) {
    gpu.submit_and_wait([&](VkCommandBuffer commands) {
        VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
        barrier.oldLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        barrier.newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.image = image;
        barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        const auto wait = [&] {
            vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                 VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
        };
        wait();
        const VkClearColorValue colour{{rgba[0], rgba[1], rgba[2], rgba[3]}};
        vkCmdClearColorImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &colour, 1,
                             &barrier.subresourceRange);
        std::swap(barrier.oldLayout, barrier.newLayout);
        barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
        barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        wait();
    });
}

// One turn: draws grey on every view if it will be seen.
inline std::optional<OpenXrFrame> run_frame(OpenXrSession& session, Gpu& gpu) {
    std::optional<OpenXrFrame> frame = session.begin_frame();
    if (!frame) return frame;
    bool drawn = frame->should_render && !frame->views.empty();
    for (std::size_t i = 0; drawn && i < frame->views.size(); ++i) {
        const std::optional<VkImage> image = session.acquire_image(i);
        drawn = image.has_value();
        if (!drawn) break;
        draw_colour(gpu, *image, {0.5f, 0.5f, 0.5f, 1});
        session.release_image(i);
    }
    session.end_frame(*frame, drawn);
    return frame;
}

// Runs frames until the session has the focus.
inline void run_until_focused(OpenXrSession& session, Gpu& gpu) {
    for (int i = 0; i < 20 && session.update() != SessionState::focused; ++i) run_frame(session, gpu);
    ASSERT_EQ(session.state(), SessionState::focused);
}

}  // namespace parafovea
