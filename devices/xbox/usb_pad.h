// Wired Xbox pads read raw through libusb, past the kernel's driver.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/arrival_ring.h"
#include "devices/clock.h"
#include "devices/controller_source.h"
#include "devices/xbox/xbox_report.h"

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
// endpoint's polling interval. Reads in its own thread; looks for the pad again when it was unplugged, and
// reports connected and disconnected. The first report of an Xbox One pad after power-up may be spurious and
// only tells where its buttons are.
class UsbPad final : public ControllerSource {
  public:
    // Throws std::runtime_error, saying what to do, if there is no pad or it may not be opened.
    explicit UsbPad(Clock& clock, Duration search_interval = Duration::from_ms(300));
    ~UsbPad() override;

    void drain(std::vector<ControllerEvent>& events) override { ring_.drain(events); }
    std::string description() const override { return description_; }

    bool connected() const { return connected_; }

  private:
    struct Context;
    struct Device;

    void run(std::stop_token stop);
    std::unique_ptr<Device> open();
    void handle(Device& device, std::span<const std::uint8_t> transfer, HostTime arrival);

    Clock& clock_;
    Duration search_interval_;
    std::string description_;
    ArrivalRing<ControllerEvent, 1 << 12> ring_;
    std::atomic<bool> connected_ = false;
    std::unique_ptr<Context> context_;
    std::unique_ptr<Device> device_;
    std::jthread thread_;  // last: ends before the rest goes
};

}  // namespace parafovea
