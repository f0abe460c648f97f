// Pads that the Linux kernel drives, read as input events with the kernel's own time stamps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "devices/xbox/pad_thread.h"

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
// uncorrected; their error is the pad's polling interval.
class EvdevController final : public PadThread {
  public:
    // Throws std::runtime_error, saying what to do, if there is no pad or it may not be read. The clock must
    // be on CLOCK_MONOTONIC.
    explicit EvdevController(Clock& clock, Duration search_interval = Duration::from_ms(300));
};

}  // namespace parafovea
