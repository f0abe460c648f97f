// The one list of sources and their names.
#include "app/source_choice.h"

#include <charconv>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

#include "app/window_input.h"
#include "devices/fove/fove_gaze.h"
#include "devices/gaze_recording.h"
#include "devices/gazepoint/gazepoint_gaze.h"
#include "devices/hid/hid_gaze.h"
#include "devices/openxr/openxr_gaze.h"
#include "devices/replay_gaze.h"
#include "devices/xbox/bluetooth_pad.h"
#include "devices/xbox/evdev_controller.h"
#include "devices/xbox/usb_pad.h"

namespace parafovea {

namespace {

constexpr std::string_view kReplay = "replay:", kGazepoint = "gazepoint:";

GazepointSettings gazepoint_at(const std::string& name) {
    GazepointSettings settings;
    if (!name.starts_with(kGazepoint)) return settings;
    const std::string address = name.substr(kGazepoint.size());
    const std::size_t colon = address.rfind(':');
    const std::string port = colon == std::string::npos ? "" : address.substr(colon + 1);
    const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), settings.port);
    if (colon == 0 || port.empty() || error != std::errc() || end != port.data() + port.size())
        throw std::runtime_error("--gaze " + name +
                                 ": expected gazepoint:HOST:PORT, e.g. gazepoint:192.168.1.20:4242");
    settings.host = address.substr(0, colon);
    return settings;
}

template <typename Source>
auto owned(std::unique_ptr<Source> source) {
    using Seam = std::conditional_t<std::is_base_of_v<GazeSource, Source>, GazeSource, ControllerSource>;
    Seam* seam = source.get();
    return ChosenSource<Seam>{std::move(source), seam};
}

ChosenSource<ControllerSource> first_controller(const SourceParts& parts) {
    std::string reasons;
    for (const char* name : {"evdev", "hidapi", "libusb"}) {
        try {
            return choose_controller(name, parts);
        } catch (const std::runtime_error& reason) {
            reasons += std::string(reasons.empty() ? "" : "; ") + reason.what();
        }
    }
    if (parts.input) return {nullptr, &parts.input->keyboard()};
    throw std::runtime_error("--controller auto: found none: " + reasons);
}

}  // namespace

ChosenSource<GazeSource> choose_gaze(const std::string& name, const SourceParts& parts) {
    if (name == "simulated") return {nullptr, &parts.person.tracker()};
    if (name == "mouse" && parts.input) return {nullptr, &parts.input->mouse()};
    if (name == "openxr" && parts.headset) return owned(std::make_unique<OpenXrGaze>(*parts.headset));
    if (name == "hid") return owned(std::make_unique<HidGaze>(parts.clock));
    if (name == "fove") return owned(std::make_unique<FoveGaze>(parts.clock));
    if (name == "gazepoint" || name.starts_with(kGazepoint))
        return owned(std::make_unique<GazepointGaze>(parts.clock, gazepoint_at(name)));
    if (name.starts_with(kReplay))
        return owned(std::make_unique<ReplayGaze>(
            parts.clock, read_gaze_recording(name.substr(kReplay.size())), ReplayOptions{.repeat = true}));
    throw std::runtime_error("--gaze " + name +
                             ": expected hid, fove, gazepoint, gazepoint:HOST:PORT, simulated, replay:FILE, "
                             "mouse with --display window, or openxr "
                             "with --display openxr");
}

ChosenSource<ControllerSource> choose_controller(const std::string& name, const SourceParts& parts) {
    if (name == "simulated") return {nullptr, &parts.person.hand()};
    if (name == "keyboard" && parts.input) return {nullptr, &parts.input->keyboard()};
    if (name == "gamepad" && parts.input) return {nullptr, &parts.input->gamepad()};
    if (name == "evdev") return owned(std::make_unique<EvdevController>(parts.clock));
    if (name == "hidapi") return owned(std::make_unique<BluetoothPad>(parts.clock));
    if (name == "libusb") return owned(std::make_unique<UsbPad>(parts.clock));
    if (name == "auto") return first_controller(parts);
    throw std::runtime_error("--controller " + name +
                             ": expected auto, evdev, hidapi, libusb, simulated, or keyboard or gamepad with "
                             "--display window");
}

bool gaze_keeps_any_clock(const std::string& name) {
    return name == "simulated" || name.starts_with(kReplay);
}

bool controller_keeps_any_clock(const std::string& name) {
    return name == "simulated";
}

bool gaze_follows_targets(const std::string& name) {
    return !name.starts_with(kReplay);
}

}  // namespace parafovea
