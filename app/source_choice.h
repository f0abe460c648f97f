// Makes gaze and controller sources from their names on the command line.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "app/simulated_person.h"
#include "devices/clock.h"
#include "devices/controller_source.h"
#include "devices/gaze_source.h"

namespace parafovea {

class OpenXrSession;
class WindowInput;

// What sources are made from; all is borrowed.
struct SourceParts {
    Clock& clock;
    SimulatedPerson& person;
    WindowInput* input = nullptr;      // of the participant's window, where there is one
    OpenXrSession* headset = nullptr;  // where there is one
};

// A source that is owned here, or that belongs to the parts.
template <typename Source>
struct ChosenSource {
    std::unique_ptr<Source> owned;
    Source* source = nullptr;
};

// "simulated"; "hid"; "fove"; "gazepoint", or "gazepoint:HOST:PORT" where Gazepoint Control does not run on
// this machine (HOST is a numeric address); "replay:FILE" with a recording that devices/gaze_recording.h
// reads; "mouse" in a window, "openxr" in a headset. Throws std::runtime_error with one line for another name
// and where the source cannot be opened.
ChosenSource<GazeSource> choose_gaze(const std::string& name, const SourceParts& parts);

// "evdev", "hidapi", "libusb", "simulated"; "keyboard" and "gamepad", in a window; or "auto": the first pad
// of these that is there, else the keyboard. Throws like choose_gaze.
ChosenSource<ControllerSource> choose_controller(const std::string& name, const SourceParts& parts);

// Whether a source of this name lives on whatever clock it is given, a simulated one too.
bool gaze_keeps_any_clock(const std::string& name);
bool controller_keeps_any_clock(const std::string& name);

// Whether the tracker can follow calibration targets: a recording cannot.
bool gaze_follows_targets(const std::string& name);

}  // namespace parafovea
