// Gazepoint trackers over TCP, by the Open Gaze protocol.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "devices/arrival_ring.h"
#include "devices/clock.h"
#include "devices/clock_mapping.h"
#include "devices/gaze_source.h"
#include "devices/gazepoint/open_gaze_message.h"

namespace parafovea {

struct GazepointSettings {
    std::string host = "127.0.0.1";  // a numeric IPv4 address
    std::uint16_t port = 4242;
    // The screen under the tracker, its centre straight ahead; the default is a 24-inch one at arm's length.
    double screen_width_m = 0.531, screen_height_m = 0.299, screen_distance_m = 0.65;
    Duration latency = Duration::from_ms(25);  // exposure to arrival (guess: a frame and a half of 60 Hz)
    Duration latency_error = Duration::from_ms(20);
    Duration retry_interval = Duration::from_ms(500);  // after the connection broke
};

// Reads in a thread of its own; connects again when the connection breaks. The clock must outlive it and
// allow calls from two threads.
class GazepointGaze final : public GazeSource {
  public:
    // Throws std::runtime_error, saying what to do, if nothing answers at the address within two seconds.
    explicit GazepointGaze(Clock& clock, const GazepointSettings& settings = {});
    ~GazepointGaze() override;

    void drain(std::vector<GazeSample>& samples) override { ring_.drain(samples); }
    std::string description() const override;

    bool connected() const { return connected_; }

  private:
    // A connected socket with the data switched on, or -1.
    int connect_and_enable() const;
    void run(std::stop_token stop);
    void handle(const OpenGazeRecord& record, HostTime arrival);
    std::optional<DirectionDeg> direction(const std::optional<ScreenFraction>& point) const;

    Clock& clock_;
    GazepointSettings settings_;
    ClockMapping mapping_;
    std::int64_t sequence_ = 0;
    ArrivalRing<GazeSample, 1 << 14> ring_;
    std::atomic<bool> connected_ = false;
    int socket_ = -1;
    std::jthread thread_;  // last: ends before the rest goes
};

}  // namespace parafovea
