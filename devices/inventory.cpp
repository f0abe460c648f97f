// Asks every back end what it can see.
#include "devices/inventory.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>

#include "devices/fove/fove_api.h"
#include "devices/hid/hid_gaze.h"
#include "devices/xbox/bluetooth_pad.h"
#include "devices/xbox/evdev_controller.h"
#include "devices/xbox/usb_pad.h"

namespace parafovea {
namespace {

constexpr int kConnectTimeout_ms = 200;

std::string usb_id(std::uint16_t vendor, std::uint16_t product) {
    std::array<char, 16> text;
    std::snprintf(text.data(), text.size(), "%04x:%04x", vendor, product);
    return text.data();
}

std::string allow() {
    std::error_code error;
    if (std::filesystem::exists(kUdevRules, error))
        return "unplug it and plug it in again, so that the udev rules apply";
    return "sudo cp devices/udev/70-parafovea.rules /etc/udev/rules.d/ && sudo udevadm control --reload && "
           "sudo udevadm trigger";
}

// Adds an item for each device found, or one that says how to get any.
template <typename Found, typename Describe>
void add(std::vector<InventoryItem>& items, const char* kind, const char* source,
         const std::vector<Found>& found, const char* how, Describe describe) {
    for (const Found& device : found) {
        const bool ok = device.readable;
        items.push_back({kind, source, ok ? Presence::here : Presence::no_permission, describe(device),
                         ok ? "" : allow()});
    }
    if (found.empty()) items.push_back({kind, source, Presence::missing, "", how});
}

bool answers(const std::string& host, std::uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    if (inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1) return false;
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd < 0) return false;
    bool ok = ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    if (!ok && errno == EINPROGRESS) {
        pollfd ready{fd, POLLOUT, 0};
        int error = 0;
        socklen_t size = sizeof error;
        ok = poll(&ready, 1, kConnectTimeout_ms) == 1 &&
             getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0;
    }
    ::close(fd);
    return ok;
}

}  // namespace

std::vector<InventoryItem> take_inventory(const InventorySettings& settings) {
    std::vector<InventoryItem> items;
    add(items, "eye tracker", "hid", list_hid_eye_trackers(),
        "connect a tracker that speaks HID usage page 0x12; if it is connected, allow it by its vendor in "
        "70-parafovea.rules",
        [](const FoundHidDevice& d) { return d.path + " " + d.name + " " + usb_id(d.vendor, d.product); });

    const bool fove = fove_library_installed(settings.fove_library);
    items.push_back({"eye tracker", "fove", fove ? Presence::here : Presence::missing,
                     fove ? settings.fove_library : "",
                     fove ? ""
                          : "install FOVE's software 1.4 (fove-inc.com), which brings libFoveClient.so, and "
                            "start its service"});

    const std::string address = settings.gazepoint_host + ":" + std::to_string(settings.gazepoint_port);
    const bool gazepoint = answers(settings.gazepoint_host, settings.gazepoint_port);
    items.push_back({"eye tracker", "gazepoint", gazepoint ? Presence::here : Presence::missing,
                     gazepoint ? std::string("something answers at ") + address : "",
                     gazepoint ? "" : std::string("start Gazepoint Control; nothing answers at ") + address});
    items.push_back({"eye tracker", "simulated", Presence::here, "a FOVE-like tracker, 120 Hz", ""});
    items.push_back(
        {"eye tracker", "replay", Presence::here, "from a recording in CSV or TSV, or a session file", ""});

    add(items, "controller", "evdev", list_evdev_pads(),
        "plug in a pad; with kernel driver xpad it appears under /dev/input (modprobe xpad)",
        [](const FoundPad& p) {
            std::string text = p.path + " " + p.name;
            if (p.readable) text.append(" ").append(usb_id(p.vendor, p.product));
            return text;
        });
    add(items, "controller", "hidapi", list_bluetooth_pads(),
        "pair an Xbox pad: bluetoothctl scan on, then pair and trust it",
        [](const FoundBluetoothPad& p) { return p.path + " Xbox pad " + usb_id(0x045e, p.product); });
    add(items, "controller", "libusb", list_usb_pads(), "plug in an Xbox 360, One or Series pad by cable",
        [](const FoundUsbPad& p) {
            return std::string(p.kind == UsbPadKind::xbox360 ? "Xbox 360 pad " : "Xbox One pad ") +
                   usb_id(p.vendor, p.product);
        });
    items.push_back(
        {"controller", "simulated", Presence::here, "a pad pressed by a simulated participant", ""});
    return items;
}

std::string inventory_line(const InventoryItem& item) {
    std::string line = item.kind;
    line.resize(13, ' ');
    line += item.source;
    line.resize(24, ' ');
    switch (item.presence) {
        case Presence::here:
            return line + item.found;
        case Presence::no_permission:
            return line + item.found + " may not be used: " + item.how;
        case Presence::missing:
            return line + "missing: " + item.how;
    }
    return line;
}

}  // namespace parafovea
