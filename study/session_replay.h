// Runs a recorded session again through the same trial code, from its plan, gaze and buttons.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/stage.h"

namespace parafovea {

struct ReplayReport {
    int trials = 0;  // showings replayed
    std::int64_t frames = 0;
    std::int64_t images = 0;  // stimulus frames that were rendered again and compared
    std::vector<std::string>
        differences;  // one line each, e.g. "trial 7 attempt 0: ..."; empty: all is equal
};

// What the program does with each replayed frame: show it, wait until it is due, render it. Returns the hash
// of the rendered pixels where it rendered; it is asked for every frame and compared where the recording has
// a hash.
using ReplayFrame =
    std::function<std::optional<std::uint64_t>(const Picture& picture, const ShownFrame& recorded)>;

// Compares: the file's integrity, the protocol's hash, the plan with one made anew from protocol, index and
// seed, every row of every showing with what the trial code makes of the same gaze and buttons, every stored
// row with the hash stored beside it, and every image. Throws std::runtime_error where the file cannot be
// read. Showings written by version 1 of the file cannot be replayed exactly; that is one of the differences
// reported.
ReplayReport replay_session(const std::filesystem::path& path, const ReplayFrame& on_frame = nullptr,
                            const std::function<void(int done, int total)>& on_progress = nullptr);

}  // namespace parafovea
