// The one list of sources and their names.
#include "app/source_choice.h"

#include <stdexcept>
#include <string_view>

#include "devices/gaze_recording.h"
#include "devices/replay_gaze.h"

namespace parafovea {

namespace {

constexpr std::string_view kReplay = "replay:";

}  // namespace

ChosenSource<GazeSource> choose_gaze(const std::string& name, const SourceParts& parts) {
    if (name == "simulated") return {nullptr, &parts.person.tracker()};
    if (name.starts_with(kReplay)) {
        auto replay = std::make_unique<ReplayGaze>(
            parts.clock, read_gaze_recording(name.substr(kReplay.size())), ReplayOptions{.repeat = true});
        GazeSource* source = replay.get();
        return {std::move(replay), source};
    }
    throw std::runtime_error("--gaze " + name + ": expected simulated or replay:FILE");
}

ChosenSource<ControllerSource> choose_controller(const std::string& name, const SourceParts& parts) {
    if (name == "simulated") return {nullptr, &parts.person.hand()};
    throw std::runtime_error("--controller " + name + ": expected simulated");
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
