// Pads that the Linux kernel drives, read as input events with the kernel's own time stamps.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/arrival_ring.h"
#include "devices/clock.h"
#include "devices/controller_source.h"
#include "devices/xbox/evdev_decoder.h"

namespace parafovea {

struct FoundPad {
    std::string path;  // "/dev/input/event7"
    std::string name;
    std::uint16_t vendor = 0, product = 0, bus = 0;  // zero where it may not be opened
    bool readable = false;
};

// Every pad among the input devices: something with the buttons A and B. Devices that may not be opened are
// known to be pads only by the name that udev gave them ("...-event-joystick").
std::vector<FoundPad> list_evdev_pads();

// Times are the kernel's at the moment the USB or Bluetooth packet was handled, on CLOCK_MONOTONIC,
// uncorrected; their error is the pad's polling interval. Reads in its own thread; looks for the pad again
// when it was unplugged, and reports connected and disconnected. Buttons held when it goes are not reported
// as released.
class EvdevController final : public ControllerSource {
  public:
    // Throws std::runtime_error, saying what to do, if there is no pad or it may not be read. The clock must
    // be on CLOCK_MONOTONIC, outlive the controller and allow calls from two threads.
    explicit EvdevController(Clock& clock, Duration search_interval = Duration::from_ms(300));
    ~EvdevController() override;

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
