// Xbox One and Series pads over Bluetooth, read through hidapi.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "devices/xbox/pad_thread.h"

namespace parafovea {

struct FoundBluetoothPad {
    std::string path;  // "/dev/hidraw0"
    std::uint16_t product = 0;
    bool readable = false;
};

// Every Xbox pad that Bluetooth makes a HID device of.
std::vector<FoundBluetoothPad> list_bluetooth_pads();

// Times are the host's right after the report was read, uncorrected; their error is 15 ms, the longest usual
// interval between reports.
class BluetoothPad final : public PadThread {
  public:
    // Throws std::runtime_error, saying what to do, if there is no pad or it may not be opened.
    explicit BluetoothPad(Clock& clock, Duration search_interval = Duration::from_ms(300));
};

}  // namespace parafovea
