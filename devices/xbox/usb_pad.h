// Wired Xbox pads read raw through libusb, past the kernel's driver.
#pragma once

#include <cstdint>
#include <vector>

#include "devices/xbox/pad_thread.h"

namespace parafovea {

enum class UsbPadKind { xbox360, gip };

struct FoundUsbPad {
    UsbPadKind kind = UsbPadKind::xbox360;
    std::uint16_t vendor = 0, product = 0;
    bool readable = false;  // by this user; else a udev rule is missing
};

// Every wired Xbox pad of this machine, told by its interface class, so that clones count too.
std::vector<FoundUsbPad> list_usb_pads();

// While it lives the pad is gone for the rest of the desktop; the kernel's driver is handed back when it
// ends, by whatever path. Times are the host's right after the transfer, uncorrected; their error is the
// endpoint's polling interval. The first report of an Xbox One pad after power-up may be spurious and
// only tells where its buttons are.
class UsbPad final : public PadThread {
  public:
    // Throws std::runtime_error, saying what to do, if there is no pad or it may not be opened.
    explicit UsbPad(Clock& clock, Duration search_interval = Duration::from_ms(300));
};

}  // namespace parafovea
