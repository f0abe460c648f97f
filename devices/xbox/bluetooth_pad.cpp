// The hidapi thread of an Xbox pad over Bluetooth.
#include "devices/xbox/bluetooth_pad.h"

#include <hidapi/hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <stdexcept>

#include "devices/xbox/xbox_report.h"

namespace parafovea {
namespace {

constexpr std::uint16_t kMicrosoft = 0x045e;
constexpr std::array<std::uint16_t, 7> kBluetoothProducts = {0x02e0, 0x02fd, 0x0b05, 0x0b13,
                                                             0x0b20, 0x0b21, 0x0b22};
constexpr Duration kInterval = {15'000'000};

class OpenBluetoothPad final : public OpenPad {
  public:
    OpenBluetoothPad(Clock& clock, hid_device* handle, std::uint16_t product)
        : clock_(clock), handle_(handle), product_(product) {}
    OpenBluetoothPad(const OpenBluetoothPad&) = delete;
    OpenBluetoothPad& operator=(const OpenBluetoothPad&) = delete;
    ~OpenBluetoothPad() override { hid_close(handle_); }

    bool read(std::vector<ControllerEvent>& events) override {
        std::array<std::uint8_t, 256> report;
        const int size = hid_read_timeout(handle_, report.data(), report.size(), kPadReadTimeout_ms);
        const HostTime arrival = clock_.now();
        if (size < 0) return false;
        const auto state =
            decode_xbox_bluetooth(std::span(report).first(static_cast<std::size_t>(size)), product_);
        if (!state) return true;
        append_changes(state_, *state, arrival, kInterval, events);
        state_ = *state;
        return true;
    }

    std::string description() const override {
        return "Xbox pad over Bluetooth through hidapi, stamped on arrival, reports at most 15 ms apart";
    }

  private:
    Clock& clock_;
    hid_device* handle_;
    std::uint16_t product_;
    PadState state_;
};

class BluetoothPadFinder final : public PadFinder {
  public:
    explicit BluetoothPadFinder(Clock& clock) : clock_(clock) {}

    std::unique_ptr<OpenPad> open() override {
        const auto found = list_bluetooth_pads();
        if (found.empty())
            throw std::runtime_error(
                "no Xbox pad is connected over Bluetooth; pair one, or see `parafovea devices`");
        hid_device* const handle = hid_open_path(found.front().path.c_str());
        if (!handle)
            throw std::runtime_error("the Xbox pad at " + found.front().path +
                                     " may not be opened; install the udev rules (see `parafovea devices`)");
        return std::make_unique<OpenBluetoothPad>(clock_, handle, found.front().product);
    }

  private:
    Clock& clock_;
};

}  // namespace

std::vector<FoundBluetoothPad> list_bluetooth_pads() {
    std::vector<FoundBluetoothPad> found;
    if (hid_init() != 0) return found;
    hid_device_info* const all = hid_enumerate(kMicrosoft, 0);
    for (const hid_device_info* info = all; info; info = info->next) {
        if (std::find(kBluetoothProducts.begin(), kBluetoothProducts.end(), info->product_id) ==
            kBluetoothProducts.end())
            continue;
        // A device appears once for each of its collections.
        const std::string path = info->path;
        if (std::any_of(found.begin(), found.end(),
                        [&](const FoundBluetoothPad& p) { return p.path == path; }))
            continue;
        found.push_back({path, info->product_id, access(info->path, R_OK | W_OK) == 0});
    }
    hid_free_enumeration(all);
    return found;
}

BluetoothPad::BluetoothPad(Clock& clock, Duration search_interval)
    : PadThread(clock, search_interval, std::make_unique<BluetoothPadFinder>(clock)) {}

}  // namespace parafovea
