// How the OpenXR loader finds the simulated headset's functions.
#include "tests/openxr_runtime/calls.h"
#include "tests/openxr_runtime/loader_negotiation.h"

namespace parafovea::headset {

namespace {

struct Procedure {
    std::string_view name;
    PFN_xrVoidFunction function = nullptr;
    const char* extension = nullptr;  // that must be enabled; none for a core function
};

// Type says what the caller will take the function for, so the compiler holds them together.
template <typename Type>
Procedure procedure(const char* name, Type function, const char* extension = nullptr) {
    return {name, reinterpret_cast<PFN_xrVoidFunction>(function), extension};
}

constexpr const char* kVulkan = XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME;
constexpr const char* kTimespec = XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME;
constexpr const char* kMask = XR_KHR_VISIBILITY_MASK_EXTENSION_NAME;
constexpr const char* kRefreshRate = XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME;

// Every function of OpenXR 1.0: the loader calls what it finds in its table without looking for null.
const std::vector<Procedure>& procedures() {
#define CORE(name, function) procedure<PFN_##name>(#name, function)
#define EXTENSION(name, function, extension) procedure<PFN_##name>(#name, function, extension)
    static const std::vector<Procedure> table{
        CORE(xrGetInstanceProcAddr, get_procedure),
        CORE(xrEnumerateApiLayerProperties, enumerate_layers),
        CORE(xrEnumerateInstanceExtensionProperties, enumerate_extensions),
        CORE(xrCreateInstance, create_instance),
        CORE(xrDestroyInstance, destroy_instance),
        CORE(xrGetInstanceProperties, get_instance_properties),
        CORE(xrPollEvent, poll_event),
        CORE(xrResultToString, result_to_string),
        CORE(xrStructureTypeToString, structure_type_to_string),
        CORE(xrGetSystem, get_system),
        CORE(xrGetSystemProperties, get_system_properties),
        CORE(xrEnumerateEnvironmentBlendModes, enumerate_blend_modes),
        CORE(xrCreateSession, create_session),
        CORE(xrDestroySession, destroy_session),
        CORE(xrEnumerateReferenceSpaces, enumerate_reference_spaces),
        CORE(xrCreateReferenceSpace, create_reference_space),
        CORE(xrGetReferenceSpaceBoundsRect, get_bounds),
        CORE(xrCreateActionSpace, create_action_space),
        CORE(xrLocateSpace, locate_space),
        CORE(xrDestroySpace, destroy_space),
        CORE(xrEnumerateViewConfigurations, enumerate_view_configurations),
        CORE(xrGetViewConfigurationProperties, get_view_configuration_properties),
        CORE(xrEnumerateViewConfigurationViews, enumerate_views),
        CORE(xrEnumerateSwapchainFormats, enumerate_swapchain_formats),
        CORE(xrCreateSwapchain, create_swapchain),
        CORE(xrDestroySwapchain, destroy_swapchain),
        CORE(xrEnumerateSwapchainImages, enumerate_swapchain_images),
        CORE(xrAcquireSwapchainImage, acquire_swapchain_image),
        CORE(xrWaitSwapchainImage, wait_swapchain_image),
        CORE(xrReleaseSwapchainImage, release_swapchain_image),
        CORE(xrBeginSession, begin_session),
        CORE(xrEndSession, end_session),
        CORE(xrRequestExitSession, request_exit_session),
        CORE(xrWaitFrame, wait_frame),
        CORE(xrBeginFrame, begin_frame),
        CORE(xrEndFrame, end_frame),
        CORE(xrLocateViews, locate_views),
        CORE(xrStringToPath, string_to_path),
        CORE(xrPathToString, path_to_string),
        CORE(xrCreateActionSet, create_action_set),
        CORE(xrDestroyActionSet, destroy_action_set),
        CORE(xrCreateAction, create_action),
        CORE(xrDestroyAction, destroy_action),
        CORE(xrSuggestInteractionProfileBindings, suggest_bindings),
        CORE(xrAttachSessionActionSets, attach_action_sets),
        CORE(xrGetCurrentInteractionProfile, get_interaction_profile),
        CORE(xrGetActionStateBoolean, get_boolean_state),
        CORE(xrGetActionStateFloat, get_float_state),
        CORE(xrGetActionStateVector2f, get_vector_state),
        CORE(xrGetActionStatePose, get_pose_state),
        CORE(xrSyncActions, sync_actions),
        CORE(xrEnumerateBoundSourcesForAction, enumerate_bound_sources),
        CORE(xrGetInputSourceLocalizedName, get_source_name),
        CORE(xrApplyHapticFeedback, apply_haptics),
        CORE(xrStopHapticFeedback, stop_haptics),
        EXTENSION(xrCreateVulkanInstanceKHR, create_vulkan_instance, kVulkan),
        EXTENSION(xrCreateVulkanDeviceKHR, create_vulkan_device, kVulkan),
        EXTENSION(xrGetVulkanGraphicsDevice2KHR, get_vulkan_graphics_device, kVulkan),
        EXTENSION(xrGetVulkanGraphicsRequirements2KHR, get_vulkan_graphics_requirements, kVulkan),
        EXTENSION(xrConvertTimespecTimeToTimeKHR, time_from_timespec, kTimespec),
        EXTENSION(xrConvertTimeToTimespecTimeKHR, timespec_from_time, kTimespec),
        EXTENSION(xrGetVisibilityMaskKHR, get_visibility_mask, kMask),
        EXTENSION(xrEnumerateDisplayRefreshRatesFB, enumerate_refresh_rates, kRefreshRate),
        EXTENSION(xrGetDisplayRefreshRateFB, get_refresh_rate, kRefreshRate),
        EXTENSION(xrRequestDisplayRefreshRateFB, request_refresh_rate, kRefreshRate),
    };
#undef CORE
#undef EXTENSION
    return table;
}

}  // namespace

XrResult get_procedure(XrInstance handle, const char* name, PFN_xrVoidFunction* function) {
    *function = nullptr;
    const auto found = std::ranges::find(procedures(), std::string_view(name), &Procedure::name);
    if (found == procedures().end()) return XR_ERROR_FUNCTION_UNSUPPORTED;
    if (handle == XR_NULL_HANDLE) {
        const bool global = found->name == "xrCreateInstance" ||
                            found->name == "xrEnumerateInstanceExtensionProperties" ||
                            found->name == "xrEnumerateApiLayerProperties";
        if (!global) return XR_ERROR_HANDLE_INVALID;
    } else if (found->extension != nullptr && !object_of<Instance>(handle)->has(found->extension)) {
        return XR_ERROR_FUNCTION_UNSUPPORTED;
    }
    *function = found->function;
    return XR_SUCCESS;
}

}  // namespace parafovea::headset

// The one symbol that the library exports.
extern "C" __attribute__((visibility("default"))) XrResult xrNegotiateLoaderRuntimeInterface(
    const parafovea::headset::LoaderInfo* loader, parafovea::headset::RuntimeRequest* request) {
    using namespace parafovea::headset;
    if (loader == nullptr || request == nullptr || loader->kind != kLoaderInfo ||
        loader->size != sizeof(LoaderInfo) || request->kind != kRuntimeRequest ||
        request->size != sizeof(RuntimeRequest) || loader->min_interface_version > kInterfaceVersion ||
        loader->max_interface_version < kInterfaceVersion)
        return XR_ERROR_INITIALIZATION_FAILED;
    request->interface_version = kInterfaceVersion;
    request->api_version = XR_MAKE_VERSION(1, 0, 0);
    request->get_procedure = get_procedure;
    return XR_SUCCESS;
}
