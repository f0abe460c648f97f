// The eye tracker of an OpenXR headset as a gaze source.
#pragma once

#include <atomic>
#include <exception>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "devices/arrival_ring.h"
#include "devices/gaze_source.h"
#include "devices/openxr/openxr_session.h"

namespace parafovea {

// OpenXR gives one pose a look and keeps no queue, so the tracker is looked at twice as often as the fastest
// known one sees, for the moment of the look: nothing is extrapolated. Looks that show nothing new are no
// samples.
//
// device_time is the raw XrTime of XrEyeGazeSampleTimeEXT, host_time the same through the runtime's clock
// conversion. Where the runtime gives no sample time (zero, or the time asked for), device_time is the time
// asked for, host_time lies half way between this look and the one before, and the error is half of that
// span; the tracker's own latency is not known then and not in it. No eye, no tracker and no input focus are
// lost samples, one every eight milliseconds at most unless they have times. There is no per-eye data.
class OpenXrGaze final : public GazeSource {
  public:
    enum class Looks {
        own_thread,  // every four milliseconds of real time
        at_drain,    // at drain(), also for the moments since the last sample: for a clock that stands still
    };

    // Throws one line if the headset has no eye tracker. The session must outlive it.
    explicit OpenXrGaze(OpenXrSession& session, Looks looks = Looks::own_thread);
    ~OpenXrGaze() override = default;

    // Throws what made the thread end, if the runtime failed.
    void drain(std::vector<GazeSample>& samples) override;
    std::string description() const override;

    // Samples that were lost because nobody drained for half a minute.
    std::int64_t overflowed() const { return ring_.overflowed(); }

  private:
    void look();
    void look_at(DeviceTime asked, HostTime now);
    void push(GazeStatus status, const GazeReading& reading, HostTime now);

    OpenXrSession& session_;
    Looks looks_;
    ArrivalRing<GazeSample, 4096> ring_;
    std::int64_t next_sequence_ = 0;
    std::optional<DeviceTime> last_sample_time_;
    std::optional<XrQuaternionf> last_orientation_;
    std::optional<HostTime> last_look_, last_pushed_;
    std::exception_ptr failure_;  // of the thread, once failed_ is set
    std::atomic<bool> failed_ = false;
    std::jthread thread_;  // last: it uses all the others
};

}  // namespace parafovea
