// parafovea devices: what is here, and how to get what is missing.
#include <cstdio>
#include <stdexcept>
#include <vector>

#include "app/commands.h"
#include "app/window_surface.h"
#include "devices/inventory.h"
#include "devices/openxr/openxr_instance.h"
#include "renderer/gpu.h"

namespace parafovea {

namespace {

void print_displays() {
    try {
        const WindowSystem system;
        int number = 0;
        for (const Monitor& monitor : connected_monitors()) {
            std::printf("display      monitor %d  %s, %d x %d, ", number++, monitor.name.c_str(),
                        monitor.size.width, monitor.size.height);
            if (monitor.refresh_hz > 0)
                std::printf("%g Hz\n", monitor.refresh_hz);
            else
                std::printf("no refresh of its own: frames follow the clock\n");
        }
    } catch (const std::runtime_error& reason) {
        std::printf("display      window     missing: %s\n", reason.what());
    }
    try {
        const OpenXrInstance headset;
        std::printf("display      openxr     %s on %s, %zu %s of %d x %d, %s\n",
                    headset.headset_name().c_str(), headset.runtime_name().c_str(),
                    headset.view_sizes().size(), headset.view_sizes().size() == 1 ? "view" : "views",
                    headset.view_sizes()[0].width, headset.view_sizes()[0].height,
                    headset.has_eye_tracker() ? "with an eye tracker" : "no eye tracker through OpenXR");
    } catch (const std::runtime_error& reason) {
        std::printf("display      openxr     missing: %s\n", reason.what());
    }
    std::printf("display      headless   here\n");
}

void print_vulkan_devices() {
    try {
        const Gpu gpu;
        std::uint32_t count = 0;
        vkEnumeratePhysicalDevices(gpu.instance(), &count, nullptr);
        std::vector<VkPhysicalDevice> devices(count);
        vkEnumeratePhysicalDevices(gpu.instance(), &count, devices.data());
        for (const VkPhysicalDevice device : devices) {
            VkPhysicalDeviceProperties properties;
            vkGetPhysicalDeviceProperties(device, &properties);
            std::printf("vulkan       %s, Vulkan %u.%u%s\n", properties.deviceName,
                        VK_API_VERSION_MAJOR(properties.apiVersion),
                        VK_API_VERSION_MINOR(properties.apiVersion),
                        device == gpu.physical_device() ? (", draws with " + gpu.driver_name()).c_str() : "");
        }
    } catch (const std::runtime_error& reason) {
        std::printf("vulkan       missing: %s\n", reason.what());
    }
}

}  // namespace

DevicesCommand::DevicesCommand(CLI::App& program) {
    CLI::App* command =
        program.add_subcommand("devices", "List displays, eye trackers, controllers and GPUs");
    command->footer("Example: parafovea devices");
    command->callback([] {
        print_displays();
        print_vulkan_devices();
        for (const InventoryItem& item : take_inventory()) std::printf("%s\n", inventory_line(item).c_str());
    });
}

}  // namespace parafovea
