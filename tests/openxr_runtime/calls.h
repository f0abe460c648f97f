// The OpenXR functions of the simulated headset, by subject. Each does what the specification says of its
// namesake; what the specification calls invalid usage is left to the validation layer unless it would break
// the runtime.
#pragma once

#include <ctime>

#include "tests/openxr_runtime/objects.h"
#include "tests/openxr_runtime/pose_math.h"

namespace parafovea::headset {

// procedure_table.cpp
XrResult get_procedure(XrInstance instance, const char* name, PFN_xrVoidFunction* function);

// instance_calls.cpp
XrResult enumerate_extensions(const char* layer, std::uint32_t capacity, std::uint32_t* count,
                              XrExtensionProperties* out);
XrResult enumerate_layers(std::uint32_t capacity, std::uint32_t* count, XrApiLayerProperties* out);
XrResult create_instance(const XrInstanceCreateInfo* info, XrInstance* instance);
XrResult destroy_instance(XrInstance instance);
XrResult get_instance_properties(XrInstance instance, XrInstanceProperties* properties);
XrResult poll_event(XrInstance instance, XrEventDataBuffer* event);
XrResult result_to_string(XrInstance instance, XrResult value, char buffer[XR_MAX_RESULT_STRING_SIZE]);
XrResult structure_type_to_string(XrInstance instance, XrStructureType value,
                                  char buffer[XR_MAX_STRUCTURE_NAME_SIZE]);
XrResult get_system(XrInstance instance, const XrSystemGetInfo* info, XrSystemId* system);
XrResult get_system_properties(XrInstance instance, XrSystemId system, XrSystemProperties* properties);
XrResult enumerate_blend_modes(XrInstance instance, XrSystemId system, XrViewConfigurationType configuration,
                               std::uint32_t capacity, std::uint32_t* count, XrEnvironmentBlendMode* modes);
XrResult string_to_path(XrInstance instance, const char* text, XrPath* path);
XrResult path_to_string(XrInstance instance, XrPath path, std::uint32_t capacity, std::uint32_t* count,
                        char* text);
XrResult time_from_timespec(XrInstance instance, const timespec* host, XrTime* time);
XrResult timespec_from_time(XrInstance instance, XrTime time, timespec* host);

// view_calls.cpp
XrResult enumerate_view_configurations(XrInstance instance, XrSystemId system, std::uint32_t capacity,
                                       std::uint32_t* count, XrViewConfigurationType* out);
XrResult get_view_configuration_properties(XrInstance instance, XrSystemId system,
                                           XrViewConfigurationType type,
                                           XrViewConfigurationProperties* properties);
XrResult enumerate_views(XrInstance instance, XrSystemId system, XrViewConfigurationType type,
                         std::uint32_t capacity, std::uint32_t* count, XrViewConfigurationView* out);
XrResult locate_views(XrSession session, const XrViewLocateInfo* info, XrViewState* state,
                      std::uint32_t capacity, std::uint32_t* count, XrView* views);
XrResult get_visibility_mask(XrSession session, XrViewConfigurationType type, std::uint32_t view,
                             XrVisibilityMaskTypeKHR kind, XrVisibilityMaskKHR* mask);

// vulkan_calls.cpp
XrResult create_vulkan_instance(XrInstance instance, const XrVulkanInstanceCreateInfoKHR* info,
                                VkInstance* vulkan_instance, VkResult* result);
XrResult create_vulkan_device(XrInstance instance, const XrVulkanDeviceCreateInfoKHR* info, VkDevice* device,
                              VkResult* result);
XrResult get_vulkan_graphics_device(XrInstance instance, const XrVulkanGraphicsDeviceGetInfoKHR* info,
                                    VkPhysicalDevice* device);
XrResult get_vulkan_graphics_requirements(XrInstance instance, XrSystemId system,
                                          XrGraphicsRequirementsVulkanKHR* requirements);

// session_calls.cpp
XrResult create_session(XrInstance instance, const XrSessionCreateInfo* info, XrSession* session);
XrResult destroy_session(XrSession session);
XrResult begin_session(XrSession session, const XrSessionBeginInfo* info);
XrResult end_session(XrSession session);
XrResult request_exit_session(XrSession session);
XrResult enumerate_refresh_rates(XrSession session, std::uint32_t capacity, std::uint32_t* count,
                                 float* rates);
XrResult get_refresh_rate(XrSession session, float* rate);
XrResult request_refresh_rate(XrSession session, float rate);
void enter_state(Session& session, XrSessionState state);
void step_state(Session& session);
void lose_session(Session& session);

// frame_calls.cpp
XrResult wait_frame(XrSession session, const XrFrameWaitInfo* info, XrFrameState* state);
XrResult begin_frame(XrSession session, const XrFrameBeginInfo* info);
XrResult end_frame(XrSession session, const XrFrameEndInfo* info);

// swapchain_calls.cpp
XrResult enumerate_swapchain_formats(XrSession session, std::uint32_t capacity, std::uint32_t* count,
                                     std::int64_t* formats);
XrResult create_swapchain(XrSession session, const XrSwapchainCreateInfo* info, XrSwapchain* swapchain);
XrResult destroy_swapchain(XrSwapchain swapchain);
XrResult enumerate_swapchain_images(XrSwapchain swapchain, std::uint32_t capacity, std::uint32_t* count,
                                    XrSwapchainImageBaseHeader* images);
XrResult acquire_swapchain_image(XrSwapchain swapchain, const XrSwapchainImageAcquireInfo* info,
                                 std::uint32_t* index);
XrResult wait_swapchain_image(XrSwapchain swapchain, const XrSwapchainImageWaitInfo* info);
XrResult release_swapchain_image(XrSwapchain swapchain, const XrSwapchainImageReleaseInfo* info);

// space_calls.cpp
XrResult enumerate_reference_spaces(XrSession session, std::uint32_t capacity, std::uint32_t* count,
                                    XrReferenceSpaceType* spaces);
XrResult create_reference_space(XrSession session, const XrReferenceSpaceCreateInfo* info, XrSpace* space);
XrResult get_bounds(XrSession session, XrReferenceSpaceType type, XrExtent2Df* bounds);
XrResult create_action_space(XrSession session, const XrActionSpaceCreateInfo* info, XrSpace* space);
XrResult locate_space(XrSpace space, XrSpace base, XrTime time, XrSpaceLocation* location);
XrResult destroy_space(XrSpace space);
std::optional<XrPosef> stage_from_space(const Space& space, XrTime time);  // nothing for an action's pose

// action_calls.cpp
XrResult create_action_set(XrInstance instance, const XrActionSetCreateInfo* info, XrActionSet* set);
XrResult destroy_action_set(XrActionSet set);
XrResult create_action(XrActionSet set, const XrActionCreateInfo* info, XrAction* action);
XrResult destroy_action(XrAction action);
XrResult suggest_bindings(XrInstance instance, const XrInteractionProfileSuggestedBinding* suggested);
XrResult attach_action_sets(XrSession session, const XrSessionActionSetsAttachInfo* info);
XrResult get_interaction_profile(XrSession session, XrPath user_path, XrInteractionProfileState* profile);
XrResult get_boolean_state(XrSession session, const XrActionStateGetInfo* info, XrActionStateBoolean* state);
XrResult get_float_state(XrSession session, const XrActionStateGetInfo* info, XrActionStateFloat* state);
XrResult get_vector_state(XrSession session, const XrActionStateGetInfo* info, XrActionStateVector2f* state);
XrResult get_pose_state(XrSession session, const XrActionStateGetInfo* info, XrActionStatePose* state);
XrResult sync_actions(XrSession session, const XrActionsSyncInfo* info);
XrResult enumerate_bound_sources(XrSession session, const XrBoundSourcesForActionEnumerateInfo* info,
                                 std::uint32_t capacity, std::uint32_t* count, XrPath* sources);
XrResult get_source_name(XrSession session, const XrInputSourceLocalizedNameGetInfo* info,
                         std::uint32_t capacity, std::uint32_t* count, char* name);
XrResult apply_haptics(XrSession session, const XrHapticActionInfo* info, const XrHapticBaseHeader* feedback);
XrResult stop_haptics(XrSession session, const XrHapticActionInfo* info);

// Whether the gaze is there for an application at a frame, by the script.
bool gaze_active(const Instance& instance);

}  // namespace parafovea::headset
