// Wires one simulated participant to the real session.
#include "app/simulated_session.h"

#include <cstdio>

#include "app/headless_stage.h"
#include "app/simulated_person.h"
#include "devices/random.h"

namespace parafovea {

std::string simulated_participant_id(int participant_index) {
    char text[32];
    std::snprintf(text, sizeof text, "simulated-%02d", participant_index + 1);
    return text;
}

void run_simulated_session(const Protocol& protocol, const SimulatedSessionRequest& request,
                           PictureSource& pictures, PicturePairJudge& judge,
                           const std::function<void(const SessionProgress&)>& on_progress) {
    const std::string id = simulated_participant_id(request.participant_index);
    const std::uint64_t seed = Random::stream(request.study_seed, id).next();

    SimulatedClock clock;
    SimulatedPerson person(protocol, clock, judge, {.seed = Random::stream(seed, "person").next()});
    HeadlessStage stage(protocol.display.view, protocol.display.refresh_hz, clock, pictures, person);
    SessionFacts facts;
    facts.uuid = make_uuid();
    facts.participant = id;
    facts.program_version = PARAFOVEA_VERSION;
    facts.display = "headless, simulated clock";
    facts.gaze_source = person.tracker().description();
    facts.controller = person.hand().description();
    facts.device = pictures.device_name();
    facts.driver = pictures.driver_name();
    facts.refresh_hz = stage.refresh_hz();
    facts.simulated_people = true;
    SessionLog log = SessionLog::create(request.file, facts, protocol,
                                        make_plan(protocol, request.participant_index, seed),
                                        read_clock_anchor(clock.now()));
    SessionHooks hooks;
    hooks.on_progress = [&](const SessionProgress& progress) {
        if (progress.next && progress.state == "trial")
            person.begin_trial(progress.next->number, progress.attempt);
        on_progress(progress);
    };
    run_session(log, stage, person.tracker(), person.hand(), clock, hooks);
}

}  // namespace parafovea
