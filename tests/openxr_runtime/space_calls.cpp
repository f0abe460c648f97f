// Spaces, and where they are: the head, the room, and the gaze.
#include "tests/openxr_runtime/calls.h"

namespace parafovea::headset {

namespace {

constexpr XrSpaceLocationFlags kValid =
    XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
constexpr XrSpaceLocationFlags kTracked =
    XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
constexpr XrReferenceSpaceType kReferences[] = {XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL,
                                                XR_REFERENCE_SPACE_TYPE_STAGE};

bool is_gaze(const Instance& instance, const Action& action) {
    const auto handle = reinterpret_cast<XrAction>(const_cast<Action*>(&action));
    return std::ranges::any_of(instance.gaze_bindings, [handle](const auto& b) { return b.first == handle; });
}

// The gaze as the tracker has it for the asked time, with the time it belongs to.
void locate_gaze(const Session& session, const Space& gaze, const Space& base, XrTime asked,
                 XrSpaceLocation& location) {
    const Instance& instance = *session.instance;
    auto* sample_time =
        find_in_chain<XrEyeGazeSampleTimeEXT>(location.next, XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT);
    if (sample_time != nullptr) sample_time->time = 0;
    location.locationFlags = 0;
    location.pose = kIdentityPose;
    if (!session.gaze_synced || !is_gaze(instance, *gaze.action)) return;

    const PlayedGaze played = instance.gaze.at(asked, instance.timeline.now());
    if (played.made == 0) return;
    if (sample_time != nullptr) {
        switch (instance.settings.sample_times) {
            case SampleTimes::made:
                sample_time->time = played.made;
                break;
            case SampleTimes::zero:
                break;
            case SampleTimes::echo:
                sample_time->time = asked;
                break;
        }
    }
    if (happens(instance, EventKind::gaze_missing, session.frame)) return;
    if (played.status == GazeStatus::blink || played.status == GazeStatus::lost) return;
    const XrPosef head_from_gaze{orientation_towards(played.direction), {0, 0, 0}};
    const XrPosef stage_from_gaze =
        compose(compose(stage_from_head(played.made), head_from_gaze), gaze.offset);
    // Seen from the head, the head's own movement since then is no part of the gaze.
    const bool from_head = base.action == nullptr && base.reference == XR_REFERENCE_SPACE_TYPE_VIEW;
    const std::optional<XrPosef> stage_from_base = stage_from_space(base, from_head ? played.made : asked);
    if (!stage_from_base) return;
    location.pose = compose(inverse(*stage_from_base), stage_from_gaze);
    location.locationFlags = kValid;
    if (played.status == GazeStatus::tracked) location.locationFlags |= kTracked;
}

}  // namespace

std::optional<XrPosef> stage_from_space(const Space& space, XrTime time) {
    if (space.action != nullptr) return std::nullopt;
    switch (space.reference) {
        case XR_REFERENCE_SPACE_TYPE_VIEW:
            return compose(stage_from_head(time), space.offset);
        case XR_REFERENCE_SPACE_TYPE_LOCAL:
            return compose(space.session->instance->stage_from_local, space.offset);
        default:
            return space.offset;
    }
}

XrResult enumerate_reference_spaces(XrSession, std::uint32_t capacity, std::uint32_t* count,
                                    XrReferenceSpaceType* spaces) {
    return enumerate<XrReferenceSpaceType>(kReferences, capacity, count, spaces);
}

XrResult create_reference_space(XrSession handle, const XrReferenceSpaceCreateInfo* info, XrSpace* out) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (std::ranges::find(kReferences, info->referenceSpaceType) == std::end(kReferences))
        return XR_ERROR_REFERENCE_SPACE_UNSUPPORTED;
    if (!is_unit(info->poseInReferenceSpace.orientation)) return XR_ERROR_POSE_INVALID;
    auto space = std::make_unique<Space>();
    space->session = &session;
    space->reference = info->referenceSpaceType;
    space->offset = info->poseInReferenceSpace;
    *out = handle_of<XrSpace>(space.get());
    session.spaces.push_back(std::move(space));
    return XR_SUCCESS;
}

XrResult get_bounds(XrSession, XrReferenceSpaceType, XrExtent2Df* bounds) {
    *bounds = {0, 0};
    return XR_SPACE_BOUNDS_UNAVAILABLE;
}

XrResult create_action_space(XrSession handle, const XrActionSpaceCreateInfo* info, XrSpace* out) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    const Action* action = object_of<Action>(info->action);
    if (action == nullptr) return XR_ERROR_HANDLE_INVALID;
    if (action->type != XR_ACTION_TYPE_POSE_INPUT) return XR_ERROR_ACTION_TYPE_MISMATCH;
    if (!is_unit(info->poseInActionSpace.orientation)) return XR_ERROR_POSE_INVALID;
    auto space = std::make_unique<Space>();
    space->session = &session;
    space->action = action;
    space->offset = info->poseInActionSpace;
    *out = handle_of<XrSpace>(space.get());
    session.spaces.push_back(std::move(space));
    return XR_SUCCESS;
}

XrResult locate_space(XrSpace space_handle, XrSpace base_handle, XrTime time, XrSpaceLocation* location) {
    const Space& space = *object_of<Space>(space_handle);
    const Space& base = *object_of<Space>(base_handle);
    const Session& session = *space.session;
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (time <= 0) return XR_ERROR_TIME_INVALID;
    if (auto* velocity = find_in_chain<XrSpaceVelocity>(location->next, XR_TYPE_SPACE_VELOCITY);
        velocity != nullptr)
        velocity->velocityFlags = 0;
    if (space.action != nullptr) {
        locate_gaze(session, space, base, time, *location);
        return XR_SUCCESS;
    }
    const std::optional<XrPosef> stage_from_base = stage_from_space(base, time);
    location->locationFlags = stage_from_base ? kValid | kTracked : 0;
    location->pose =
        stage_from_base ? compose(inverse(*stage_from_base), *stage_from_space(space, time)) : kIdentityPose;
    return XR_SUCCESS;
}

XrResult destroy_space(XrSpace handle) {
    if (handle == XR_NULL_HANDLE) return XR_ERROR_HANDLE_INVALID;
    const Space* space = object_of<Space>(handle);
    Session& session = *space->session;
    const std::lock_guard lock(session.instance->mutex);
    std::erase_if(session.spaces, [space](const auto& owned) { return owned.get() == space; });
    return XR_SUCCESS;
}

}  // namespace parafovea::headset
