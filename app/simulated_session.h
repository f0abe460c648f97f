// One simulated participant's whole session: the real protocol, plan, renderer, trial logic and log; a
// simulated clock, eye tracker, controller and observer.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "app/picture_pair_judge.h"
#include "app/picture_source.h"
#include "study/protocol.h"
#include "study/session_runner.h"

namespace parafovea {

struct SimulatedSessionRequest {
    int participant_index = 0;     // from 0
    std::uint64_t study_seed = 0;  // of all participants; each draws from a stream of its own
    std::filesystem::path file;    // the session file to make
};

// The pseudonym of a simulated participant, e.g. "simulated-01".
std::string simulated_participant_id(int participant_index);

// Runs the session to its end. Throws what the disk and the renderer throw; answers given so far are then in
// the file.
void run_simulated_session(const Protocol& protocol, const SimulatedSessionRequest& request,
                           PictureSource& pictures, PicturePairJudge& judge,
                           const std::function<void(const SessionProgress&)>& on_progress);

}  // namespace parafovea
