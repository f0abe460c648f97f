// Sessions and their states.
#include "tests/openxr_runtime/calls.h"

namespace parafovea::headset {

namespace {

constexpr float kRefreshRates[] = {60, 70, 90};

}  // namespace

void enter_state(Session& session, XrSessionState state) {
    session.state = state;
    XrEventDataSessionStateChanged event{XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED};
    event.session = handle_of<XrSession>(&session);
    event.state = state;
    event.time = session.instance->timeline.now();
    queue_event(*session.instance, event);
}

// One state nearer to where the user and the script want the session.
void step_state(Session& session) {
    const Instance& instance = *session.instance;
    const std::int64_t frame = session.frame;
    const bool leaving = session.exit_requested || session.stop_requested;
    XrSessionState wanted = XR_SESSION_STATE_FOCUSED;
    if (happens(instance, EventKind::unfocused, frame)) wanted = XR_SESSION_STATE_VISIBLE;
    if (leaving || happens(instance, EventKind::hidden, frame)) wanted = XR_SESSION_STATE_SYNCHRONIZED;

    // READY, SYNCHRONIZED, VISIBLE and FOCUSED are numbered in this order.
    if (session.state == XR_SESSION_STATE_STOPPING) return;
    if (leaving && session.state <= XR_SESSION_STATE_SYNCHRONIZED) {
        enter_state(session, XR_SESSION_STATE_STOPPING);
    } else if (session.state < wanted) {
        enter_state(session, static_cast<XrSessionState>(session.state + 1));
    } else if (session.state > wanted) {
        enter_state(session, static_cast<XrSessionState>(session.state - 1));
    }
}

void lose_session(Session& session) {
    if (session.lost) return;
    session.lost = true;
    session.running = false;
    enter_state(session, XR_SESSION_STATE_LOSS_PENDING);
}

XrResult create_session(XrInstance handle, const XrSessionCreateInfo* info, XrSession* out) {
    Instance& instance = *object_of<Instance>(handle);
    if (info->systemId != kSystem) return XR_ERROR_SYSTEM_INVALID;
    const std::lock_guard lock(instance.mutex);
    const auto* binding =
        find_in_chain<XrGraphicsBindingVulkanKHR>(info->next, XR_TYPE_GRAPHICS_BINDING_VULKAN_KHR);
    if (binding == nullptr) return XR_ERROR_GRAPHICS_DEVICE_INVALID;
    if (!instance.graphics_requirements_asked) return XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING;
    if (instance.get_vulkan_function == nullptr || binding->device == VK_NULL_HANDLE)
        return XR_ERROR_GRAPHICS_DEVICE_INVALID;
    if (instance.session) return XR_ERROR_LIMIT_REACHED;

    auto session = std::make_unique<Session>();
    session->instance = &instance;
    Graphics& graphics = session->graphics;
    graphics.instance = binding->instance;
    graphics.physical_device = binding->physicalDevice;
    graphics.device = binding->device;
    graphics.queue_family = binding->queueFamilyIndex;
    const auto get_queue = vulkan<PFN_vkGetDeviceQueue>(instance, graphics.instance, "vkGetDeviceQueue");
    get_queue(graphics.device, binding->queueFamilyIndex, binding->queueIndex, &graphics.queue);
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = graphics.queue_family;
    const auto create_pool =
        vulkan<PFN_vkCreateCommandPool>(instance, graphics.instance, "vkCreateCommandPool");
    if (create_pool(graphics.device, &pool, nullptr, &graphics.pool) != VK_SUCCESS)
        return XR_ERROR_RUNTIME_FAILURE;

    instance.session = std::move(session);
    instance.gaze.start(instance.timeline.now());
    enter_state(*instance.session, XR_SESSION_STATE_IDLE);
    enter_state(*instance.session, XR_SESSION_STATE_READY);
    *out = handle_of<XrSession>(instance.session.get());
    return XR_SUCCESS;
}

XrResult destroy_session(XrSession handle) {
    if (handle == XR_NULL_HANDLE) return XR_ERROR_HANDLE_INVALID;
    Session& session = *object_of<Session>(handle);
    Instance& instance = *session.instance;
    while (!session.swapchains.empty())
        destroy_swapchain(handle_of<XrSwapchain>(session.swapchains.back().get()));
    const std::lock_guard lock(instance.mutex);
    const auto destroy_pool =
        vulkan<PFN_vkDestroyCommandPool>(instance, session.graphics.instance, "vkDestroyCommandPool");
    destroy_pool(session.graphics.device, session.graphics.pool, nullptr);
    // What has not been polled of a session that is gone is never delivered.
    std::erase_if(instance.events, [handle](const XrEventDataBuffer& event) {
        XrEventDataSessionStateChanged change;
        std::memcpy(&change, &event, sizeof change);
        return event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED && change.session == handle;
    });
    for (const auto& set : instance.action_sets) set->attached = false;
    instance.session.reset();
    return XR_SUCCESS;
}

XrResult begin_session(XrSession handle, const XrSessionBeginInfo* info) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (session.running) return XR_ERROR_SESSION_RUNNING;
    if (session.state != XR_SESSION_STATE_READY) return XR_ERROR_SESSION_NOT_READY;
    if (info->primaryViewConfigurationType != offered_view_configuration(*session.instance))
        return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
    session.running = true;
    session.frame_waited = session.frame_begun = false;
    session.frames_ended = 0;
    session.view_configuration = info->primaryViewConfigurationType;
    return XR_SUCCESS;
}

XrResult end_session(XrSession handle) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (!session.running) return XR_ERROR_SESSION_NOT_RUNNING;
    if (session.state != XR_SESSION_STATE_STOPPING) return XR_ERROR_SESSION_NOT_STOPPING;
    session.running = false;
    enter_state(session, XR_SESSION_STATE_IDLE);
    enter_state(session, session.exit_requested ? XR_SESSION_STATE_EXITING : XR_SESSION_STATE_READY);
    session.stop_requested = false;
    return XR_SUCCESS;
}

XrResult request_exit_session(XrSession handle) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (!session.running) return XR_ERROR_SESSION_NOT_RUNNING;
    session.exit_requested = true;
    return XR_SUCCESS;
}

XrResult enumerate_refresh_rates(XrSession, std::uint32_t capacity, std::uint32_t* count, float* rates) {
    return enumerate<float>(kRefreshRates, capacity, count, rates);
}

XrResult get_refresh_rate(XrSession handle, float* rate) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    *rate = static_cast<float>(session.instance->timeline.refresh_hz());
    return XR_SUCCESS;
}

XrResult request_refresh_rate(XrSession handle, float rate) {
    Session& session = *object_of<Session>(handle);
    Instance& instance = *session.instance;
    const std::lock_guard lock(instance.mutex);
    if (rate == 0) return XR_SUCCESS;  // as the runtime likes
    if (std::ranges::find(kRefreshRates, rate) == std::end(kRefreshRates))
        return XR_ERROR_DISPLAY_REFRESH_RATE_UNSUPPORTED_FB;
    XrEventDataDisplayRefreshRateChangedFB event{XR_TYPE_EVENT_DATA_DISPLAY_REFRESH_RATE_CHANGED_FB};
    event.fromDisplayRefreshRate = static_cast<float>(instance.timeline.refresh_hz());
    event.toDisplayRefreshRate = rate;
    instance.timeline.set_refresh_hz(rate);
    queue_event(instance, event);
    return XR_SUCCESS;
}

}  // namespace parafovea::headset
