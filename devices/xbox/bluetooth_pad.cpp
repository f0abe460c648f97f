// The hidapi thread of an Xbox pad over Bluetooth.
#include "devices/xbox/bluetooth_pad.h"

#include <hidapi/hidapi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "devices/xbox/xbox_report.h"

namespace parafovea {
namespace {

constexpr std::uint16_t kMicrosoft = 0x045e;
constexpr std::array<std::uint16_t, 7> kBluetoothProducts = {0x02e0, 0x02fd, 0x0b05, 0x0b13,
                                                             0x0b20, 0x0b21, 0x0b22};
constexpr Duration kInterval = {15'000'000};
constexpr int kReadTimeout_ms = 50;

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

struct BluetoothPad::Device {
    Device(hid_device* h, std::uint16_t p) : handle(h), product(p) {}
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device() { hid_close(handle); }

    hid_device* handle;
    std::uint16_t product;
    PadState state;
};

BluetoothPad::BluetoothPad(Clock& clock, Duration search_interval)
    : clock_(clock), search_interval_(search_interval) {
    device_ = open();
    connected_ = true;
    thread_ = std::jthread([this](std::stop_token stop) { run(stop); });
}

BluetoothPad::~BluetoothPad() = default;

std::unique_ptr<BluetoothPad::Device> BluetoothPad::open() {
    const auto found = list_bluetooth_pads();
    if (found.empty())
        throw std::runtime_error(
            "no Xbox pad is connected over Bluetooth; pair one, or see `parafovea devices`");
    hid_device* const handle = hid_open_path(found.front().path.c_str());
    if (!handle)
        throw std::runtime_error("the Xbox pad at " + found.front().path +
                                 " may not be opened; install the udev rules (see `parafovea devices`)");
    if (description_.empty())
        description_ =
            "Xbox pad over Bluetooth through hidapi, stamped on arrival, reports at most 15 ms apart";
    return std::make_unique<Device>(handle, found.front().product);
}

void BluetoothPad::run(std::stop_token stop) {
    HostTime search_at = clock_.now();
    while (!stop.stop_requested()) {
        if (!device_) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            if (clock_.now() < search_at) continue;
            search_at = clock_.now() + search_interval_;
            try {
                device_ = open();
                connected_ = true;
                ring_.push({ControllerEventKind::connected, {}, clock_.now(), search_interval_});
            } catch (const std::runtime_error&) {
                // Still away: try again.
            }
            continue;
        }
        std::array<std::uint8_t, 256> report;
        const int size = hid_read_timeout(device_->handle, report.data(), report.size(), kReadTimeout_ms);
        const HostTime arrival = clock_.now();
        if (size < 0) {
            device_.reset();
            connected_ = false;
            ring_.push({ControllerEventKind::disconnected, {}, arrival, Duration::from_ms(kReadTimeout_ms)});
            search_at = arrival + search_interval_;
            continue;
        }
        const auto state =
            decode_xbox_bluetooth(std::span(report).first(static_cast<std::size_t>(size)), device_->product);
        if (!state) continue;
        std::vector<ControllerEvent> events;
        append_changes(device_->state, *state, arrival, kInterval, events);
        device_->state = *state;
        for (const ControllerEvent& event : events) ring_.push(event);
    }
}

}  // namespace parafovea
