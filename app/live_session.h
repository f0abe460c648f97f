// A session as `parafovea run` holds it: chooses the parts by their names, wires them, runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "study/session_runner.h"

namespace parafovea {

struct LiveSessionRequest {
    std::string protocol_file;
    std::string participant;            // a pseudonym that ends in a number
    std::filesystem::path data_folder;  // for the session file
    std::string display;                // "openxr", "window" or "headless"
    std::string gaze, controller;       // see source_choice.h
    std::optional<std::uint64_t> seed;  // of the plan; absent: drawn from the system's randomness
    bool resume = false;                // go on with the participant's latest session
    int monitor = 0;                    // which shows the window
    bool full_screen = false;
    bool console = true;         // the operator's window, beside the participant's
    bool hash_pictures = false;  // of a headset: reads every stimulus back, which costs time in every frame
};

struct LiveSessionOutcome {
    std::filesystem::path file;
    SessionEnd end = SessionEnd::stopped;
};

// Called by the main thread, since windows belong to it. Without a display, and with gaze and controller that
// need no real time, the session runs on a simulated clock. Throws std::runtime_error with one line where a
// part is missing, nothing is there to be resumed, or a device or the disk fails; what was answered is then
// in the file.
LiveSessionOutcome run_live_session(const LiveSessionRequest& request, std::stop_source stop,
                                    const std::function<void(const SessionProgress&)>& on_progress);

}  // namespace parafovea
