// A window of the desktop with a Vulkan device and a swapchain.
//
// Windows are made, moved and closed by the main thread, which also polls their events; presenting is done by
// one thread, which may be another.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/geometry.h"
#include "renderer/gpu.h"
#include "renderer/gpu_memory.h"

struct GLFWwindow;

namespace parafovea {

// The window system; lives longer than its windows.
class WindowSystem {
  public:
    // Throws std::runtime_error with one line where there is no display.
    WindowSystem();
    ~WindowSystem();
    WindowSystem(const WindowSystem&) = delete;
    WindowSystem& operator=(const WindowSystem&) = delete;

    void wait_for_events(double at_most_s);
};

struct Monitor {
    std::string name;
    SizePx size;
    int left = 0, top = 0;  // on the desktop
    double refresh_hz = 0;  // 0: not known, as on virtual displays
};

// Those that are connected now, the primary one first. Never empty: throws instead.
std::vector<Monitor> connected_monitors();

struct WindowDescription {
    std::string title;
    SizePx size;
    int left = 0, top = 0;
    std::optional<int> full_screen_on;  // a monitor's number; takes its whole picture
    bool resizable = false;
    bool takes_focus = true;
};

// Where a picture stands in a window: in the middle, never enlarged, reduced where it does not fit.
struct Placement {
    double left_px = 0, top_px = 0;
    double scale = 1;
};
Placement placement_of(SizePx picture, SizePx window);

class WindowSurface {
  public:
    // Throws std::runtime_error with one line.
    explicit WindowSurface(const WindowDescription& description);
    ~WindowSurface();
    WindowSurface(const WindowSurface&) = delete;
    WindowSurface& operator=(const WindowSurface&) = delete;

    GLFWwindow* window() const { return window_; }
    Gpu& gpu() const { return *gpu_; }
    SizePx size() const { return {static_cast<int>(extent_.width), static_cast<int>(extent_.height)}; }
    VkFormat format() const { return format_; }
    const std::vector<VkImage>& images() const { return images_; }
    // Counts how often the swapchain was made; images() are new after each.
    int generation() const { return generation_; }
    bool close_requested() const;

    // Waits for a free picture: with a display's own refresh, for as long as that takes. It stays acquired
    // until present().
    std::uint32_t acquire();

    // `record` finds the picture with undefined contents and leaves it in VK_IMAGE_LAYOUT_PRESENT_SRC_KHR.
    void present(const std::function<void(VkCommandBuffer, VkImage)>& record);

  private:
    void make_swapchain();

    GLFWwindow* window_ = nullptr;
    std::unique_ptr<Gpu> gpu_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkExtent2D extent_{};
    std::vector<VkImage> images_;
    std::optional<std::uint32_t> acquired_;
    int generation_ = 0;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkCommandBuffer commands_ = VK_NULL_HANDLE;
    Owned<VkSemaphore, vkDestroySemaphore> drawn_;
    Owned<VkFence, vkDestroyFence> free_, done_;
};

}  // namespace parafovea
