// Actions. The eye tracker is the only input; whatever else is bound is never active.
#include <array>

#include "tests/openxr_runtime/calls.h"

namespace parafovea::headset {

namespace {

constexpr std::string_view kGazeProfile = "/interaction_profiles/ext/eye_gaze_interaction";
constexpr std::string_view kGazePath = "/user/eyes_ext/input/gaze_ext/pose";
constexpr std::array<std::string_view, 3> kOtherProfiles{"/interaction_profiles/khr/simple_controller",
                                                         "/interaction_profiles/microsoft/xbox_controller",
                                                         "/interaction_profiles/microsoft/motion_controller"};

std::string_view path_text(const Instance& instance, XrPath path) {
    return path == XR_NULL_PATH || path > instance.paths.size() ? std::string_view()
                                                                : instance.paths[path - 1];
}

XrResult inactive(XrSession handle, const XrActionStateGetInfo* info) {
    const Session& session = *object_of<Session>(handle);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    const Action* action = object_of<Action>(info->action);
    return action->set->attached ? XR_SUCCESS : XR_ERROR_ACTIONSET_NOT_ATTACHED;
}

}  // namespace

bool gaze_active(const Instance& instance) {
    return instance.gaze.present() && instance.has(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME) &&
           instance.session && !happens(instance, EventKind::gaze_inactive, instance.session->frame);
}

XrResult create_action_set(XrInstance handle, const XrActionSetCreateInfo* info, XrActionSet* out) {
    Instance& instance = *object_of<Instance>(handle);
    const std::lock_guard lock(instance.mutex);
    auto set = std::make_unique<ActionSet>();
    set->instance = &instance;
    set->name = info->actionSetName;
    if (std::ranges::any_of(instance.action_sets,
                            [&](const auto& other) { return other->name == set->name; }))
        return XR_ERROR_NAME_DUPLICATED;
    *out = handle_of<XrActionSet>(set.get());
    instance.action_sets.push_back(std::move(set));
    return XR_SUCCESS;
}

XrResult destroy_action_set(XrActionSet handle) {
    if (handle == XR_NULL_HANDLE) return XR_ERROR_HANDLE_INVALID;
    const ActionSet* set = object_of<ActionSet>(handle);
    Instance& instance = *set->instance;
    const std::lock_guard lock(instance.mutex);
    for (const auto& action : set->actions)
        std::erase_if(instance.gaze_bindings, [&](const auto& binding) {
            return binding.first == handle_of<XrAction>(action.get());
        });
    std::erase_if(instance.action_sets, [set](const auto& owned) { return owned.get() == set; });
    return XR_SUCCESS;
}

XrResult create_action(XrActionSet handle, const XrActionCreateInfo* info, XrAction* out) {
    ActionSet& set = *object_of<ActionSet>(handle);
    const std::lock_guard lock(set.instance->mutex);
    if (set.attached) return XR_ERROR_ACTIONSETS_ALREADY_ATTACHED;
    auto action = std::make_unique<Action>();
    action->set = &set;
    action->name = info->actionName;
    action->type = info->actionType;
    if (std::ranges::any_of(set.actions, [&](const auto& other) { return other->name == action->name; }))
        return XR_ERROR_NAME_DUPLICATED;
    *out = handle_of<XrAction>(action.get());
    set.actions.push_back(std::move(action));
    return XR_SUCCESS;
}

XrResult destroy_action(XrAction handle) {
    if (handle == XR_NULL_HANDLE) return XR_ERROR_HANDLE_INVALID;
    const Action* action = object_of<Action>(handle);
    ActionSet& set = *action->set;
    const std::lock_guard lock(set.instance->mutex);
    std::erase_if(set.instance->gaze_bindings, [&](const auto& binding) { return binding.first == handle; });
    std::erase_if(set.actions, [action](const auto& owned) { return owned.get() == action; });
    return XR_SUCCESS;
}

XrResult suggest_bindings(XrInstance handle, const XrInteractionProfileSuggestedBinding* suggested) {
    Instance& instance = *object_of<Instance>(handle);
    const std::lock_guard lock(instance.mutex);
    const std::string_view profile = path_text(instance, suggested->interactionProfile);
    if (std::ranges::find(kOtherProfiles, profile) != kOtherProfiles.end()) return XR_SUCCESS;
    if (profile != kGazeProfile || !instance.has(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME))
        return XR_ERROR_PATH_UNSUPPORTED;
    std::vector<std::pair<XrAction, XrPath>> bindings;
    for (std::uint32_t i = 0; i < suggested->countSuggestedBindings; ++i) {
        const XrActionSuggestedBinding& binding = suggested->suggestedBindings[i];
        const Action* action = object_of<Action>(binding.action);
        if (action->set->attached) return XR_ERROR_ACTIONSETS_ALREADY_ATTACHED;
        const std::string_view path = path_text(instance, binding.binding);
        if (path != kGazePath && path != "/user/eyes_ext/input/gaze_ext") return XR_ERROR_PATH_UNSUPPORTED;
        bindings.emplace_back(binding.action, binding.binding);
    }
    instance.gaze_bindings = std::move(bindings);
    return XR_SUCCESS;
}

XrResult attach_action_sets(XrSession handle, const XrSessionActionSetsAttachInfo* info) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (session.actions_attached) return XR_ERROR_ACTIONSETS_ALREADY_ATTACHED;
    session.actions_attached = true;
    for (std::uint32_t i = 0; i < info->countActionSets; ++i)
        object_of<ActionSet>(info->actionSets[i])->attached = true;
    return XR_SUCCESS;
}

XrResult get_interaction_profile(XrSession handle, XrPath user_path, XrInteractionProfileState* profile) {
    const Session& session = *object_of<Session>(handle);
    Instance& instance = *session.instance;
    const std::lock_guard lock(instance.mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (!session.actions_attached) return XR_ERROR_ACTIONSET_NOT_ATTACHED;
    profile->interactionProfile = XR_NULL_PATH;
    if (path_text(instance, user_path) == "/user/eyes_ext" && !instance.gaze_bindings.empty() &&
        instance.gaze.present()) {
        const auto known = std::ranges::find(instance.paths, kGazeProfile);
        profile->interactionProfile = static_cast<XrPath>(known - instance.paths.begin()) + 1;
    }
    return XR_SUCCESS;
}

XrResult get_boolean_state(XrSession session, const XrActionStateGetInfo* info, XrActionStateBoolean* state) {
    state->currentState = state->changedSinceLastSync = state->isActive = XR_FALSE;
    state->lastChangeTime = 0;
    return inactive(session, info);
}

XrResult get_float_state(XrSession session, const XrActionStateGetInfo* info, XrActionStateFloat* state) {
    state->currentState = 0;
    state->changedSinceLastSync = state->isActive = XR_FALSE;
    state->lastChangeTime = 0;
    return inactive(session, info);
}

XrResult get_vector_state(XrSession session, const XrActionStateGetInfo* info, XrActionStateVector2f* state) {
    state->currentState = {0, 0};
    state->changedSinceLastSync = state->isActive = XR_FALSE;
    state->lastChangeTime = 0;
    return inactive(session, info);
}

XrResult get_pose_state(XrSession handle, const XrActionStateGetInfo* info, XrActionStatePose* state) {
    const Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    const auto& bindings = session.instance->gaze_bindings;
    const bool is_gaze =
        std::ranges::any_of(bindings, [info](const auto& binding) { return binding.first == info->action; });
    state->isActive = is_gaze && session.gaze_synced ? XR_TRUE : XR_FALSE;
    return inactive(handle, info);
}

XrResult sync_actions(XrSession handle, const XrActionsSyncInfo*) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (!session.actions_attached) return XR_ERROR_ACTIONSET_NOT_ATTACHED;
    if (session.state != XR_SESSION_STATE_FOCUSED) {
        session.gaze_synced = false;
        return XR_SESSION_NOT_FOCUSED;
    }
    session.gaze_synced = gaze_active(*session.instance);
    return XR_SUCCESS;
}

XrResult enumerate_bound_sources(XrSession handle, const XrBoundSourcesForActionEnumerateInfo* info,
                                 std::uint32_t capacity, std::uint32_t* count, XrPath* sources) {
    const Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (!session.actions_attached) return XR_ERROR_ACTIONSET_NOT_ATTACHED;
    std::vector<XrPath> bound;
    for (const auto& [action, path] : session.instance->gaze_bindings)
        if (action == info->action && session.instance->gaze.present()) bound.push_back(path);
    return enumerate<XrPath>(bound, capacity, count, sources);
}

XrResult get_source_name(XrSession, const XrInputSourceLocalizedNameGetInfo*, std::uint32_t capacity,
                         std::uint32_t* count, char* name) {
    return enumerate_text("Simulated eye tracker", capacity, count, name);
}

XrResult apply_haptics(XrSession, const XrHapticActionInfo*, const XrHapticBaseHeader*) {
    return XR_SUCCESS;  // nothing here can shake
}

XrResult stop_haptics(XrSession, const XrHapticActionInfo*) {
    return XR_SUCCESS;
}

}  // namespace parafovea::headset
