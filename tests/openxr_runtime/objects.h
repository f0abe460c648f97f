// What stands behind the simulated headset's OpenXR handles.
#pragma once

#include <vulkan/vulkan.h>

#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tests/openxr_runtime/gaze_player.h"
#include "tests/openxr_runtime/settings.h"
#include "tests/openxr_runtime/timeline.h"

namespace parafovea::headset {

inline constexpr XrSystemId kSystem = 1;
inline constexpr std::uint32_t kViewWidth = 1280, kViewHeight = 1440;

struct Instance;
struct Session;
struct Action;

struct Space {
    Session* session = nullptr;
    XrReferenceSpaceType reference = XR_REFERENCE_SPACE_TYPE_VIEW;
    const Action* action = nullptr;  // a space of an action's pose instead
    XrPosef offset{};
};

struct Swapchain {
    Session* session = nullptr;
    XrSwapchainCreateInfo info{};
    std::vector<VkImage> images;
    std::vector<VkDeviceMemory> memory;
    std::uint32_t next = 0;              // image that is acquired next
    std::deque<std::uint32_t> acquired;  // not yet released, oldest first
    bool waited = false;                 // the oldest of them
    std::optional<std::uint32_t> released;
};

struct ActionSet;

struct Action {
    ActionSet* set = nullptr;
    std::string name;
    XrActionType type = XR_ACTION_TYPE_BOOLEAN_INPUT;
};

struct ActionSet {
    Instance* instance = nullptr;
    std::string name;
    bool attached = false;
    std::vector<std::unique_ptr<Action>> actions;
};

// The application's Vulkan device, and the functions that are called on it.
struct Graphics {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    VkQueue queue = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
    VkCommandPool pool = VK_NULL_HANDLE;
};

struct Session {
    Instance* instance = nullptr;
    Graphics graphics;
    XrSessionState state = XR_SESSION_STATE_UNKNOWN;
    bool running = false;
    bool lost = false;
    bool exit_requested = false;
    bool stop_requested = false;  // by the user, who comes back
    bool actions_attached = false;
    bool gaze_synced = false;  // the gaze action was active at the last xrSyncActions
    XrViewConfigurationType view_configuration = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    std::int64_t frames_ended = 0;  // since xrBeginSession
    bool frame_waited = false, frame_begun = false;
    std::int64_t frame = -1;  // the instance's count of the frame that was waited for
    Refresh refresh;
    std::vector<std::unique_ptr<Space>> spaces;
    std::vector<std::unique_ptr<Swapchain>> swapchains;
};

struct Instance {
    Instance(Settings chosen, std::vector<std::string> enabled)
        : settings(std::move(chosen)),
          extensions(std::move(enabled)),
          timeline(settings.simulated_pacing, settings.refresh_hz),
          gaze(settings) {}

    Settings settings;
    std::vector<std::string> extensions;
    std::mutex mutex;  // over everything below
    Timeline timeline;
    GazePlayer gaze;
    std::vector<std::string> paths;  // XrPath is the index plus one
    std::deque<XrEventDataBuffer> events;
    bool graphics_requirements_asked = false;
    PFN_vkGetInstanceProcAddr get_vulkan_function = nullptr;
    VkInstance vulkan_instance = VK_NULL_HANDLE;  // the one made last
    std::unique_ptr<Session> session;
    std::vector<std::unique_ptr<ActionSet>> action_sets;
    std::vector<std::pair<XrAction, XrPath>> gaze_bindings;
    std::int64_t frames = 0;       // waited for, over all sessions
    XrPosef stage_from_local{};    // moved by recentring
    std::size_t control_read = 0;  // bytes of the control file that have been followed
    std::ofstream log;

    bool has(std::string_view extension) const {
        return std::ranges::find(extensions, extension) != extensions.end();
    }
};

template <typename Object, typename Handle>
Object* object_of(Handle handle) {
    return reinterpret_cast<Object*>(handle);
}
template <typename Handle, typename Object>
Handle handle_of(Object* object) {
    return reinterpret_cast<Handle>(object);
}

// The two-call idiom of every enumeration.
template <typename T>
XrResult enumerate(std::span<const T> items, std::uint32_t capacity, std::uint32_t* count, T* out) {
    if (count == nullptr) return XR_ERROR_VALIDATION_FAILURE;
    *count = static_cast<std::uint32_t>(items.size());
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < items.size()) return XR_ERROR_SIZE_INSUFFICIENT;
    if (out == nullptr) return XR_ERROR_VALIDATION_FAILURE;
    std::ranges::copy(items, out);
    return XR_SUCCESS;
}

inline XrResult enumerate_text(std::string_view text, std::uint32_t capacity, std::uint32_t* count,
                               char* out) {
    const std::string terminated(text);
    return enumerate<char>(std::span(terminated.c_str(), terminated.size() + 1), capacity, count, out);
}

template <std::size_t n>
void copy_text(char (&out)[n], std::string_view text) {
    const std::size_t length = std::min(text.size(), n - 1);
    std::memcpy(out, text.data(), length);
    std::memset(out + length, 0, n - length);
}

// A structure of the given type in a chain, or nullptr.
template <typename T>
T* find_in_chain(void* next, XrStructureType type) {
    for (auto* item = static_cast<XrBaseOutStructure*>(next); item != nullptr; item = item->next)
        if (item->type == type) return reinterpret_cast<T*>(item);
    return nullptr;
}
template <typename T>
const T* find_in_chain(const void* next, XrStructureType type) {
    for (auto* item = static_cast<const XrBaseInStructure*>(next); item != nullptr; item = item->next)
        if (item->type == type) return reinterpret_cast<const T*>(item);
    return nullptr;
}

// A function of the application's Vulkan, found through the loader it gave.
template <typename Function>
Function vulkan(const Instance& instance, VkInstance vulkan_instance, const char* name) {
    return reinterpret_cast<Function>(instance.get_vulkan_function(vulkan_instance, name));
}

template <typename Event>
void queue_event(Instance& instance, const Event& event) {
    XrEventDataBuffer buffer{XR_TYPE_EVENT_DATA_BUFFER};
    static_assert(sizeof(Event) <= sizeof buffer);
    std::memcpy(&buffer, &event, sizeof event);
    instance.events.push_back(buffer);
}

// Whether an event of this kind covers the frame.
bool happens(const Instance& instance, EventKind kind, std::int64_t frame);

// Where the eye and the head are. Views are numbered as in the view configuration.
XrPosef stage_from_head(XrTime time);
XrPosef head_from_view(std::uint32_t view, std::uint32_t view_count);
XrFovf view_fov(std::uint32_t view, std::uint32_t view_count);
std::uint32_t view_count_of(XrViewConfigurationType configuration);
XrViewConfigurationType offered_view_configuration(const Instance& instance);

// Writes the images of a projection layer as PPM. Returns what the application's Vulkan said.
VkResult capture_layer(const Session& session, const XrCompositionLayerProjection& layer, std::int64_t frame);

}  // namespace parafovea::headset
