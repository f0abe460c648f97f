// What eye trackers and controllers are here, and for what is not, the one line that says how to get it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace parafovea {

enum class Presence { here, no_permission, missing };

struct InventoryItem {
    std::string kind;    // "eye tracker" or "controller"
    std::string source;  // as the command line names it: hid, fove, gazepoint, evdev, hidapi, libusb,
                         // simulated, replay
    Presence presence = Presence::missing;
    std::string found;  // what was found; empty if missing
    std::string how;    // one line: how to get it or to be allowed to use it; empty if here
};

struct InventorySettings {
    std::string fove_library = "libFoveClient.so";
    std::string gazepoint_host = "127.0.0.1";
    std::uint16_t gazepoint_port = 4242;
};

// Looks, opens nothing for longer than it takes to look, changes nothing. One item at least for every source,
// in the order in which they are worth trying. Never throws.
std::vector<InventoryItem> take_inventory(const InventorySettings& settings = {});

// One line for an item, e.g. "eye tracker  hid        missing: connect ...".
std::string inventory_line(const InventoryItem& item);

// What the rules file devices/udev/70-parafovea.rules is called where it is installed.
constexpr std::string_view kUdevRules = "/etc/udev/rules.d/70-parafovea.rules";

}  // namespace parafovea
