// Xbox One and Series pads over Bluetooth, read through hidapi.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/arrival_ring.h"
#include "devices/clock.h"
#include "devices/controller_source.h"
#include "devices/xbox/pad_state.h"

namespace parafovea {

struct FoundBluetoothPad {
    std::string path;  // "/dev/hidraw0"
    std::uint16_t product = 0;
    bool readable = false;
};

// Every Xbox pad that Bluetooth makes a HID device of.
std::vector<FoundBluetoothPad> list_bluetooth_pads();

// Times are the host's right after the report was read, uncorrected; their error is 15 ms, the longest usual
// interval between reports. Reads in its own thread; looks for the pad again when it went away, and reports
// connected and disconnected.
class BluetoothPad final : public ControllerSource {
  public:
    // Throws std::runtime_error, saying what to do, if there is no pad or it may not be opened.
    explicit BluetoothPad(Clock& clock, Duration search_interval = Duration::from_ms(300));
    ~BluetoothPad() override;

    void drain(std::vector<ControllerEvent>& events) override { ring_.drain(events); }
    std::string description() const override { return description_; }

    bool connected() const { return connected_; }

  private:
    struct Device;

    void run(std::stop_token stop);
    std::unique_ptr<Device> open();

    Clock& clock_;
    Duration search_interval_;
    std::string description_;
    ArrivalRing<ControllerEvent, 1 << 12> ring_;
    std::atomic<bool> connected_ = false;
    std::unique_ptr<Device> device_;
    std::jthread thread_;  // last: ends before the rest goes
};

}  // namespace parafovea
