// Instance, system, paths and events.
#include <openxr/openxr_reflection.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tests/openxr_runtime/calls.h"

namespace parafovea::headset {

namespace {

struct Extension {
    const char* name;
    std::uint32_t version;
};

constexpr Extension kExtensions[] = {
    {XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME, XR_KHR_vulkan_enable2_SPEC_VERSION},
    {XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME, XR_KHR_convert_timespec_time_SPEC_VERSION},
    {XR_KHR_VISIBILITY_MASK_EXTENSION_NAME, XR_KHR_visibility_mask_SPEC_VERSION},
    {XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME, XR_EXT_eye_gaze_interaction_SPEC_VERSION},
    {XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME, XR_FB_display_refresh_rate_SPEC_VERSION},
    {XR_VARJO_QUAD_VIEWS_EXTENSION_NAME, XR_VARJO_quad_views_SPEC_VERSION},
};

Settings settings_from_environment() {
    const char* text = std::getenv("PARAFOVEA_HEADSET");
    return parse_settings(text == nullptr ? "" : text);
}

std::vector<Extension> offered_extensions(const Settings& settings) {
    std::vector<Extension> offered;
    for (const Extension& extension : kExtensions) {
        if (std::ranges::find(settings.without, extension.name) != settings.without.end()) continue;
        if (extension.name == std::string_view(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME) && settings.views != 4)
            continue;
        offered.push_back(extension);
    }
    return offered;
}

XrResult create_instance_or_throw(const XrInstanceCreateInfo* info, XrInstance* instance) {
    Settings settings = settings_from_environment();
    const std::vector<Extension> offered = offered_extensions(settings);
    std::vector<std::string> enabled;
    for (std::uint32_t i = 0; i < info->enabledExtensionCount; ++i) {
        const std::string_view wanted = info->enabledExtensionNames[i];
        if (std::ranges::none_of(offered, [wanted](const Extension& e) { return wanted == e.name; }))
            return XR_ERROR_EXTENSION_NOT_PRESENT;
        enabled.emplace_back(wanted);
    }
    auto made = std::make_unique<Instance>(std::move(settings), std::move(enabled));
    made->stage_from_local = kIdentityPose;
    if (!made->settings.log.empty()) {
        made->log.open(made->settings.log);
        if (!made->log) throw std::runtime_error("cannot write " + made->settings.log.string());
        made->log << "frame,state,started_ns,displayed_ns,predicted_ns,submitted_ns,views\n";
    }
    *instance = handle_of<XrInstance>(made.release());
    return XR_SUCCESS;
}

}  // namespace

XrResult enumerate_extensions(const char* layer, std::uint32_t capacity, std::uint32_t* count,
                              XrExtensionProperties* out) {
    if (layer != nullptr) return XR_ERROR_API_LAYER_NOT_PRESENT;
    std::vector<XrExtensionProperties> properties;
    try {
        for (const Extension& extension : offered_extensions(settings_from_environment())) {
            XrExtensionProperties item{XR_TYPE_EXTENSION_PROPERTIES};
            copy_text(item.extensionName, extension.name);
            item.extensionVersion = extension.version;
            properties.push_back(item);
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "simulated headset: %s\n", error.what());
        return XR_ERROR_RUNTIME_FAILURE;
    }
    return enumerate<XrExtensionProperties>(properties, capacity, count, out);
}

XrResult enumerate_layers(std::uint32_t capacity, std::uint32_t* count, XrApiLayerProperties* out) {
    return enumerate<XrApiLayerProperties>({}, capacity, count, out);
}

XrResult create_instance(const XrInstanceCreateInfo* info, XrInstance* instance) {
    if (info == nullptr || instance == nullptr || info->type != XR_TYPE_INSTANCE_CREATE_INFO)
        return XR_ERROR_VALIDATION_FAILURE;
    if (XR_VERSION_MAJOR(info->applicationInfo.apiVersion) != 1) return XR_ERROR_API_VERSION_UNSUPPORTED;
    try {
        return create_instance_or_throw(info, instance);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "simulated headset: %s\n", error.what());
        return XR_ERROR_INITIALIZATION_FAILED;
    }
}

XrResult destroy_instance(XrInstance handle) {
    if (handle == XR_NULL_HANDLE) return XR_ERROR_HANDLE_INVALID;
    Instance* instance = object_of<Instance>(handle);
    if (instance->session) destroy_session(handle_of<XrSession>(instance->session.get()));
    delete instance;
    return XR_SUCCESS;
}

XrResult get_instance_properties(XrInstance, XrInstanceProperties* properties) {
    properties->runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
    copy_text(properties->runtimeName, "Parafovea simulated headset");
    return XR_SUCCESS;
}

XrResult poll_event(XrInstance handle, XrEventDataBuffer* event) {
    Instance& instance = *object_of<Instance>(handle);
    const std::lock_guard lock(instance.mutex);
    if (instance.events.empty()) return XR_EVENT_UNAVAILABLE;
    *event = instance.events.front();
    instance.events.pop_front();
    return XR_SUCCESS;
}

XrResult result_to_string(XrInstance, XrResult value, char buffer[XR_MAX_RESULT_STRING_SIZE]) {
    switch (value) {
#define NAME_CASE(name, number)                                        \
    case name:                                                         \
        std::snprintf(buffer, XR_MAX_RESULT_STRING_SIZE, "%s", #name); \
        return XR_SUCCESS;
        XR_LIST_ENUM_XrResult(NAME_CASE)
#undef NAME_CASE
    }
    std::snprintf(buffer, XR_MAX_RESULT_STRING_SIZE, "XR_UNKNOWN_%s_%d", value < 0 ? "FAILURE" : "SUCCESS",
                  static_cast<int>(value));
    return XR_SUCCESS;
}

XrResult structure_type_to_string(XrInstance, XrStructureType value,
                                  char buffer[XR_MAX_STRUCTURE_NAME_SIZE]) {
    switch (value) {
#define NAME_CASE(name, number)                                         \
    case name:                                                          \
        std::snprintf(buffer, XR_MAX_STRUCTURE_NAME_SIZE, "%s", #name); \
        return XR_SUCCESS;
        XR_LIST_ENUM_XrStructureType(NAME_CASE)
#undef NAME_CASE
    }
    std::snprintf(buffer, XR_MAX_STRUCTURE_NAME_SIZE, "XR_UNKNOWN_STRUCTURE_TYPE_%d",
                  static_cast<int>(value));
    return XR_SUCCESS;
}

XrResult get_system(XrInstance handle, const XrSystemGetInfo* info, XrSystemId* system) {
    const Instance& instance = *object_of<Instance>(handle);
    if (info->formFactor != XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY) return XR_ERROR_FORM_FACTOR_UNSUPPORTED;
    if (!instance.settings.plugged_in) return XR_ERROR_FORM_FACTOR_UNAVAILABLE;
    *system = kSystem;
    return XR_SUCCESS;
}

XrResult get_system_properties(XrInstance handle, XrSystemId system, XrSystemProperties* properties) {
    const Instance& instance = *object_of<Instance>(handle);
    if (system != kSystem) return XR_ERROR_SYSTEM_INVALID;
    properties->systemId = kSystem;
    properties->vendorId = 0x5046;
    copy_text(properties->systemName, "Simulated FOVE-like headset");
    properties->graphicsProperties = {4096, 4096, 16};
    properties->trackingProperties = {XR_TRUE, XR_TRUE};
    auto* gaze = find_in_chain<XrSystemEyeGazeInteractionPropertiesEXT>(
        properties->next, XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT);
    if (gaze != nullptr) gaze->supportsEyeGazeInteraction = instance.gaze.present() ? XR_TRUE : XR_FALSE;
    return XR_SUCCESS;
}

XrResult enumerate_blend_modes(XrInstance handle, XrSystemId system, XrViewConfigurationType configuration,
                               std::uint32_t capacity, std::uint32_t* count, XrEnvironmentBlendMode* modes) {
    if (system != kSystem) return XR_ERROR_SYSTEM_INVALID;
    if (configuration != offered_view_configuration(*object_of<Instance>(handle)))
        return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
    const XrEnvironmentBlendMode opaque[] = {XR_ENVIRONMENT_BLEND_MODE_OPAQUE};
    return enumerate<XrEnvironmentBlendMode>(opaque, capacity, count, modes);
}

XrResult string_to_path(XrInstance handle, const char* text, XrPath* path) {
    Instance& instance = *object_of<Instance>(handle);
    const std::string_view name = text;
    const bool clean = name.size() > 1 && name.size() < XR_MAX_PATH_LENGTH && name.front() == '/' &&
                       name.back() != '/' &&
                       name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-_./") == name.npos;
    if (!clean) return XR_ERROR_PATH_FORMAT_INVALID;
    const std::lock_guard lock(instance.mutex);
    const auto known = std::ranges::find(instance.paths, name);
    *path = static_cast<XrPath>(known - instance.paths.begin()) + 1;
    if (known == instance.paths.end()) instance.paths.emplace_back(name);
    return XR_SUCCESS;
}

XrResult path_to_string(XrInstance handle, XrPath path, std::uint32_t capacity, std::uint32_t* count,
                        char* text) {
    Instance& instance = *object_of<Instance>(handle);
    const std::lock_guard lock(instance.mutex);
    if (path == XR_NULL_PATH || path > instance.paths.size()) return XR_ERROR_PATH_INVALID;
    return enumerate_text(instance.paths[path - 1], capacity, count, text);
}

XrResult time_from_timespec(XrInstance, const timespec* host, XrTime* time) {
    const std::int64_t ns = host->tv_sec * 1'000'000'000LL + host->tv_nsec;
    if (ns < 0) return XR_ERROR_TIME_INVALID;
    *time = time_from_host(ns);
    return XR_SUCCESS;
}

XrResult timespec_from_time(XrInstance, XrTime time, timespec* host) {
    const std::int64_t ns = host_from_time(time);
    if (time <= 0 || ns < 0) return XR_ERROR_TIME_INVALID;
    host->tv_sec = ns / 1'000'000'000;
    host->tv_nsec = ns % 1'000'000'000;
    return XR_SUCCESS;
}

bool happens(const Instance& instance, EventKind kind, std::int64_t frame) {
    return std::ranges::any_of(instance.settings.events, [kind, frame](const ScriptedEvent& event) {
        return event.kind == kind && frame >= event.frame && frame < event.frame + event.count;
    });
}

}  // namespace parafovea::headset
