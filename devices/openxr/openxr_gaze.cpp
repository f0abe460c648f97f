// Looks at an OpenXR eye tracker and tells what is new.
#include "devices/openxr/openxr_gaze.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "devices/unit_vector.h"

namespace parafovea {

namespace {

constexpr Duration kLookEvery{4'000'000};
constexpr Duration kSilence{8'000'000};   // between lost samples without times
constexpr Duration kHistory{50'000'000};  // that every runtime keeps

// Where -z points, as the display's view has it: z forward.
DirectionDeg direction_from(const XrQuaternionf& q) {
    return direction_of(
        {-2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.w * q.x - q.y * q.z), 1.0 - 2.0 * (q.x * q.x + q.y * q.y)});
}

bool same(const XrQuaternionf& a, const XrQuaternionf& b) {
    return a.x == b.x && a.y == b.y && a.z == b.z && a.w == b.w;
}

}  // namespace

OpenXrGaze::OpenXrGaze(OpenXrSession& session, Looks looks) : session_(session), looks_(looks) {
    if (!session.instance().has_eye_tracker())
        throw std::runtime_error("the OpenXR runtime " + session.instance().runtime_name() +
                                 " offers no eye tracker of " + session.instance().headset_name() +
                                 "; switch eye tracking on in the runtime, or choose another gaze source");
    if (looks_ == Looks::at_drain) return;
    thread_ = std::jthread([this](const std::stop_token& stop) {
        try {
            auto next = std::chrono::steady_clock::now();
            while (!stop.stop_requested()) {
                look();
                next = std::max(next + std::chrono::nanoseconds(kLookEvery.ns),
                                std::chrono::steady_clock::now());
                std::this_thread::sleep_until(next);
            }
        } catch (...) {
            failure_ = std::current_exception();
            failed_.store(true, std::memory_order_release);
        }
    });
}

void OpenXrGaze::drain(std::vector<GazeSample>& samples) {
    if (looks_ == Looks::at_drain) look();
    ring_.drain(samples);
    if (failed_.load(std::memory_order_acquire)) std::rethrow_exception(failure_);
}

std::string OpenXrGaze::description() const {
    return "OpenXR eye tracker of " + session_.instance().headset_name() + ", " +
           session_.instance().runtime_name();
}

void OpenXrGaze::look() {
    const HostTime now = session_.clock().now();
    if (last_look_ && now <= *last_look_) return;
    const std::optional<DeviceTime> asked = session_.instance().device_from_host(now);
    if (!asked) return;
    if (looks_ == Looks::at_drain && last_sample_time_) {
        const DeviceTime oldest{asked->ns - kHistory.ns};
        for (DeviceTime past = std::max(*last_sample_time_, oldest) + kLookEvery; past < *asked;
             past = past + kLookEvery)
            look_at(past, now);
    }
    look_at(*asked, now);
    last_look_ = now;
}

void OpenXrGaze::look_at(DeviceTime asked, HostTime now) {
    const GazeReading reading = session_.read_gaze(asked);
    if (reading.sample_time) {
        if (last_sample_time_ && *reading.sample_time <= *last_sample_time_) return;
        last_sample_time_ = reading.sample_time;
    }
    if (reading.activity == GazeActivity::absent || reading.activity == GazeActivity::no_eye) {
        const bool soon = last_pushed_ && now - *last_pushed_ < kSilence;
        if (!reading.sample_time && soon) return;
        last_orientation_.reset();
        push(GazeStatus::lost, reading, now);
        return;
    }
    if (!reading.sample_time && last_orientation_ && same(*last_orientation_, reading.orientation)) return;
    last_orientation_ = reading.orientation;
    push(reading.activity == GazeActivity::tracked ? GazeStatus::tracked : GazeStatus::low_accuracy, reading,
         now);
}

void OpenXrGaze::push(GazeStatus status, const GazeReading& reading, HostTime now) {
    GazeSample sample;
    sample.sequence = next_sequence_++;
    sample.device_time = reading.sample_time.value_or(reading.asked);
    sample.arrival_time = now;
    sample.host_time_error = session_.instance().conversion_error(now);
    const std::optional<HostTime> mapped =
        reading.sample_time ? session_.instance().host_from_device(*reading.sample_time) : std::nullopt;
    if (mapped) {
        sample.host_time = *mapped;
    } else {
        const Duration since = last_look_ ? now - *last_look_ : kLookEvery;
        sample.host_time = now - Duration{since.ns / 2};
        sample.host_time_error = {sample.host_time_error.ns + since.ns / 2};
    }
    sample.status = status;
    if (status != GazeStatus::lost) sample.direction = direction_from(reading.orientation);
    ring_.push(sample);
    last_pushed_ = now;
}

}  // namespace parafovea
