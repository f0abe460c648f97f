// The thread that waits for FOVE's eye frames.
#include "devices/fove/fove_gaze.h"

#include <chrono>
#include <stdexcept>

#include "devices/unit_vector.h"

namespace parafovea {
namespace {

// The layout of the library's structs is only known for this one.
constexpr int kKnownMajor = 1;

// FOVE's calibration states in their order: 0 not started, 1 to 4 under way, 5 to 7 successful, from 8 on
// failed.
FoveCalibration calibration_of(int state) {
    if (state <= 0) return FoveCalibration::not_started;
    if (state <= 4) return FoveCalibration::running;
    return state <= 7 ? FoveCalibration::succeeded : FoveCalibration::failed;
}

DirectionDeg direction(fove::Vec3 v) {
    return direction_of(Vector3{v.x, v.y, v.z});
}

}  // namespace

FoveGaze::FoveGaze(Clock& clock, const FoveGazeSettings& settings)
    : clock_(clock),
      settings_(settings),
      library_(settings.library),
      mapping_({.least_latency = settings.latency,
                .least_latency_error = settings.latency_error,
                .resolution = {1000}}) {
    if (library_.create_headset(fove::kEyeTracking | fove::kPupilRadius, &headset_) != fove::kNone ||
        !headset_)
        throw std::runtime_error("FOVE's client library cannot make a headset; start the FOVE service");
    fove::Versions versions{};
    const int error = library_.query_software_versions(headset_, &versions);
    std::string problem;
    if (error != fove::kNone)
        problem =
            "the FOVE service does not answer (error " + std::to_string(error) + "); start the FOVE service";
    else if (versions.client_major != kKnownMajor)
        problem = "FOVE's client library is version " + std::to_string(versions.client_major) + "." +
                  std::to_string(versions.client_minor) +
                  "; only version 1 is known, install FOVE software 1.4";
    else if (versions.too_old_headset_connected)
        problem = "the headset's firmware is too old for the FOVE software; update it with FOVE's tools";
    if (!problem.empty()) {
        library_.destroy(headset_);
        throw std::runtime_error(problem);
    }
    description_ = "FOVE, client " + std::to_string(versions.client_major) + "." +
                   std::to_string(versions.client_minor) + "." + std::to_string(versions.client_build) +
                   ", service " + std::to_string(versions.runtime_major) + "." +
                   std::to_string(versions.runtime_minor) + "." + std::to_string(versions.runtime_build) +
                   ", firmware " + std::to_string(versions.firmware) + ", raw gaze";
    thread_ = std::jthread([this](std::stop_token stop) { run(stop); });
}

FoveGaze::~FoveGaze() {
    thread_ = {};
    library_.destroy(headset_);
}

void FoveGaze::run(std::stop_token stop) {
    while (!stop.stop_requested()) {
        if (calibration_asked_.exchange(false)) {
            const fove::CalibrationOptions options{};
            library_.start_eye_tracking_calibration(headset_, &options);
        }
        const int waited = library_.wait_for_processed_eye_frame(headset_);
        const HostTime arrival = clock_.now();
        if (waited == fove::kApiTimeout) continue;
        fove::FrameTimestamp frame{};
        if (waited != fove::kNone || library_.fetch_eye_tracking_data(headset_, &frame) != fove::kNone) {
            // The headset or its service is away: ask again, but not in a tight loop.
            connected_ = false;
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            continue;
        }
        connected_ = true;
        int state = 0;
        if (library_.get_eye_tracking_calibration_state(headset_, &state) == fove::kNone)
            calibration_ = calibration_of(state);
        if (last_id_ && frame.id == *last_id_) continue;
        last_id_ = frame.id;
        publish(frame, arrival);
    }
}

void FoveGaze::publish(const fove::FrameTimestamp& frame, HostTime arrival) {
    GazeSample sample;
    sample.sequence = static_cast<std::int64_t>(frame.id);
    sample.device_time = {static_cast<std::int64_t>(frame.timestamp_us * 1000)};
    sample.arrival_time = arrival;
    const MappedTime mapped = mapping_.map(sample.device_time, arrival);
    sample.host_time = mapped.time;
    sample.host_time_error = mapped.error;
    sample.left = read_eye(fove::kLeft);
    sample.right = read_eye(fove::kRight);

    fove::Ray ray{};
    const int error = library_.get_combined_gaze_ray(headset_, &ray);
    int left = fove::kNotDetected, right = fove::kNotDetected;
    library_.get_eye_state(headset_, fove::kLeft, &left);
    library_.get_eye_state(headset_, fove::kRight, &right);
    if (left == fove::kClosed && right == fove::kClosed) {
        sample.status = GazeStatus::blink;
        sample.left->direction.reset();
        sample.right->direction.reset();
    } else if (error == fove::kNone || error == fove::kDataLowAccuracy) {
        sample.status = error == fove::kNone ? GazeStatus::tracked : GazeStatus::low_accuracy;
        sample.direction = direction(ray.direction);
    } else {
        sample.status = GazeStatus::lost;
    }
    ring_.push(sample);
}

EyeSample FoveGaze::read_eye(int eye) {
    EyeSample sample;
    fove::Vec3 vector{};
    const int error = library_.get_gaze_vector_raw(headset_, eye, &vector);
    if (error == fove::kNone || error == fove::kDataLowAccuracy) sample.direction = direction(vector);
    float radius_m = 0;
    if (library_.get_pupil_radius(headset_, eye, &radius_m) == fove::kNone && radius_m > 0)
        sample.pupil_mm = 2000.0 * radius_m;
    return sample;
}

}  // namespace parafovea
