// Runs a session on an OpenXR headset.
#include "devices/openxr/openxr_session.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace parafovea {

namespace {

constexpr XrPosef kIdentity{{0, 0, 0, 1}, {0, 0, 0}};

}  // namespace

std::string_view name_of(SessionState state) {
    constexpr std::array<std::string_view, 8> kNames{"starting", "synchronized", "visible", "focused",
                                                     "stopping", "stopped",      "exiting", "lost"};
    return kNames[static_cast<std::size_t>(state)];
}

OpenXrSession::OpenXrSession(const OpenXrInstance& instance, const OpenXrVulkan& vulkan, Clock& clock,
                             PictureFrame picture_frame)
    : instance_(instance),
      vulkan_(vulkan),
      clock_(clock),
      picture_frame_(picture_frame),
      gaze_input_(instance) {
    try {
        create();
    } catch (...) {
        destroy();
        throw;
    }
}

OpenXrSession::~OpenXrSession() {
    destroy();
}

void OpenXrSession::create() {
    XrGraphicsBindingVulkanKHR graphics{XR_TYPE_GRAPHICS_BINDING_VULKAN_KHR};
    graphics.instance = vulkan_.instance;
    graphics.physicalDevice = vulkan_.physical_device;
    graphics.device = vulkan_.device;
    graphics.queueFamilyIndex = vulkan_.queue_family;
    graphics.queueIndex = 0;
    XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO};
    info.next = &graphics;
    info.systemId = instance_.system();
    check_openxr(xrCreateSession(instance_.handle(), &info, &session_), "starting a session");
    head_ = make_space(XR_REFERENCE_SPACE_TYPE_VIEW, kIdentity);
    room_ = make_space(XR_REFERENCE_SPACE_TYPE_LOCAL, kIdentity);
    choose_format();
    create_swapchains();
    gaze_input_.attach(session_);
    state_ = SessionState::starting;
}

void OpenXrSession::destroy() {
    const std::lock_guard lock(handles_);
    gaze_input_.detach();
    for (const Swapchain& swapchain : swapchains_)
        if (swapchain.handle != XR_NULL_HANDLE) xrDestroySwapchain(swapchain.handle);
    swapchains_.clear();
    for (XrSpace* const space : {&head_, &room_})
        if (*space != XR_NULL_HANDLE) xrDestroySpace(std::exchange(*space, XR_NULL_HANDLE));
    running_ = false;
    if (session_ != XR_NULL_HANDLE) xrDestroySession(std::exchange(session_, XR_NULL_HANDLE));
}

bool OpenXrSession::restart() {
    destroy();
    try {
        const std::lock_guard lock(handles_);
        create();
    } catch (const std::runtime_error&) {
        destroy();
        state_ = SessionState::lost;
        return false;
    }
    ++restarts_;
    return true;
}

XrSpace OpenXrSession::make_space(XrReferenceSpaceType type, const XrPosef& pose) {
    XrReferenceSpaceCreateInfo info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO};
    info.referenceSpaceType = type;
    info.poseInReferenceSpace = pose;
    XrSpace space = XR_NULL_HANDLE;
    check_openxr(xrCreateReferenceSpace(session_, &info, &space), "finding where the head is");
    return space;
}

void OpenXrSession::choose_format() {
    std::uint32_t count = 0;
    check_openxr(xrEnumerateSwapchainFormats(session_, 0, &count, nullptr), "asking for picture formats");
    std::vector<std::int64_t> formats(count);
    check_openxr(xrEnumerateSwapchainFormats(session_, count, &count, formats.data()),
                 "asking for picture formats");
    for (const VkFormat wanted : {VK_FORMAT_R8G8B8A8_SRGB, VK_FORMAT_B8G8R8A8_SRGB}) {
        if (std::ranges::find(formats, static_cast<std::int64_t>(wanted)) == formats.end()) continue;
        format_ = wanted;
        return;
    }
    throw std::runtime_error("the OpenXR runtime " + instance_.runtime_name() +
                             " takes no 8-bit sRGB pictures; use another runtime");
}

void OpenXrSession::create_swapchains() {
    for (const SizePx size : instance_.view_sizes()) {
        XrSwapchainCreateInfo info{XR_TYPE_SWAPCHAIN_CREATE_INFO};
        info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
        info.format = format_;
        info.sampleCount = info.faceCount = info.arraySize = info.mipCount = 1;
        info.width = static_cast<std::uint32_t>(size.width);
        info.height = static_cast<std::uint32_t>(size.height);
        Swapchain& swapchain = swapchains_.emplace_back();
        swapchain.size = size;
        check_openxr(xrCreateSwapchain(session_, &info, &swapchain.handle),
                     "making pictures for the headset");
        std::uint32_t count = 0;
        check_openxr(xrEnumerateSwapchainImages(swapchain.handle, 0, &count, nullptr),
                     "making pictures for the headset");
        std::vector<XrSwapchainImageVulkanKHR> images(
            count, XrSwapchainImageVulkanKHR{XR_TYPE_SWAPCHAIN_IMAGE_VULKAN_KHR});
        check_openxr(xrEnumerateSwapchainImages(swapchain.handle, count, &count,
                                                reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data())),
                     "making pictures for the headset");
        for (const XrSwapchainImageVulkanKHR& image : images) swapchain.images.push_back(image.image);
    }
}

// False after the session's loss, which is no failure of ours; other failures throw.
bool OpenXrSession::still_there(XrResult result, const char* doing) {
    if (result == XR_ERROR_SESSION_LOST) {
        state_ = SessionState::lost;
        running_ = false;
        return false;
    }
    check_openxr(result, doing);
    return true;
}

SessionState OpenXrSession::update() {
    while (const std::optional<XrEventDataBuffer> event = instance_.next_event()) {
        if (event->type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) {
            XrEventDataSessionStateChanged change{};
            std::memcpy(&change, &*event, sizeof change);
            if (change.session == session_) follow(change);
        } else if (event->type == XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING) {
            XrEventDataReferenceSpaceChangePending change{};
            std::memcpy(&change, &*event, sizeof change);
            recentrings_ +=
                change.session == session_ && change.referenceSpaceType == XR_REFERENCE_SPACE_TYPE_LOCAL;
        } else if (event->type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) {
            throw std::runtime_error("the OpenXR runtime is shutting down; start it again, then resume");
        }
    }
    return state_;
}

void OpenXrSession::follow(const XrEventDataSessionStateChanged& change) {
    switch (change.state) {
        case XR_SESSION_STATE_READY: {
            XrSessionBeginInfo begin{XR_TYPE_SESSION_BEGIN_INFO};
            begin.primaryViewConfigurationType = instance_.view_configuration();
            running_ = still_there(xrBeginSession(session_, &begin), "beginning the session");
            if (!running_) break;
            state_ = SessionState::starting;
            ++beginnings_;
            break;
        }
        case XR_SESSION_STATE_SYNCHRONIZED:
            state_ = SessionState::synchronized;
            break;
        case XR_SESSION_STATE_VISIBLE:
            state_ = SessionState::visible;
            break;
        case XR_SESSION_STATE_FOCUSED:
            state_ = SessionState::focused;
            break;
        case XR_SESSION_STATE_STOPPING:
            state_ = SessionState::stopping;
            running_ = false;
            if (still_there(xrEndSession(session_), "ending the session")) state_ = SessionState::stopped;
            break;
        case XR_SESSION_STATE_EXITING:
            state_ = SessionState::exiting;
            break;
        case XR_SESSION_STATE_LOSS_PENDING:
            state_ = SessionState::lost;
            running_ = false;
            break;
        default:
            break;
    }
}

std::optional<OpenXrFrame> OpenXrSession::begin_frame() {
    update();
    if (!running_) return std::nullopt;
    XrFrameWaitInfo wait{XR_TYPE_FRAME_WAIT_INFO};
    XrFrameState state{XR_TYPE_FRAME_STATE};
    if (!still_there(xrWaitFrame(session_, &wait, &state), "waiting for the headset")) return std::nullopt;
    XrFrameBeginInfo begin{XR_TYPE_FRAME_BEGIN_INFO};
    if (!still_there(xrBeginFrame(session_, &begin), "beginning a frame")) return std::nullopt;

    OpenXrFrame frame;
    frame.should_render = state.shouldRender == XR_TRUE;
    frame.predicted = {state.predictedDisplayTime};
    frame.period = {state.predictedDisplayPeriod};
    if (frame.period.ns > 0) period_ = frame.period;
    const HostTime now = clock_.now();
    frame.checked = display_times_.check(frame.predicted, frame.period,
                                         instance_.device_from_host(now).value_or(frame.predicted));
    frame.display_time = instance_.host_from_device(frame.checked.time).value_or(now);
    frame.display_time_error = instance_.conversion_error(now);
    frame.views = locate_views(frame.checked.time.ns);
    return frame;
}

// Where the head is not tracked, or the session is lost, the views are absent.
std::vector<XrView> OpenXrSession::locate_views(XrTime time) {
    XrViewLocateInfo locate{XR_TYPE_VIEW_LOCATE_INFO};
    locate.viewConfigurationType = instance_.view_configuration();
    locate.displayTime = time;
    locate.space = picture_frame_ == PictureFrame::head ? head_ : room_;
    XrViewState state{XR_TYPE_VIEW_STATE};
    std::uint32_t count = static_cast<std::uint32_t>(swapchains_.size());
    std::vector<XrView> views(count, XrView{XR_TYPE_VIEW});
    if (!still_there(xrLocateViews(session_, &locate, &state, count, &count, views.data()),
                     "finding where the eyes are"))
        return {};
    constexpr XrViewStateFlags kNeeded =
        XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;
    if ((state.viewStateFlags & kNeeded) != kNeeded) return {};
    return views;
}

std::optional<VkImage> OpenXrSession::acquire_image(std::size_t view) {
    Swapchain& swapchain = swapchains_[view];
    XrSwapchainImageAcquireInfo acquire{XR_TYPE_SWAPCHAIN_IMAGE_ACQUIRE_INFO};
    std::uint32_t index = 0;
    if (!still_there(xrAcquireSwapchainImage(swapchain.handle, &acquire, &index),
                     "getting a picture to draw on"))
        return std::nullopt;
    XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO};
    wait.timeout = XR_INFINITE_DURATION;
    if (!still_there(xrWaitSwapchainImage(swapchain.handle, &wait), "getting a picture to draw on"))
        return std::nullopt;
    return swapchain.images[index];
}

void OpenXrSession::release_image(std::size_t view) {
    XrSwapchainImageReleaseInfo release{XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO};
    still_there(xrReleaseSwapchainImage(swapchains_[view].handle, &release), "handing over a picture");
}

void OpenXrSession::end_frame(const OpenXrFrame& frame, bool show_images) {
    if (state_ == SessionState::lost) return;
    std::vector<XrCompositionLayerProjectionView> views;
    if (show_images) {
        for (std::size_t i = 0; i < frame.views.size(); ++i) {
            XrCompositionLayerProjectionView view{XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW};
            view.pose = frame.views[i].pose;
            view.fov = frame.views[i].fov;
            view.subImage.swapchain = swapchains_[i].handle;
            view.subImage.imageRect.extent = {swapchains_[i].size.width, swapchains_[i].size.height};
            views.push_back(view);
        }
    }
    XrCompositionLayerProjection layer{XR_TYPE_COMPOSITION_LAYER_PROJECTION};
    layer.space = picture_frame_ == PictureFrame::head ? head_ : room_;
    layer.viewCount = static_cast<std::uint32_t>(views.size());
    layer.views = views.data();
    const auto* const layers = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer);
    XrFrameEndInfo end{XR_TYPE_FRAME_END_INFO};
    end.displayTime = frame.checked.time.ns;
    end.environmentBlendMode = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
    end.layerCount = views.empty() ? 0 : 1;
    end.layers = views.empty() ? nullptr : &layers;
    still_there(xrEndFrame(session_, &end), "showing a frame");
}

bool OpenXrSession::recentre() {
    const std::optional<DeviceTime> now = instance_.device_from_host(clock_.now());
    XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
    const XrSpace origin = make_space(XR_REFERENCE_SPACE_TYPE_LOCAL, kIdentity);
    const bool there =
        now && still_there(xrLocateSpace(head_, origin, now->ns, &location), "finding where the head is");
    xrDestroySpace(origin);
    constexpr XrSpaceLocationFlags kNeeded =
        XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
    if (!there || (location.locationFlags & kNeeded) != kNeeded) return false;

    // Only the turn about the vertical: the room's floor stays level.
    const XrQuaternionf& q = location.pose.orientation;
    const float ahead_x = -2 * (q.x * q.z + q.w * q.y);
    const float ahead_z = 2 * (q.x * q.x + q.y * q.y) - 1;
    const float yaw = std::atan2(-ahead_x, -ahead_z);
    const XrPosef level{{0, std::sin(yaw / 2), 0, std::cos(yaw / 2)}, location.pose.position};
    const XrSpace turned = make_space(XR_REFERENCE_SPACE_TYPE_LOCAL, level);
    xrDestroySpace(room_);
    room_ = turned;
    return true;
}

void OpenXrSession::request_exit() {
    if (running_) still_there(xrRequestExitSession(session_), "ending the session");
}

std::optional<double> OpenXrSession::refresh_hz() const {
    if (instance_.offers(XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME)) {
        const auto get = instance_.function<PFN_xrGetDisplayRefreshRateFB>("xrGetDisplayRefreshRateFB");
        float hz = 0;
        if (XR_SUCCEEDED(get(session_, &hz)) && hz > 0) return hz;
    }
    if (!period_) return std::nullopt;
    return 1 / period_->seconds();
}

std::vector<double> OpenXrSession::refresh_rates() const {
    if (!instance_.offers(XR_FB_DISPLAY_REFRESH_RATE_EXTENSION_NAME)) return {};
    const auto list =
        instance_.function<PFN_xrEnumerateDisplayRefreshRatesFB>("xrEnumerateDisplayRefreshRatesFB");
    std::uint32_t count = 0;
    check_openxr(list(session_, 0, &count, nullptr), "asking for refresh rates");
    std::vector<float> rates(count);
    check_openxr(list(session_, count, &count, rates.data()), "asking for refresh rates");
    return {rates.begin(), rates.end()};
}

void OpenXrSession::request_refresh_rate(double hz) {
    const auto request =
        instance_.function<PFN_xrRequestDisplayRefreshRateFB>("xrRequestDisplayRefreshRateFB");
    check_openxr(request(session_, static_cast<float>(hz)), "asking for another refresh rate");
}

std::vector<XrVector2f> OpenXrSession::hidden_triangles(std::size_t view) const {
    if (!instance_.offers(XR_KHR_VISIBILITY_MASK_EXTENSION_NAME)) return {};
    const auto get = instance_.function<PFN_xrGetVisibilityMaskKHR>("xrGetVisibilityMaskKHR");
    const auto ask = [&](XrVisibilityMaskKHR& mask) {
        check_openxr(get(session_, instance_.view_configuration(), static_cast<std::uint32_t>(view),
                         XR_VISIBILITY_MASK_TYPE_HIDDEN_TRIANGLE_MESH_KHR, &mask),
                     "asking what the lenses hide");
    };
    XrVisibilityMaskKHR mask{XR_TYPE_VISIBILITY_MASK_KHR};
    ask(mask);
    std::vector<XrVector2f> vertices(mask.vertexCountOutput);
    std::vector<std::uint32_t> indices(mask.indexCountOutput);
    if (indices.empty()) return {};
    mask.vertexCapacityInput = mask.vertexCountOutput;
    mask.vertices = vertices.data();
    mask.indexCapacityInput = mask.indexCountOutput;
    mask.indices = indices.data();
    ask(mask);
    std::vector<XrVector2f> corners;
    for (const std::uint32_t index : indices) corners.push_back(vertices.at(index));
    return corners;
}

GazeReading OpenXrSession::read_gaze(DeviceTime asked) {
    const std::lock_guard lock(handles_);
    if (session_ == XR_NULL_HANDLE) return {GazeActivity::absent, asked, std::nullopt, {0, 0, 0, 1}};
    return gaze_input_.read(session_, head_, asked);
}

}  // namespace parafovea
