// The frame loop, and what the script makes happen in it.
#include <filesystem>
#include <string>

#include "tests/openxr_runtime/calls.h"

namespace parafovea::headset {

namespace {

// Takes up the lines that were written to the control file since the last look.
void follow_control_file(Instance& instance, std::int64_t frame) {
    if (instance.settings.control.empty()) return;
    std::ifstream file(instance.settings.control, std::ios::binary);
    if (!file) return;
    file.seekg(static_cast<std::streamoff>(instance.control_read));
    std::string line;
    while (std::getline(file, line) && !file.eof()) {
        instance.control_read += line.size() + 1;
        if (line.empty()) continue;
        try {
            instance.settings.events.push_back(parse_event(line, frame));
        } catch (const std::exception& error) {
            std::fprintf(stderr, "simulated headset: %s\n", error.what());
        }
    }
}

std::int64_t lateness_at(const Instance& instance, std::int64_t frame) {
    std::int64_t late = 0;
    for (const ScriptedEvent& event : instance.settings.events)
        if (event.kind == EventKind::late && event.frame == frame) late += event.count;
    return late;
}

bool begins(const Instance& instance, EventKind kind, std::int64_t frame) {
    return std::ranges::any_of(instance.settings.events, [kind, frame](const ScriptedEvent& event) {
        return event.kind == kind && event.frame == frame;
    });
}

// LOCAL's new origin: the head's place, turned about the vertical only.
void recentre(Session& session) {
    Instance& instance = *session.instance;
    const XrPosef head = stage_from_head(instance.timeline.now());
    const XrVector3f ahead = rotate(head.orientation, {0, 0, -1});
    const double yaw_deg = deg_from_rad(std::atan2(ahead.x, -ahead.z));
    instance.stage_from_local = {orientation_towards({yaw_deg, 0}), head.position};
    XrEventDataReferenceSpaceChangePending event{XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING};
    event.session = handle_of<XrSession>(&session);
    event.referenceSpaceType = XR_REFERENCE_SPACE_TYPE_LOCAL;
    event.changeTime = instance.timeline.now();
    event.poseValid = XR_FALSE;
    event.poseInPreviousSpace = kIdentityPose;
    queue_event(instance, event);
}

XrTime predicted_time(const Session& session) {
    const Instance& instance = *session.instance;
    if (happens(instance, EventKind::negative_time, session.frame)) return -session.refresh.displayed;
    if (happens(instance, EventKind::backwards_time, session.frame))
        return session.refresh.displayed - 5 * instance.timeline.period();
    return session.refresh.displayed;
}

XrResult check_layer(const Session& session, const XrCompositionLayerProjection& layer) {
    if (layer.space == XR_NULL_HANDLE) return XR_ERROR_LAYER_INVALID;
    if (layer.viewCount != view_count_of(session.view_configuration)) return XR_ERROR_LAYER_INVALID;
    for (std::uint32_t i = 0; i < layer.viewCount; ++i) {
        const XrCompositionLayerProjectionView& view = layer.views[i];
        if (!is_unit(view.pose.orientation)) return XR_ERROR_POSE_INVALID;
        const Swapchain* swapchain = object_of<Swapchain>(view.subImage.swapchain);
        if (swapchain == nullptr || !swapchain->released) return XR_ERROR_LAYER_INVALID;
        const XrRect2Di& rect = view.subImage.imageRect;
        const bool inside =
            rect.offset.x >= 0 && rect.offset.y >= 0 && rect.extent.width > 0 && rect.extent.height > 0 &&
            static_cast<std::uint32_t>(rect.offset.x + rect.extent.width) <= swapchain->info.width &&
            static_cast<std::uint32_t>(rect.offset.y + rect.extent.height) <= swapchain->info.height;
        if (!inside) return XR_ERROR_SWAPCHAIN_RECT_INVALID;
        if (view.subImage.imageArrayIndex >= swapchain->info.arraySize) return XR_ERROR_VALIDATION_FAILURE;
        if (!(view.fov.angleLeft < view.fov.angleRight && view.fov.angleDown < view.fov.angleUp))
            return XR_ERROR_VALIDATION_FAILURE;
    }
    return XR_SUCCESS;
}

}  // namespace

XrResult wait_frame(XrSession handle, const XrFrameWaitInfo*, XrFrameState* state) {
    Session& session = *object_of<Session>(handle);
    Instance& instance = *session.instance;
    std::unique_lock lock(instance.mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (!session.running) return XR_ERROR_SESSION_NOT_RUNNING;
    // A second wait would block until another thread begins the first frame; a loop of one thread would hang.
    if (session.frame_waited) return XR_ERROR_CALL_ORDER_INVALID;

    // Let happen what was planned for this frame.
    session.frame = instance.frames++;
    follow_control_file(instance, session.frame);
    if (begins(instance, EventKind::session_lost, session.frame)) {
        lose_session(session);
        return XR_ERROR_SESSION_LOST;
    }
    if (begins(instance, EventKind::stopping, session.frame)) session.stop_requested = true;
    if (begins(instance, EventKind::exiting, session.frame)) session.exit_requested = true;
    if (begins(instance, EventKind::recentred, session.frame)) recentre(session);

    // Wait for the frame's turn. The gaze can be asked for meanwhile.
    session.refresh = instance.timeline.choose_refresh(lateness_at(instance, session.frame));
    session.frame_waited = true;
    if (!instance.settings.simulated_pacing) lock.unlock();
    instance.timeline.wait_until(session.refresh.start);
    if (!lock.owns_lock()) lock.lock();

    state->predictedDisplayTime = predicted_time(session);
    state->predictedDisplayPeriod = instance.timeline.period();
    const bool shown = session.state == XR_SESSION_STATE_VISIBLE || session.state == XR_SESSION_STATE_FOCUSED;
    state->shouldRender = shown ? XR_TRUE : XR_FALSE;
    return XR_SUCCESS;
}

XrResult begin_frame(XrSession handle, const XrFrameBeginInfo*) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (!session.running) return XR_ERROR_SESSION_NOT_RUNNING;
    if (!session.frame_waited) return XR_ERROR_CALL_ORDER_INVALID;
    const bool discarded = session.frame_begun;
    session.frame_waited = false;
    session.frame_begun = true;
    return discarded ? XR_FRAME_DISCARDED : XR_SUCCESS;
}

XrResult end_frame(XrSession handle, const XrFrameEndInfo* info) {
    Session& session = *object_of<Session>(handle);
    Instance& instance = *session.instance;
    const std::lock_guard lock(instance.mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (!session.running) return XR_ERROR_SESSION_NOT_RUNNING;
    if (!session.frame_begun) return XR_ERROR_CALL_ORDER_INVALID;
    if (info->displayTime <= 0) return XR_ERROR_TIME_INVALID;
    if (info->environmentBlendMode != XR_ENVIRONMENT_BLEND_MODE_OPAQUE)
        return XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED;

    std::uint32_t views = 0;
    for (std::uint32_t i = 0; i < info->layerCount; ++i) {
        if (info->layers[i] == nullptr || info->layers[i]->type != XR_TYPE_COMPOSITION_LAYER_PROJECTION)
            return XR_ERROR_LAYER_INVALID;
        const auto& layer = *reinterpret_cast<const XrCompositionLayerProjection*>(info->layers[i]);
        if (const XrResult result = check_layer(session, layer); result != XR_SUCCESS) return result;
        views += layer.viewCount;
        if (happens(instance, EventKind::capture, session.frame) &&
            capture_layer(session, layer, session.frame) != VK_SUCCESS)
            return XR_ERROR_RUNTIME_FAILURE;
    }
    if (instance.log) {
        instance.log << session.frame << ',' << session.state << ',' << host_from_time(session.refresh.start)
                     << ',' << host_from_time(session.refresh.displayed) << ',' << predicted_time(session)
                     << ',' << info->displayTime << ',' << views << std::endl;
    }
    session.frame_begun = false;
    ++session.frames_ended;
    step_state(session);
    return XR_SUCCESS;
}

}  // namespace parafovea::headset
