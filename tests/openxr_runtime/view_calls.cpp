// Views: how many, where they look from, how wide, and which part of them the lenses hide.
#include <array>
#include <cmath>

#include "tests/openxr_runtime/calls.h"

namespace parafovea::headset {

namespace {

constexpr float kHalfEyeDistance_m = 0.0315f;

float rad(double deg) {
    return static_cast<float>(rad_from_deg(deg));
}

// Pixels are square: from the horizontal half angles follows the vertical one.
XrFovf fov_from_sides(double left_deg, double right_deg) {
    const double width = std::tan(rad_from_deg(left_deg)) + std::tan(rad_from_deg(right_deg));
    const auto up = static_cast<float>(std::atan(width / 2 * kViewHeight / kViewWidth));
    return {-rad(left_deg), rad(right_deg), up, -up};
}

// The eight corners of what can be seen through a lens, anticlockwise, on the plane one metre ahead.
std::array<XrVector2f, 8> lens_outline(const XrFovf& fov) {
    const float left = std::tan(fov.angleLeft), right = std::tan(fov.angleRight);
    const float down = std::tan(fov.angleDown), up = std::tan(fov.angleUp);
    const float dx = (right - left) * 0.2f, dy = (up - down) * 0.2f;
    return {{{left + dx, down},
             {right - dx, down},
             {right, down + dy},
             {right, up - dy},
             {right - dx, up},
             {left + dx, up},
             {left, up - dy},
             {left, down + dy}}};
}

}  // namespace

std::uint32_t view_count_of(XrViewConfigurationType configuration) {
    switch (configuration) {
        case XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO:
            return 1;
        case XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO:
            return 4;
        default:
            return 2;
    }
}

XrViewConfigurationType offered_view_configuration(const Instance& instance) {
    if (instance.settings.views == 1) return XR_VIEW_CONFIGURATION_TYPE_PRIMARY_MONO;
    if (instance.settings.views == 4 && instance.has(XR_VARJO_QUAD_VIEWS_EXTENSION_NAME))
        return XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO;
    return XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
}

// A head that turns slowly from side to side.
XrPosef stage_from_head(XrTime time) {
    const double seconds = static_cast<double>(host_from_time(time)) * 1e-9;
    const double yaw_deg = 5 * std::sin(2 * std::numbers::pi * 0.1 * seconds);
    return {orientation_towards({yaw_deg, 0}), {0, 1.2f, 0}};
}

XrPosef head_from_view(std::uint32_t view, std::uint32_t view_count) {
    if (view_count == 1) return kIdentityPose;
    return {{0, 0, 0, 1}, {view % 2 == 0 ? -kHalfEyeDistance_m : kHalfEyeDistance_m, 0, 0}};
}

XrFovf view_fov(std::uint32_t view, std::uint32_t view_count) {
    if (view_count == 1) return fov_from_sides(50, 50);
    if (view >= 2) return fov_from_sides(15, 15);                        // the insets of four views
    return view == 0 ? fov_from_sides(52, 48) : fov_from_sides(48, 52);  // more on the temple's side
}

XrResult enumerate_view_configurations(XrInstance handle, XrSystemId system, std::uint32_t capacity,
                                       std::uint32_t* count, XrViewConfigurationType* out) {
    if (system != kSystem) return XR_ERROR_SYSTEM_INVALID;
    const XrViewConfigurationType types[] = {offered_view_configuration(*object_of<Instance>(handle))};
    return enumerate<XrViewConfigurationType>(types, capacity, count, out);
}

XrResult get_view_configuration_properties(XrInstance handle, XrSystemId system, XrViewConfigurationType type,
                                           XrViewConfigurationProperties* properties) {
    if (system != kSystem) return XR_ERROR_SYSTEM_INVALID;
    if (type != offered_view_configuration(*object_of<Instance>(handle)))
        return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
    properties->viewConfigurationType = type;
    properties->fovMutable = XR_FALSE;
    return XR_SUCCESS;
}

XrResult enumerate_views(XrInstance handle, XrSystemId system, XrViewConfigurationType type,
                         std::uint32_t capacity, std::uint32_t* count, XrViewConfigurationView* out) {
    if (system != kSystem) return XR_ERROR_SYSTEM_INVALID;
    if (type != offered_view_configuration(*object_of<Instance>(handle)))
        return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
    XrViewConfigurationView view{XR_TYPE_VIEW_CONFIGURATION_VIEW};
    const auto shrink = static_cast<std::uint32_t>(object_of<Instance>(handle)->settings.shrink);
    view.recommendedImageRectWidth = kViewWidth / shrink;
    view.recommendedImageRectHeight = kViewHeight / shrink;
    view.maxImageRectWidth = 4096;
    view.maxImageRectHeight = 4096;
    view.recommendedSwapchainSampleCount = 1;
    view.maxSwapchainSampleCount = 1;
    const std::vector<XrViewConfigurationView> views(view_count_of(type), view);
    return enumerate<XrViewConfigurationView>(views, capacity, count, out);
}

XrResult locate_views(XrSession handle, const XrViewLocateInfo* info, XrViewState* state,
                      std::uint32_t capacity, std::uint32_t* count, XrView* views) {
    Session& session = *object_of<Session>(handle);
    const std::lock_guard lock(session.instance->mutex);
    if (session.lost) return XR_ERROR_SESSION_LOST;
    if (info->displayTime <= 0) return XR_ERROR_TIME_INVALID;
    if (info->viewConfigurationType != offered_view_configuration(*session.instance))
        return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
    const std::uint32_t view_count = view_count_of(info->viewConfigurationType);
    *count = view_count;
    state->viewStateFlags = XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT |
                            XR_VIEW_STATE_ORIENTATION_TRACKED_BIT | XR_VIEW_STATE_POSITION_TRACKED_BIT;
    if (capacity == 0) return XR_SUCCESS;
    if (capacity < view_count) return XR_ERROR_SIZE_INSUFFICIENT;
    const std::optional<XrPosef> base = stage_from_space(*object_of<Space>(info->space), info->displayTime);
    if (!base) {
        state->viewStateFlags = 0;
        return XR_SUCCESS;
    }
    const XrPosef base_from_head = compose(inverse(*base), stage_from_head(info->displayTime));
    for (std::uint32_t i = 0; i < view_count; ++i) {
        views[i].pose = compose(base_from_head, head_from_view(i, view_count));
        views[i].fov = view_fov(i, view_count);
    }
    return XR_SUCCESS;
}

XrResult get_visibility_mask(XrSession handle, XrViewConfigurationType type, std::uint32_t view,
                             XrVisibilityMaskTypeKHR kind, XrVisibilityMaskKHR* mask) {
    Session& session = *object_of<Session>(handle);
    if (type != offered_view_configuration(*session.instance))
        return XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED;
    const std::uint32_t view_count = view_count_of(type);
    if (view >= view_count) return XR_ERROR_VALIDATION_FAILURE;
    const XrFovf fov = view_fov(view, view_count);
    const auto outline = lens_outline(fov);
    std::vector<XrVector2f> vertices(outline.begin(), outline.end());
    std::vector<std::uint32_t> indices;
    if (kind == XR_VISIBILITY_MASK_TYPE_LINE_LOOP_KHR) {
        indices = {0, 1, 2, 3, 4, 5, 6, 7};
    } else if (kind == XR_VISIBILITY_MASK_TYPE_VISIBLE_TRIANGLE_MESH_KHR) {
        for (std::uint32_t i = 2; i < 8; ++i) indices.insert(indices.end(), {0, i - 1, i});
    } else {
        const float left = std::tan(fov.angleLeft), right = std::tan(fov.angleRight);
        const float down = std::tan(fov.angleDown), up = std::tan(fov.angleUp);
        vertices.insert(vertices.end(), {{right, down}, {right, up}, {left, up}, {left, down}});
        indices = {1, 8, 2, 3, 9, 4, 5, 10, 6, 7, 11, 0};
    }
    const XrResult result =
        enumerate<XrVector2f>(vertices, mask->vertexCapacityInput, &mask->vertexCountOutput, mask->vertices);
    const XrResult result2 =
        enumerate<std::uint32_t>(indices, mask->indexCapacityInput, &mask->indexCountOutput, mask->indices);
    return result != XR_SUCCESS ? result : result2;
}

}  // namespace parafovea::headset
