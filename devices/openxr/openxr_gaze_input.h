// The eye tracker of an OpenXR session: XR_EXT_eye_gaze_interaction.
#pragma once

#include <optional>

#include "devices/openxr/openxr_instance.h"

namespace parafovea {

enum class GazeActivity {
    absent,    // no eye tracker, not permitted, or the application has not got the input
    no_eye,    // a tracker, but it sees no eye
    degraded,  // a direction below the tracker's usual quality
    tracked
};

// What one look at the eye tracker gave.
struct GazeReading {
    GazeActivity activity = GazeActivity::absent;
    DeviceTime asked;
    std::optional<DeviceTime> sample_time;  // absent where the runtime gave none, or only the asked one
    XrQuaternionf orientation{0, 0, 0, 1};  // of the gaze in the head's frame: it looks along -z
};

// The gaze action. Made once for an instance, then attached to each of its sessions in turn. Without an eye
// tracker every reading is absent.
class OpenXrGazeInput {
  public:
    explicit OpenXrGazeInput(const OpenXrInstance& instance);
    ~OpenXrGazeInput();
    OpenXrGazeInput(const OpenXrGazeInput&) = delete;
    OpenXrGazeInput& operator=(const OpenXrGazeInput&) = delete;

    void attach(XrSession session);

    // Before the session is destroyed.
    void detach();

    // Throws if the runtime fails in another way than losing the session.
    GazeReading read(XrSession session, XrSpace head, DeviceTime asked) const;

  private:
    const OpenXrInstance& instance_;
    XrActionSet actions_ = XR_NULL_HANDLE;
    XrAction action_ = XR_NULL_HANDLE;
    XrSpace gaze_ = XR_NULL_HANDLE;
};

}  // namespace parafovea
