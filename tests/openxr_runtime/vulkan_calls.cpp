// XR_KHR_vulkan_enable2: the runtime makes the application's Vulkan instance and device.
#include "tests/openxr_runtime/calls.h"

namespace parafovea::headset {

XrResult create_vulkan_instance(XrInstance handle, const XrVulkanInstanceCreateInfoKHR* info,
                                VkInstance* vulkan_instance, VkResult* result) {
    Instance& instance = *object_of<Instance>(handle);
    if (info->systemId != kSystem) return XR_ERROR_SYSTEM_INVALID;
    const std::lock_guard lock(instance.mutex);
    if (!instance.graphics_requirements_asked) return XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING;
    instance.get_vulkan_function = info->pfnGetInstanceProcAddr;
    const auto create = vulkan<PFN_vkCreateInstance>(instance, VK_NULL_HANDLE, "vkCreateInstance");
    *result = create(info->vulkanCreateInfo, info->vulkanAllocator, vulkan_instance);
    if (*result == VK_SUCCESS) instance.vulkan_instance = *vulkan_instance;
    return XR_SUCCESS;
}

XrResult get_vulkan_graphics_device(XrInstance handle, const XrVulkanGraphicsDeviceGetInfoKHR* info,
                                    VkPhysicalDevice* device) {
    Instance& instance = *object_of<Instance>(handle);
    if (info->systemId != kSystem) return XR_ERROR_SYSTEM_INVALID;
    if (instance.get_vulkan_function == nullptr) return XR_ERROR_VALIDATION_FAILURE;
    const auto list =
        vulkan<PFN_vkEnumeratePhysicalDevices>(instance, info->vulkanInstance, "vkEnumeratePhysicalDevices");
    const auto describe = vulkan<PFN_vkGetPhysicalDeviceProperties>(instance, info->vulkanInstance,
                                                                    "vkGetPhysicalDeviceProperties");
    std::uint32_t count = 0;
    if (list(info->vulkanInstance, &count, nullptr) != VK_SUCCESS || count == 0)
        return XR_ERROR_RUNTIME_FAILURE;
    std::vector<VkPhysicalDevice> devices(count);
    if (list(info->vulkanInstance, &count, devices.data()) < 0) return XR_ERROR_RUNTIME_FAILURE;

    // The headset hangs on the first real GPU; without one the CPU draws.
    *device = devices.front();
    for (const VkPhysicalDevice candidate : devices) {
        VkPhysicalDeviceProperties properties;
        describe(candidate, &properties);
        if (properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU) continue;
        *device = candidate;
        break;
    }
    return XR_SUCCESS;
}

XrResult create_vulkan_device(XrInstance handle, const XrVulkanDeviceCreateInfoKHR* info, VkDevice* device,
                              VkResult* result) {
    Instance& instance = *object_of<Instance>(handle);
    if (info->systemId != kSystem) return XR_ERROR_SYSTEM_INVALID;
    if (instance.get_vulkan_function == nullptr) return XR_ERROR_VALIDATION_FAILURE;
    const auto create = vulkan<PFN_vkCreateDevice>(instance, instance.vulkan_instance, "vkCreateDevice");
    *result = create(info->vulkanPhysicalDevice, info->vulkanCreateInfo, info->vulkanAllocator, device);
    return XR_SUCCESS;
}

XrResult get_vulkan_graphics_requirements(XrInstance handle, XrSystemId system,
                                          XrGraphicsRequirementsVulkanKHR* requirements) {
    Instance& instance = *object_of<Instance>(handle);
    if (system != kSystem) return XR_ERROR_SYSTEM_INVALID;
    const std::lock_guard lock(instance.mutex);
    instance.graphics_requirements_asked = true;
    requirements->minApiVersionSupported = XR_MAKE_VERSION(1, 1, 0);
    requirements->maxApiVersionSupported = XR_MAKE_VERSION(1, 3, 0);
    return XR_SUCCESS;
}

}  // namespace parafovea::headset
