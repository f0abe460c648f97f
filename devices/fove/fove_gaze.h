// The FOVE headset's eye tracker, through FOVE's client library.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "devices/arrival_ring.h"
#include "devices/clock.h"
#include "devices/clock_mapping.h"
#include "devices/fove/fove_api.h"
#include "devices/gaze_source.h"

namespace parafovea {

struct FoveGazeSettings {
    std::string library = "libFoveClient.so";
    // Exposure, USB and processing: about 8 + 8 + 4 ms (FOVE's support pages); 15 to 52 ms were measured over
    // several headsets, the FOVE 0 being the fastest (Stein et al. 2021).
    Duration latency = Duration::from_ms(20);
    Duration latency_error = Duration::from_ms(8);
};

enum class FoveCalibration { not_started, running, succeeded, failed };

// Raw gaze vectors, as FOVE recommends for recording. Sequence numbers are the camera's frame numbers. Reads
// in a thread of its own and goes on when the headset comes back. The clock must outlive it and allow calls
// from two threads.
class FoveGaze final : public GazeSource {
  public:
    // Throws std::runtime_error, saying what to do, if the library is not installed, is of an unknown major
    // version, or its service does not run.
    explicit FoveGaze(Clock& clock, const FoveGazeSettings& settings = {});
    ~FoveGaze() override;

    void drain(std::vector<GazeSample>& samples) override { ring_.drain(samples); }
    std::string description() const override { return description_; }

    bool connected() const { return connected_; }

    // Asks the headset to run its own calibration; progress is seen from calibration() as it goes.
    void start_calibration() { calibration_asked_ = true; }
    FoveCalibration calibration() const { return calibration_; }

  private:
    void run(std::stop_token stop);
    void publish(const fove::FrameTimestamp& frame, HostTime arrival);
    EyeSample read_eye(int eye);

    Clock& clock_;
    FoveGazeSettings settings_;
    FoveLibrary library_;
    fove::Headset* headset_ = nullptr;
    std::string description_;
    ClockMapping mapping_;
    std::optional<std::uint64_t> last_id_;
    ArrivalRing<GazeSample, 1 << 14> ring_;
    std::atomic<bool> connected_ = false, calibration_asked_ = false;
    std::atomic<FoveCalibration> calibration_ = FoveCalibration::not_started;
    std::jthread thread_;  // last: ends before the rest goes
};

}  // namespace parafovea
