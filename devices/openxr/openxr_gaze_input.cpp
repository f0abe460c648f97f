// Binds and reads the gaze action.
#include "devices/openxr/openxr_gaze_input.h"

#include <cstring>
#include <utility>

namespace parafovea {

OpenXrGazeInput::OpenXrGazeInput(const OpenXrInstance& instance) : instance_(instance) {
    if (!instance.has_eye_tracker()) return;
    XrActionSetCreateInfo set{XR_TYPE_ACTION_SET_CREATE_INFO};
    std::strcpy(set.actionSetName, "gaze");
    std::strcpy(set.localizedActionSetName, "Gaze");
    check_openxr(xrCreateActionSet(instance.handle(), &set, &actions_), "preparing the eye tracker");
    XrActionCreateInfo action{XR_TYPE_ACTION_CREATE_INFO};
    std::strcpy(action.actionName, "gaze");
    std::strcpy(action.localizedActionName, "Gaze");
    action.actionType = XR_ACTION_TYPE_POSE_INPUT;
    check_openxr(xrCreateAction(actions_, &action, &action_), "preparing the eye tracker");

    XrPath profile = XR_NULL_PATH;
    XrActionSuggestedBinding binding{action_, XR_NULL_PATH};
    check_openxr(
        xrStringToPath(instance.handle(), "/interaction_profiles/ext/eye_gaze_interaction", &profile),
        "naming the eye tracker");
    check_openxr(xrStringToPath(instance.handle(), "/user/eyes_ext/input/gaze_ext/pose", &binding.binding),
                 "naming the eye tracker");
    XrInteractionProfileSuggestedBinding suggested{XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING};
    suggested.interactionProfile = profile;
    suggested.countSuggestedBindings = 1;
    suggested.suggestedBindings = &binding;
    check_openxr(xrSuggestInteractionProfileBindings(instance.handle(), &suggested),
                 "binding the eye tracker");
}

OpenXrGazeInput::~OpenXrGazeInput() {
    if (actions_ != XR_NULL_HANDLE) xrDestroyActionSet(actions_);
}

void OpenXrGazeInput::attach(XrSession session) {
    if (actions_ == XR_NULL_HANDLE) return;
    XrSessionActionSetsAttachInfo attach{XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO};
    attach.countActionSets = 1;
    attach.actionSets = &actions_;
    check_openxr(xrAttachSessionActionSets(session, &attach), "attaching the eye tracker");
    XrActionSpaceCreateInfo space{XR_TYPE_ACTION_SPACE_CREATE_INFO};
    space.action = action_;
    space.poseInActionSpace.orientation.w = 1;
    check_openxr(xrCreateActionSpace(session, &space, &gaze_), "attaching the eye tracker");
}

void OpenXrGazeInput::detach() {
    if (gaze_ != XR_NULL_HANDLE) xrDestroySpace(std::exchange(gaze_, XR_NULL_HANDLE));
}

GazeReading OpenXrGazeInput::read(XrSession session, XrSpace head, DeviceTime asked) const {
    GazeReading reading;
    reading.asked = asked;
    if (gaze_ == XR_NULL_HANDLE) return reading;

    XrActiveActionSet active{actions_, XR_NULL_PATH};
    XrActionsSyncInfo sync{XR_TYPE_ACTIONS_SYNC_INFO};
    sync.countActiveActionSets = 1;
    sync.activeActionSets = &active;
    XrResult result = xrSyncActions(session, &sync);
    if (result == XR_ERROR_SESSION_LOST || result == XR_SESSION_NOT_FOCUSED) return reading;
    check_openxr(result, "asking the eye tracker");

    XrActionStateGetInfo get{XR_TYPE_ACTION_STATE_GET_INFO};
    get.action = action_;
    XrActionStatePose state{XR_TYPE_ACTION_STATE_POSE};
    result = xrGetActionStatePose(session, &get, &state);
    if (result == XR_ERROR_SESSION_LOST) return reading;
    check_openxr(result, "asking the eye tracker");
    if (state.isActive != XR_TRUE) return reading;

    XrEyeGazeSampleTimeEXT sample_time{XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT};
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    location.next = &sample_time;
    result = xrLocateSpace(gaze_, head, asked.ns, &location);
    if (result == XR_ERROR_SESSION_LOST) return reading;
    check_openxr(result, "asking the eye tracker");

    // Zero says that the runtime does not know; the very time that was asked for says that it did not look.
    if (sample_time.time != 0 && sample_time.time != asked.ns)
        reading.sample_time = DeviceTime{sample_time.time};
    if ((location.locationFlags & XR_SPACE_LOCATION_ORIENTATION_VALID_BIT) == 0) {
        reading.activity = GazeActivity::no_eye;
        return reading;
    }
    const bool tracked = (location.locationFlags & XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT) != 0;
    reading.activity = tracked ? GazeActivity::tracked : GazeActivity::degraded;
    reading.orientation = location.pose.orientation;
    return reading;
}

}  // namespace parafovea
