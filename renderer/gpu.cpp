// Chooses and opens the Vulkan device.
#include "renderer/gpu.h"

#include <malloc.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace parafovea {
namespace {

const char* const kValidationLayer = "VK_LAYER_KHRONOS_validation";

const char* meaning_of(VkResult result) {
    switch (result) {
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "the computer's memory is full; use a smaller picture or scene";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return "the device's memory is full; use a smaller picture or scene";
        case VK_ERROR_DEVICE_LOST:
            return "the device was lost (a crash or time-out in its driver); start again";
        case VK_ERROR_INITIALIZATION_FAILED:
            return "the driver could not start; check its installation with vulkaninfo";
        case VK_ERROR_LAYER_NOT_PRESENT:
            return "a Vulkan layer is missing; install vulkan-validationlayers";
        case VK_ERROR_EXTENSION_NOT_PRESENT:
        case VK_ERROR_FEATURE_NOT_PRESENT:
            return "the driver lacks a feature; use a driver with Vulkan 1.3, such as mesa-vulkan-drivers";
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "no usable Vulkan driver; install mesa-vulkan-drivers";
        case VK_ERROR_FORMAT_NOT_SUPPORTED:
            return "the device does not support the image format";
        case VK_ERROR_TOO_MANY_OBJECTS:
            return "the driver allows no more allocations; use a smaller scene";
        default:
            return "see VkResult in the Vulkan specification";
    }
}

VKAPI_ATTR VkBool32 VKAPI_CALL record_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                              VkDebugUtilsMessageTypeFlagsEXT,
                                              const VkDebugUtilsMessengerCallbackDataEXT* data,
                                              void* messages) {
    static_cast<std::vector<std::string>*>(messages)->push_back(data->pMessage);
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messenger_info(std::vector<std::string>& messages) {
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                       VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = record_message;
    info.pUserData = &messages;
    return info;
}

bool has_validation_layer() {
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::ranges::any_of(layers, [](const VkLayerProperties& layer) {
        return std::strcmp(layer.layerName, kValidationLayer) == 0;
    });
}

int rank_of(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 0;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 1;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return 3;
        default:
            return 4;
    }
}

VkPhysicalDeviceProperties properties_of(VkPhysicalDevice device) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device, &properties);
    return properties;
}

// Software devices take working memory for each frame and free it at its end: a heap that gave it back to the
// system would be filled with fresh pages every time (6000 of them, 15 ms, for a million triangles). The
// second line keeps the heaps of threads, 64 MiB each.
void keep_freed_memory() {
#ifdef __GLIBC__
    mallopt(M_TRIM_THRESHOLD, 256 << 20);
    mallopt(M_TOP_PAD, 64 << 20);
#endif
}

}  // namespace

void check_vulkan(VkResult result, const char* doing) {
    if (result == VK_SUCCESS) return;
    throw std::runtime_error(std::string("Vulkan failed while ") + doing + " (VkResult " +
                             std::to_string(static_cast<int>(result)) + "): " + meaning_of(result));
}

Gpu::Gpu(const GpuOptions& options) {
    try {
        create_instance(options);
        choose_physical_device(options);
        create_device(options.maker);
        if (runs_on_the_cpu()) keep_freed_memory();
    } catch (...) {
        destroy();
        throw;
    }
}

Gpu::~Gpu() {
    destroy();
}

void Gpu::destroy() {
    if (device_ != VK_NULL_HANDLE) {
        vkDeviceWaitIdle(device_);
        vkDestroyFence(device_, fence_, nullptr);
        vkDestroyCommandPool(device_, command_pool_, nullptr);
        vkDestroyDevice(device_, nullptr);
    }
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy_messenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy_messenger(instance_, messenger_, nullptr);
    }
    if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

void Gpu::create_instance(const GpuOptions& options) {
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.pApplicationName = "parafovea";
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;

    const std::array extensions{VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
    const std::array enabled{VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = enabled.size();
    features.pEnabledValidationFeatures = enabled.data();
    VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(validation_messages_);
    if (options.validation) {
        if (!has_validation_layer()) {
            throw std::runtime_error(
                "Vulkan validation was asked for but its layer is not installed; install "
                "vulkan-validationlayers");
        }
        features.pNext = &messenger;
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
        info.enabledExtensionCount = extensions.size();
        info.ppEnabledExtensionNames = extensions.data();
    }
    const VkResult result = options.maker.instance ? options.maker.instance(info, instance_)
                                                   : vkCreateInstance(&info, nullptr, &instance_);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER) {
        throw std::runtime_error(
            "no Vulkan device found: no driver is installed; install mesa-vulkan-drivers (it needs no GPU) "
            "or your "
            "GPU's driver");
    }
    check_vulkan(result, "creating the instance");
    if (options.validation) {
        const auto create_messenger = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
        check_vulkan(create_messenger(instance_, &messenger, nullptr, &messenger_),
                     "listening to validation");
    }
}

void Gpu::choose_physical_device(const GpuOptions& options) {
    std::uint32_t count = 0;
    const VkResult counted = vkEnumeratePhysicalDevices(instance_, &count, nullptr);
    if (counted == VK_ERROR_INITIALIZATION_FAILED || count == 0) {
        throw std::runtime_error(
            "no Vulkan device found: install mesa-vulkan-drivers (it needs no GPU) or your GPU's driver");
    }
    check_vulkan(counted, "looking for devices");
    std::vector<VkPhysicalDevice> devices(count);
    check_vulkan(vkEnumeratePhysicalDevices(instance_, &count, devices.data()), "looking for devices");
    if (options.maker.physical_device) {
        devices.resize(1);
        check_vulkan(options.maker.physical_device(instance_, devices.front()),
                     "asking for the headset's device");
    }
    std::ranges::stable_sort(
        devices, {}, [](VkPhysicalDevice device) { return rank_of(properties_of(device).deviceType); });

    std::string refused;
    for (const VkPhysicalDevice device : devices) {
        const VkPhysicalDeviceProperties properties = properties_of(device);
        const std::string name = properties.deviceName;
        if (name.find(options.device_name) == std::string::npos) {
            refused += "; " + name + " has another name";
            continue;
        }
        if (properties.apiVersion < VK_API_VERSION_1_3) {
            refused += "; " + name + " has only Vulkan " +
                       std::to_string(VK_API_VERSION_MAJOR(properties.apiVersion)) + "." +
                       std::to_string(VK_API_VERSION_MINOR(properties.apiVersion)) + ", 1.3 is needed";
            continue;
        }
        std::uint32_t family_count = 0;
        vkGetPhysicalDeviceQueueFamilyProperties(device, &family_count, nullptr);
        std::vector<VkQueueFamilyProperties> families(family_count);
        vkGetPhysicalDeviceQueueFamilyProperties(device, &family_count, families.data());
        const auto family = std::ranges::find_if(families, [](const VkQueueFamilyProperties& f) {
            const VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
            return (f.queueFlags & needed) == needed;
        });
        if (family == families.end()) {
            refused += "; " + name + " cannot draw";
            continue;
        }
        physical_device_ = device;
        properties_ = properties;
        device_name_ = name;
        queue_family_ = static_cast<std::uint32_t>(family - families.begin());
        VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
        VkPhysicalDeviceProperties2 properties2{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
        properties2.pNext = &driver;
        vkGetPhysicalDeviceProperties2(device, &properties2);
        driver_name_ = std::string(driver.driverName) + " " + driver.driverInfo;
        vkGetPhysicalDeviceMemoryProperties(device, &memory_);
        return;
    }
    throw std::runtime_error("no usable Vulkan device found" + refused);
}

void Gpu::create_device(const GpuMaker& maker) {
    // Ask what there is.
    VkPhysicalDeviceVulkan13Features has13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features has12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan11Features has11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    VkPhysicalDeviceFeatures2 has{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    has.pNext = &has11;
    has11.pNext = &has12;
    has12.pNext = &has13;
    vkGetPhysicalDeviceFeatures2(physical_device_, &has);
    const auto require = [this](VkBool32 present, const char* name) {
        if (!present) {
            throw std::runtime_error("the Vulkan device " + device_name_ + " lacks the feature " + name +
                                     "; use another device or driver, such as mesa-vulkan-drivers");
        }
    };
    require(has13.dynamicRendering, "dynamicRendering");
    require(has13.synchronization2, "synchronization2");
    require(has.features.fragmentStoresAndAtomics, "fragmentStoresAndAtomics");
    require(has.features.independentBlend, "independentBlend");
    require(has.features.occlusionQueryPrecise, "occlusionQueryPrecise");

    // Switch on what is used: the required features, and what makes pictures better where present.
    features_ = {};
    features_.fragmentStoresAndAtomics = VK_TRUE;
    features_.independentBlend = VK_TRUE;
    features_.occlusionQueryPrecise = VK_TRUE;
    features_.shaderStorageImageWriteWithoutFormat = has.features.shaderStorageImageWriteWithoutFormat;
    features_.samplerAnisotropy = has.features.samplerAnisotropy;
    features_.multiDrawIndirect = has.features.multiDrawIndirect;
    features_.drawIndirectFirstInstance = has.features.drawIndirectFirstInstance;
    features_.imageCubeArray = has.features.imageCubeArray;
    features_.depthClamp = has.features.depthClamp;
    VkPhysicalDeviceVulkan13Features use13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    use13.dynamicRendering = VK_TRUE;
    use13.synchronization2 = VK_TRUE;
    use13.maintenance4 = has13.maintenance4;
    use13.shaderDemoteToHelperInvocation = has13.shaderDemoteToHelperInvocation;
    VkPhysicalDeviceVulkan12Features use12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    use12.pNext = &use13;
    use12.drawIndirectCount = has12.drawIndirectCount;
    use12.hostQueryReset = has12.hostQueryReset;
    VkPhysicalDeviceVulkan11Features use11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES};
    use11.pNext = &use12;
    use11.shaderDrawParameters = has11.shaderDrawParameters;
    VkPhysicalDeviceFeatures2 use{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    use.pNext = &use11;
    use.features = features_;

    const float priority = 1;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = &use;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    check_vulkan(maker.device ? maker.device(physical_device_, info, device_)
                              : vkCreateDevice(physical_device_, &info, nullptr, &device_),
                 "opening the device");
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);

    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
    pool.queueFamilyIndex = queue_family_;
    check_vulkan(vkCreateCommandPool(device_, &pool, nullptr, &command_pool_), "creating a command pool");
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = command_pool_;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    check_vulkan(vkAllocateCommandBuffers(device_, &allocate, &command_buffer_), "allocating commands");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
    check_vulkan(vkCreateFence(device_, &fence, nullptr, &fence_), "creating a fence");
}

void Gpu::submit_and_wait(const std::function<void(VkCommandBuffer)>& record) {
    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check_vulkan(vkResetCommandBuffer(command_buffer_, 0), "resetting commands");
    check_vulkan(vkBeginCommandBuffer(command_buffer_, &begin), "recording commands");
    record(command_buffer_);
    check_vulkan(vkEndCommandBuffer(command_buffer_), "recording commands");

    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = command_buffer_;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    check_vulkan(vkResetFences(device_, 1, &fence_), "resetting a fence");
    check_vulkan(vkQueueSubmit2(queue_, 1, &submit, fence_), "submitting commands");
    check_vulkan(vkWaitForFences(device_, 1, &fence_, VK_TRUE, UINT64_MAX), "waiting for the device");
}

std::uint32_t Gpu::memory_type(std::uint32_t allowed_types, VkMemoryPropertyFlags required,
                               VkMemoryPropertyFlags wanted) const {
    for (const VkMemoryPropertyFlags flags : {required | wanted, required}) {
        for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
            if ((allowed_types >> i & 1) != 0 && (memory_.memoryTypes[i].propertyFlags & flags) == flags)
                return i;
        }
    }
    throw std::runtime_error("the Vulkan device " + device_name_ +
                             " has no memory of the kind that is needed");
}

void Gpu::count_allocation(VkDeviceSize bytes) {
    allocated_bytes_ += bytes;
    peak_allocated_bytes_ = std::max(peak_allocated_bytes_, allocated_bytes_);
}

}  // namespace parafovea
