// Opens the OpenXR runtime.
#include "devices/openxr/openxr_instance.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

namespace parafovea {

namespace {

constexpr std::array kNeeded{XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME,
                             XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME};
constexpr std::array kWanted{XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME,
                             XR_KHR_VISIBILITY_MASK_EXTENSION_NAME, XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME,
                             XR_VARJO_QUAD_VIEWS_EXTENSION_NAME};

std::string meaning_of(XrResult result) {
    switch (result) {
        case XR_ERROR_RUNTIME_UNAVAILABLE:
            return "no OpenXR runtime is active; start the headset's (Monado, SteamVR) or name its manifest "
                   "in "
                   "XR_RUNTIME_JSON";
        case XR_ERROR_RUNTIME_FAILURE:
        case XR_ERROR_INITIALIZATION_FAILED:
            return "the runtime failed; look at its own messages, and restart it";
        case XR_ERROR_FORM_FACTOR_UNAVAILABLE:
        case XR_ERROR_FORM_FACTOR_UNSUPPORTED:
            return "no headset is connected; plug it in and switch it on";
        case XR_ERROR_INSTANCE_LOST:
            return "the runtime went away; start it again";
        case XR_ERROR_SESSION_LOST:
            return "the headset's session was lost (unplugged, or the runtime restarted)";
        case XR_ERROR_API_LAYER_NOT_PRESENT:
            return "an API layer named in XR_ENABLE_API_LAYERS is not installed";
        case XR_ERROR_GRAPHICS_DEVICE_INVALID:
            return "the headset hangs on another graphics device";
        case XR_ERROR_OUT_OF_MEMORY:
            return "memory is full";
        default:
            return "see XrResult in the OpenXR specification";
    }
}

timespec timespec_from(HostTime time) {
    return {time.ns / 1'000'000'000, time.ns % 1'000'000'000};
}

}  // namespace

void check_openxr(XrResult result, const char* doing) {
    if (XR_SUCCEEDED(result)) return;
    throw std::runtime_error(std::string("OpenXR failed while ") + doing + " (XrResult " +
                             std::to_string(static_cast<int>(result)) + "): " + meaning_of(result));
}

OpenXrInstance::OpenXrInstance() {
    try {
        create_instance();
        find_headset();
        choose_views();
    } catch (...) {
        if (instance_ != XR_NULL_HANDLE) xrDestroyInstance(instance_);
        throw;
    }
}

OpenXrInstance::~OpenXrInstance() {
    xrDestroyInstance(instance_);
}

void OpenXrInstance::create_instance() {
    // What the loader would print beside our one line; it can be asked for by hand.
    setenv("XR_LOADER_DEBUG", "none", 0);
    std::uint32_t count = 0;
    check_openxr(xrEnumerateInstanceExtensionProperties(nullptr, 0, &count, nullptr),
                 "looking for a runtime");
    std::vector<XrExtensionProperties> offered(count, XrExtensionProperties{XR_TYPE_EXTENSION_PROPERTIES});
    check_openxr(xrEnumerateInstanceExtensionProperties(nullptr, count, &count, offered.data()),
                 "looking for a runtime");
    const auto is_offered = [&offered](std::string_view name) {
        return std::ranges::any_of(offered, [name](const auto& e) { return name == e.extensionName; });
    };
    for (const char* name : kNeeded) {
        if (!is_offered(name))
            throw std::runtime_error(
                std::string("the OpenXR runtime lacks ") + name +
                ", without which pictures cannot be shown or timed; use another runtime");
        extensions_.emplace_back(name);
    }
    for (const char* name : kWanted)
        if (is_offered(name)) extensions_.emplace_back(name);

    std::vector<const char*> names;
    for (const std::string& name : extensions_) names.push_back(name.c_str());
    XrInstanceCreateInfo info{XR_TYPE_INSTANCE_CREATE_INFO};
    std::strcpy(info.applicationInfo.applicationName, "parafovea");
    std::strcpy(info.applicationInfo.engineName, "parafovea");
    info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
    info.enabledExtensionCount = static_cast<std::uint32_t>(names.size());
    info.enabledExtensionNames = names.data();
    check_openxr(xrCreateInstance(&info, &instance_), "opening the runtime");

    XrInstanceProperties properties{XR_TYPE_INSTANCE_PROPERTIES};
    check_openxr(xrGetInstanceProperties(instance_, &properties), "asking for the runtime's name");
    runtime_name_ = std::string(properties.runtimeName) + " " +
                    std::to_string(XR_VERSION_MAJOR(properties.runtimeVersion)) + "." +
                    std::to_string(XR_VERSION_MINOR(properties.runtimeVersion)) + "." +
                    std::to_string(XR_VERSION_PATCH(properties.runtimeVersion));
    device_from_timespec_ = function<PFN_xrConvertTimespecTimeToTimeKHR>("xrConvertTimespecTimeToTimeKHR");
    timespec_from_device_ = function<PFN_xrConvertTimeToTimespecTimeKHR>("xrConvertTimeToTimespecTimeKHR");
}

void OpenXrInstance::find_headset() {
    XrSystemGetInfo get{XR_TYPE_SYSTEM_GET_INFO};
    get.formFactor = XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY;
    check_openxr(xrGetSystem(instance_, &get, &system_), "looking for a headset");

    XrSystemEyeGazeInteractionPropertiesEXT gaze{XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT};
    XrSystemProperties properties{XR_TYPE_SYSTEM_PROPERTIES};
    if (offers(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME)) properties.next = &gaze;
    check_openxr(xrGetSystemProperties(instance_, system_, &properties), "asking what the headset can do");
    headset_name_ = properties.systemName;
    has_eye_tracker_ = gaze.supportsEyeGazeInteraction == XR_TRUE;

    // The runtime insists on being asked before a session.
    XrGraphicsRequirementsVulkanKHR requirements{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN_KHR};
    const auto ask = function<PFN_xrGetVulkanGraphicsRequirements2KHR>("xrGetVulkanGraphicsRequirements2KHR");
    check_openxr(ask(instance_, system_, &requirements), "asking for the needed Vulkan version");
    if (requirements.minApiVersionSupported > XR_MAKE_VERSION(1, 3, 0xffff))
        throw std::runtime_error("the OpenXR runtime " + runtime_name_ +
                                 " wants a Vulkan above 1.3; use an older version of it");
}

// The first that the runtime prefers of those that can be drawn.
void OpenXrInstance::choose_views() {
    std::uint32_t count = 0;
    check_openxr(xrEnumerateViewConfigurations(instance_, system_, 0, &count, nullptr),
                 "asking for the views");
    std::vector<XrViewConfigurationType> types(count);
    check_openxr(xrEnumerateViewConfigurations(instance_, system_, count, &count, types.data()),
                 "asking for the views");
    const auto chosen = std::ranges::find_if(types, [](XrViewConfigurationType type) {
        return type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO ||
               type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO ||
               type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO;
    });
    if (chosen == types.end())
        throw std::runtime_error("the headset " + headset_name_ + " has no view for one or two eyes");
    view_configuration_ = *chosen;
    check_openxr(
        xrEnumerateViewConfigurationViews(instance_, system_, view_configuration_, 0, &count, nullptr),
        "asking for the views' size");
    std::vector<XrViewConfigurationView> views(count,
                                               XrViewConfigurationView{XR_TYPE_VIEW_CONFIGURATION_VIEW});
    check_openxr(xrEnumerateViewConfigurationViews(instance_, system_, view_configuration_, count, &count,
                                                   views.data()),
                 "asking for the views' size");
    for (const XrViewConfigurationView& view : views)
        view_sizes_.push_back({static_cast<int>(view.recommendedImageRectWidth),
                               static_cast<int>(view.recommendedImageRectHeight)});
}

bool OpenXrInstance::offers(std::string_view extension) const {
    return std::ranges::find(extensions_, extension) != extensions_.end();
}

PFN_xrVoidFunction OpenXrInstance::find_function(const char* name) const {
    PFN_xrVoidFunction found = nullptr;
    check_openxr(xrGetInstanceProcAddr(instance_, name, &found), name);
    return found;
}

VkResult OpenXrInstance::make_vulkan_instance(const VkInstanceCreateInfo& info, VkInstance& instance) const {
    XrVulkanInstanceCreateInfoKHR create{XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR};
    create.systemId = system_;
    create.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    create.vulkanCreateInfo = &info;
    VkResult result = VK_SUCCESS;
    const auto make = function<PFN_xrCreateVulkanInstanceKHR>("xrCreateVulkanInstanceKHR");
    check_openxr(make(instance_, &create, &instance, &result), "creating the Vulkan instance");
    return result;
}

VkResult OpenXrInstance::choose_vulkan_device(VkInstance instance, VkPhysicalDevice& device) const {
    XrVulkanGraphicsDeviceGetInfoKHR get{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR};
    get.systemId = system_;
    get.vulkanInstance = instance;
    const auto ask = function<PFN_xrGetVulkanGraphicsDevice2KHR>("xrGetVulkanGraphicsDevice2KHR");
    check_openxr(ask(instance_, &get, &device), "asking for the headset's Vulkan device");
    return VK_SUCCESS;
}

VkResult OpenXrInstance::make_vulkan_device(VkPhysicalDevice physical_device, const VkDeviceCreateInfo& info,
                                            VkDevice& device) const {
    XrVulkanDeviceCreateInfoKHR create{XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR};
    create.systemId = system_;
    create.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    create.vulkanPhysicalDevice = physical_device;
    create.vulkanCreateInfo = &info;
    VkResult result = VK_SUCCESS;
    const auto make = function<PFN_xrCreateVulkanDeviceKHR>("xrCreateVulkanDeviceKHR");
    check_openxr(make(instance_, &create, &device, &result), "creating the Vulkan device");
    return result;
}

std::optional<DeviceTime> OpenXrInstance::device_from_host(HostTime time) const {
    const timespec host = timespec_from(time);
    XrTime device = 0;
    if (XR_FAILED(device_from_timespec_(instance_, &host, &device))) return std::nullopt;
    return DeviceTime{device};
}

std::optional<HostTime> OpenXrInstance::host_from_device(DeviceTime time) const {
    timespec host{};
    if (time.ns <= 0 || XR_FAILED(timespec_from_device_(instance_, time.ns, &host))) return std::nullopt;
    return HostTime{host.tv_sec * std::int64_t{1'000'000'000} + host.tv_nsec};
}

Duration OpenXrInstance::conversion_error(HostTime at) const {
    constexpr std::int64_t kAtLeast_ns = 1000;
    const std::optional<DeviceTime> there = device_from_host(at);
    const std::optional<HostTime> back = there ? host_from_device(*there) : std::nullopt;
    return {back ? std::max(kAtLeast_ns, std::abs((*back - at).ns)) : kAtLeast_ns};
}

std::optional<XrEventDataBuffer> OpenXrInstance::next_event() const {
    XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
    const XrResult result = xrPollEvent(instance_, &event);
    check_openxr(result, "asking for events");
    if (result == XR_EVENT_UNAVAILABLE) return std::nullopt;
    return event;
}

}  // namespace parafovea
