// GLFW windows and Vulkan swapchains.
#define GLFW_INCLUDE_VULKAN
#include "app/window_surface.h"

#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

namespace parafovea {

namespace {

std::runtime_error window_error(const std::string& doing) {
    const char* reason = nullptr;
    glfwGetError(&reason);
    return std::runtime_error(doing + ": " + (reason ? reason : "the window system gave no reason") +
                              "; is a display connected and DISPLAY set? Under a server use xvfb-run");
}

GpuOptions options_for_windows() {
    GpuOptions options;
    options.maker.instance = [](const VkInstanceCreateInfo& wanted, VkInstance& instance) {
        std::uint32_t count = 0;
        const char** needed = glfwGetRequiredInstanceExtensions(&count);
        if (!needed) return VK_ERROR_EXTENSION_NOT_PRESENT;
        std::vector<const char*> extensions(wanted.ppEnabledExtensionNames,
                                            wanted.ppEnabledExtensionNames + wanted.enabledExtensionCount);
        extensions.insert(extensions.end(), needed, needed + count);
        VkInstanceCreateInfo info = wanted;
        info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
        info.ppEnabledExtensionNames = extensions.data();
        return vkCreateInstance(&info, nullptr, &instance);
    };
    options.maker.device = [](VkPhysicalDevice physical, const VkDeviceCreateInfo& wanted, VkDevice& device) {
        std::vector<const char*> extensions(wanted.ppEnabledExtensionNames,
                                            wanted.ppEnabledExtensionNames + wanted.enabledExtensionCount);
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
        VkDeviceCreateInfo info = wanted;
        info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
        info.ppEnabledExtensionNames = extensions.data();
        return vkCreateDevice(physical, &info, nullptr, &device);
    };
    return options;
}

}  // namespace

WindowSystem::WindowSystem() {
    if (glfwInit() != GLFW_TRUE) throw window_error("opening the window system");
    if (glfwVulkanSupported() != GLFW_TRUE) {
        glfwTerminate();
        throw std::runtime_error(
            "opening the window system: no Vulkan driver can show windows; install "
            "mesa-vulkan-drivers or your GPU's driver");
    }
}

WindowSystem::~WindowSystem() {
    glfwTerminate();
}

void WindowSystem::wait_for_events(double at_most_s) {
    glfwWaitEventsTimeout(at_most_s);
}

std::vector<Monitor> connected_monitors() {
    int count = 0;
    GLFWmonitor** found = glfwGetMonitors(&count);
    std::vector<Monitor> monitors;
    for (int i = 0; i < count; ++i) {
        const GLFWvidmode* mode = glfwGetVideoMode(found[i]);
        if (!mode) continue;
        Monitor monitor{
            glfwGetMonitorName(found[i]), {mode->width, mode->height}, 0, 0, double(mode->refreshRate)};
        glfwGetMonitorPos(found[i], &monitor.left, &monitor.top);
        monitors.push_back(monitor);
    }
    if (monitors.empty())
        throw std::runtime_error("no monitor is connected; connect one, or use --display headless");
    return monitors;
}

Placement placement_of(SizePx picture, SizePx window) {
    Placement placement;
    placement.scale = std::min({1.0, static_cast<double>(window.width) / picture.width,
                                static_cast<double>(window.height) / picture.height});
    // Whole pixels, so that a picture that fits is shown pixel by pixel.
    placement.left_px = std::floor((window.width - placement.scale * picture.width) / 2);
    placement.top_px = std::floor((window.height - placement.scale * picture.height) / 2);
    return placement;
}

WindowSurface::WindowSurface(const WindowDescription& description) {
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_RESIZABLE, description.resizable ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_FOCUS_ON_SHOW, description.takes_focus ? GLFW_TRUE : GLFW_FALSE);
    glfwWindowHint(GLFW_AUTO_ICONIFY,
                   GLFW_FALSE);  // the participant's picture stays when the operator clicks
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    GLFWmonitor* monitor = nullptr;
    if (description.full_screen_on) {
        int count = 0;
        GLFWmonitor** monitors = glfwGetMonitors(&count);
        if (*description.full_screen_on < 0 || *description.full_screen_on >= count)
            throw std::runtime_error("monitor " + std::to_string(*description.full_screen_on) +
                                     ": expected 0 to " + std::to_string(count - 1) +
                                     "; see parafovea devices");
        monitor = monitors[*description.full_screen_on];
    }
    window_ = glfwCreateWindow(description.size.width, description.size.height, description.title.c_str(),
                               monitor, nullptr);
    if (!window_) throw window_error("opening the window \"" + description.title + "\"");
    if (!monitor) glfwSetWindowPos(window_, description.left, description.top);
    glfwShowWindow(window_);

    gpu_ = std::make_unique<Gpu>(options_for_windows());
    if (glfwGetPhysicalDevicePresentationSupport(gpu_->instance(), gpu_->physical_device(),
                                                 gpu_->queue_family()) != GLFW_TRUE)
        throw std::runtime_error("the Vulkan device " + gpu_->device_name() +
                                 " cannot show windows on this display; connect the display to it");
    check_vulkan(glfwCreateWindowSurface(gpu_->instance(), window_, nullptr, &surface_),
                 "making a window's surface");

    const VkDevice device = gpu_->device();
    const VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                       VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, gpu_->queue_family()};
    check_vulkan(vkCreateCommandPool(device, &pool, nullptr, &pool_), "making a window's commands");
    const VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                               VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    check_vulkan(vkAllocateCommandBuffers(device, &allocate, &commands_), "making a window's commands");
    const VkSemaphoreCreateInfo semaphore_info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    check_vulkan(vkCreateSemaphore(device, &semaphore_info, nullptr, &semaphore),
                 "making a window's semaphore");
    drawn_ = {device, semaphore};
    const VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
    VkFence fence = VK_NULL_HANDLE;
    check_vulkan(vkCreateFence(device, &fence_info, nullptr, &fence), "making a window's fence");
    free_ = {device, fence};
    check_vulkan(vkCreateFence(device, &fence_info, nullptr, &fence), "making a window's fence");
    done_ = {device, fence};
    make_swapchain();
}

WindowSurface::~WindowSurface() {
    if (gpu_) {
        vkDeviceWaitIdle(gpu_->device());
        vkDestroySwapchainKHR(gpu_->device(), swapchain_, nullptr);
        vkDestroyCommandPool(gpu_->device(), pool_, nullptr);
        vkDestroySurfaceKHR(gpu_->instance(), surface_, nullptr);
    }
    drawn_ = {};
    free_ = {};
    done_ = {};
    gpu_.reset();
    if (window_) glfwDestroyWindow(window_);
}

bool WindowSurface::close_requested() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void WindowSurface::make_swapchain() {
    const VkDevice device = gpu_->device();
    vkDeviceWaitIdle(device);
    VkSurfaceCapabilitiesKHR can{};
    check_vulkan(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(gpu_->physical_device(), surface_, &can),
                 "asking what a window can show");

    // 8 bits a channel, the bytes as they are: pictures are sRGB encoded already.
    std::uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_->physical_device(), surface_, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(gpu_->physical_device(), surface_, &count, formats.data());
    const auto format = std::ranges::find_if(formats, [](const VkSurfaceFormatKHR& f) {
        return (f.format == VK_FORMAT_B8G8R8A8_UNORM || f.format == VK_FORMAT_R8G8B8A8_UNORM) &&
               f.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    });
    if (format == formats.end())
        throw std::runtime_error("the window shows no 8-bit sRGB pictures; set the desktop to 24-bit colour");

    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = surface_;
    info.minImageCount = std::max(2u, can.minImageCount);
    info.imageFormat = format->format;
    info.imageColorSpace = format->colorSpace;
    info.imageExtent = can.currentExtent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_FALSE;
    info.oldSwapchain = swapchain_;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    check_vulkan(vkCreateSwapchainKHR(device, &info, nullptr, &made), "making a window's pictures");
    vkDestroySwapchainKHR(device, swapchain_, nullptr);
    swapchain_ = made;
    format_ = info.imageFormat;
    extent_ = info.imageExtent;
    check_vulkan(vkGetSwapchainImagesKHR(device, swapchain_, &count, nullptr), "getting a window's pictures");
    images_.resize(count);
    check_vulkan(vkGetSwapchainImagesKHR(device, swapchain_, &count, images_.data()),
                 "getting a window's pictures");
    ++generation_;
}

std::uint32_t WindowSurface::acquire() {
    while (!acquired_) {
        const VkFence free = free_.get();
        check_vulkan(vkResetFences(gpu_->device(), 1, &free), "resetting a fence");
        std::uint32_t image = 0;
        const VkResult result =
            vkAcquireNextImageKHR(gpu_->device(), swapchain_, UINT64_MAX, VK_NULL_HANDLE, free, &image);
        if (result == VK_ERROR_OUT_OF_DATE_KHR) {
            make_swapchain();
            continue;
        }
        if (result != VK_SUBOPTIMAL_KHR) check_vulkan(result, "waiting for a free picture of a window");
        check_vulkan(vkWaitForFences(gpu_->device(), 1, &free, VK_TRUE, UINT64_MAX),
                     "waiting for a free picture of a window");
        acquired_ = image;
    }
    return *acquired_;
}

void WindowSurface::present(const std::function<void(VkCommandBuffer, VkImage)>& record) {
    const std::uint32_t image = acquire();
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                         VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
    check_vulkan(vkResetCommandBuffer(commands_, 0), "resetting commands");
    check_vulkan(vkBeginCommandBuffer(commands_, &begin), "recording commands");
    record(commands_, images_[image]);
    check_vulkan(vkEndCommandBuffer(commands_), "recording commands");

    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = commands_;
    VkSemaphoreSubmitInfo signal{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
    signal.semaphore = drawn_.get();
    signal.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    submit.signalSemaphoreInfoCount = 1;
    submit.pSignalSemaphoreInfos = &signal;
    const VkFence done = done_.get();
    check_vulkan(vkResetFences(gpu_->device(), 1, &done), "resetting a fence");
    check_vulkan(vkQueueSubmit2(gpu_->queue(), 1, &submit, done), "submitting a window's picture");

    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    const VkSemaphore drawn = drawn_.get();
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &drawn;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain_;
    info.pImageIndices = &image;
    const VkResult result = vkQueuePresentKHR(gpu_->queue(), &info);
    acquired_.reset();
    check_vulkan(vkWaitForFences(gpu_->device(), 1, &done, VK_TRUE, UINT64_MAX), "waiting for the device");
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR)
        make_swapchain();
    else
        check_vulkan(result, "showing a window's picture");
}

}  // namespace parafovea
