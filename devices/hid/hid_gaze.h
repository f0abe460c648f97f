// Eye trackers that speak HID usage page 0x12, through hidapi on Linux hidraw.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/arrival_ring.h"
#include "devices/clock.h"
#include "devices/clock_mapping.h"
#include "devices/gaze_source.h"
#include "devices/hid/eye_tracker_report.h"

namespace parafovea {

struct FoundHidDevice {
    std::string path;  // "/dev/hidraw0"
    std::string name;
    std::uint16_t vendor = 0, product = 0;
    bool readable = false;  // by this user; else a udev rule is missing
};

// Every HID eye tracker of this machine.
std::vector<FoundHidDevice> list_hid_eye_trackers();

struct HidGazeSettings {
    // From exposure to arrival; HID cannot tell. The default covers published trackers (15 to 52 ms, Stein et
    // al. 2021) only by its error, which becomes part of every sample's.
    Duration latency = Duration::from_ms(15);
    Duration latency_error = Duration::from_ms(15);
    double screen_distance_m = kVirtualScreenDistance_m;
    Duration search_interval = Duration::from_ms(300);  // how often an unplugged tracker is looked for
};

// Reads in a thread of its own and looks for the tracker again when it was unplugged; a replugged one is the
// same one to the reader, its sequence numbers go on and its clock is mapped anew. The clock must outlive it
// and allow calls from two threads.
class HidGaze final : public GazeSource {
  public:
    // Throws std::runtime_error, saying what to do, if no tracker is there or it may not be read.
    explicit HidGaze(Clock& clock, const HidGazeSettings& settings = {});
    ~HidGaze() override;

    void drain(std::vector<GazeSample>& samples) override { ring_.drain(samples); }
    std::string description() const override { return description_; }

    bool connected() const { return connected_; }

  private:
    struct Device;

    void run(std::stop_token stop);
    std::unique_ptr<Device> open();
    void handle(Device& device, std::span<const std::uint8_t> report, HostTime arrival);

    Clock& clock_;
    HidGazeSettings settings_;
    std::string description_;
    ClockMapping mapping_;
    std::optional<DeviceTime> last_device_time_;
    std::int64_t sequence_ = 0;
    ArrivalRing<GazeSample, 1 << 14> ring_;
    std::atomic<bool> connected_ = false;
    std::unique_ptr<Device> device_;
    std::jthread thread_;  // last: ends before the rest goes
};

}  // namespace parafovea
