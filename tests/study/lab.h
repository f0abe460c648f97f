// A whole session with fake devices, for tests of the log.
#pragma once

#include "study/session_log.h"
#include "study/session_runner.h"
#include "tests/study/fakes.h"

namespace parafovea::test {

inline SessionFacts facts() {
    SessionFacts facts;
    facts.uuid = "u";
    facts.participant = "p07";
    facts.program_version = "0.1";
    facts.refresh_hz = 100;
    facts.view = {{1280, 1440}, 76.7};
    facts.simulated_people = true;
    facts.other = {{"operator's name", "it's \"O'Neill\"; DROP TABLE plan"}};
    return facts;
}

// One run of the program over a session file.
struct ProgramRun {
    ProgramRun() : stage(clock, 100), gaze(clock), participant(clock, stage) {
        stage.keep_last = 10;
        gaze.look(0, 60, DirectionDeg{0.5, 0.25});
    }
    SessionEnd go(SessionLog& log, const SessionHooks& hooks = {}) {
        return run_session(log, stage, gaze, participant, clock, hooks);
    }

    SimulatedClock clock;
    FakeStage stage;
    FakeGaze gaze;
    FakeParticipant participant;
};

inline SessionLog start(const std::filesystem::path& path, const Protocol& protocol = small_protocol(),
                        const char* vfs = nullptr) {
    return SessionLog::create(path, facts(), protocol, make_plan(protocol, 2, 42), {{}, 1'000'000'000'000},
                              vfs);
}

inline SessionLog resume(const std::filesystem::path& path, double after_h = 0.1) {
    return SessionLog::open_to_resume(path,
                                      {{}, 1'000'000'000'000 + static_cast<std::int64_t>(after_h * 3.6e12)});
}

}  // namespace parafovea::test
