// A session on an OpenXR headset: its states, its frame loop, its pictures and its gaze.
#pragma once

#include <mutex>
#include <optional>
#include <string_view>
#include <vector>

#include "devices/clock.h"
#include "devices/openxr/display_time_check.h"
#include "devices/openxr/openxr_gaze_input.h"
#include "devices/openxr/openxr_instance.h"

namespace parafovea {

// The Vulkan device that pictures are drawn on; made through the instance.
struct OpenXrVulkan {
    VkInstance instance = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    std::uint32_t queue_family = 0;
};

// head: pictures stay before the eyes, however the head turns; every participant sees the same.
// room: pictures are of a place in the room, and the head looks around in it.
enum class PictureFrame { head, room };

enum class SessionState { starting, synchronized, visible, focused, stopping, stopped, exiting, lost };

std::string_view name_of(SessionState state);

// One turn of the frame loop.
struct OpenXrFrame {
    bool should_render = false;  // false: whatever is drawn will not be seen
    DeviceTime predicted;        // as the runtime said it
    CheckedDisplayTime checked;
    HostTime display_time;        // the checked time on the host's clock
    Duration display_time_error;  // half-width of the mapping's uncertainty
    Duration period;              // as the runtime said it
    std::vector<XrView> views;    // poses in the picture frame: the head, or the recentred room
};

// Not thread safe but for read_gaze(), which any thread may call. Everything that is borrowed must outlive
// it.
class OpenXrSession {
  public:
    // Pictures are 8-bit sRGB. Throws one line if the runtime fails.
    OpenXrSession(const OpenXrInstance& instance, const OpenXrVulkan& vulkan, Clock& clock,
                  PictureFrame picture_frame = PictureFrame::head);
    ~OpenXrSession();
    OpenXrSession(const OpenXrSession&) = delete;
    OpenXrSession& operator=(const OpenXrSession&) = delete;

    // Follows the runtime's events: begins when it is ready, ends when it is stopping. begin_frame() does
    // this too.
    SessionState update();
    SessionState state() const { return state_; }

    // The next turn, or nothing while the session is not running (stopped, exiting or lost). Waits for it.
    std::optional<OpenXrFrame> begin_frame();

    // Between begin_frame() and end_frame(): the image to draw a view on, in the layout
    // VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL before and after. Nothing if the session is lost meanwhile.
    std::optional<VkImage> acquire_image(std::size_t view);
    void release_image(std::size_t view);
    VkFormat image_format() const { return format_; }

    // Shows the images released in this turn, or black.
    void end_frame(const OpenXrFrame& frame, bool show_images);

    // Makes a new session after a loss, with everything as it was. False while the runtime has no headset.
    bool restart();
    int restarts() const { return restarts_; }

    // How often the headset was ready to show our frames: once, and again each time it was put on.
    int beginnings() const { return beginnings_; }

    // Turns the room so that straight ahead is where the head looks now, and its origin is where the head is.
    // Without effect on pictures in the head's frame. False while the head is not tracked.
    bool recentre();

    // How often the user has recentred through the runtime: straight ahead in the room is another way now.
    int recentrings() const { return recentrings_; }

    // Asks the runtime to end the session; begin_frame() goes on until it has.
    void request_exit();

    // Refreshes per second: as the runtime says (XR_FB_display_refresh_rate), or as its frames' period says,
    // or nothing before the first frame.
    std::optional<double> refresh_hz() const;
    std::vector<double> refresh_rates() const;  // that can be asked for; empty: none
    void request_refresh_rate(double hz);       // one of those

    // The part of a view that the lenses hide: triangles on the plane one unit ahead of the eye, three
    // vertices each. Empty where the runtime does not say.
    std::vector<XrVector2f> hidden_triangles(std::size_t view) const;

    // Asks the eye tracker for the gaze at a time, relative to the head.
    GazeReading read_gaze(DeviceTime asked);

    const OpenXrInstance& instance() const { return instance_; }
    Clock& clock() const { return clock_; }

  private:
    struct Swapchain {
        XrSwapchain handle = XR_NULL_HANDLE;
        SizePx size;
        std::vector<VkImage> images;
    };

    void create();
    void destroy();
    void create_swapchains();
    void choose_format();
    XrSpace make_space(XrReferenceSpaceType type, const XrPosef& pose);
    void follow(const XrEventDataSessionStateChanged& change);
    bool still_there(XrResult result, const char* doing);
    std::vector<XrView> locate_views(XrTime time);

    const OpenXrInstance& instance_;
    OpenXrVulkan vulkan_;
    Clock& clock_;
    PictureFrame picture_frame_;
    OpenXrGazeInput gaze_input_;
    std::mutex handles_;  // held to read the gaze, and to replace what it is read with
    XrSession session_ = XR_NULL_HANDLE;
    XrSpace head_ = XR_NULL_HANDLE, room_ = XR_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    std::vector<Swapchain> swapchains_;
    SessionState state_ = SessionState::starting;
    bool running_ = false;
    int restarts_ = 0, beginnings_ = 0, recentrings_ = 0;
    DisplayTimeCheck display_times_;
    std::optional<Duration> period_;
};

}  // namespace parafovea
