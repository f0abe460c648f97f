// Wires a session.
#include "app/live_session.h"

#include <algorithm>
#include <ctime>
#include <memory>
#include <random>
#include <stdexcept>

#include "app/calibration_page.h"
#include "app/headless_stage.h"
#include "app/participant_id.h"
#include "app/session_file.h"
#include "app/simulated_person.h"
#include "app/source_choice.h"
#include "study/protocol.h"

namespace parafovea {

namespace {

std::uint64_t seed_from_the_system() {
    std::random_device random;
    return (std::uint64_t{random()} << 32) | random();
}

SessionLog open_latest(const LiveSessionRequest& request, const Protocol& protocol,
                       const std::filesystem::path& file, Clock& clock) {
    if (file.empty())
        throw std::runtime_error("--resume: no session of study " + protocol.name + " and participant " +
                                 request.participant + " in " + request.data_folder.string() +
                                 "; start one without --resume");
    SessionLog log = SessionLog::open_to_resume(file, read_clock_anchor(clock.now()));
    if (protocol_hash(log.protocol()) != protocol_hash(protocol))
        throw std::runtime_error("--resume: " + file.string() + " was begun with another text of " +
                                 request.protocol_file +
                                 "; restore it, or start a new session without --resume");
    if (log.finished())
        throw std::runtime_error("--resume: " + file.string() +
                                 " is finished; start a new session without --resume");
    return log;
}

// How often this planned trial was shown before, broken-off showings included.
int attempts_before(const SessionLog& log, int number) {
    return static_cast<int>(
        std::count_if(log.shown().begin(), log.shown().end(),
                      [number](const ShownTrial& shown) { return shown.number == number; }));
}

}  // namespace

LiveSessionOutcome run_live_session(const LiveSessionRequest& request, std::stop_token stop,
                                    const std::function<void(const SessionProgress&)>& on_progress) {
    const Protocol protocol = load_protocol(request.protocol_file);
    const int index = participant_index(request.participant);
    const bool real_time =
        !gaze_keeps_any_clock(request.gaze) || !controller_keeps_any_clock(request.controller);
    std::unique_ptr<Clock> clock;
    if (real_time)
        clock = std::make_unique<SteadyClock>();
    else
        clock = std::make_unique<SimulatedClock>();

    // The file comes first when resuming, since its plan's seed makes the simulated person.
    LiveSessionOutcome outcome;
    std::optional<SessionLog> log;
    if (request.resume) {
        outcome.file = latest_session_file(request.data_folder, protocol.name, request.participant);
        log.emplace(open_latest(request, protocol, outcome.file, *clock));
    }
    const std::uint64_t seed = log ? log->plan().seed : request.seed.value_or(seed_from_the_system());

    // Make the parts.
    PictureSource pictures(protocol.display.view);
    PicturePairJudge judge(display_model(protocol.display.view, protocol.display.peak_luminance_cd_m2));
    SimulatedPerson person(protocol, *clock, judge, {.seed = seed, .thinks_in_background = real_time});
    const SourceParts source_parts{*clock, person};
    const ChosenSource<GazeSource> gaze = choose_gaze(request.gaze, source_parts);
    const ChosenSource<ControllerSource> controller = choose_controller(request.controller, source_parts);
    HeadlessStage stage(protocol.display.view, protocol.display.refresh_hz, *clock, pictures, person);

    if (!log) {
        SessionFacts facts;
        facts.uuid = make_uuid();
        facts.participant = request.participant;
        facts.program_version = PARAFOVEA_VERSION;
        facts.display = real_time ? "headless" : "headless, simulated clock";
        facts.gaze_source = gaze.source->description();
        facts.controller = controller.source->description();
        facts.device = pictures.device_name();
        facts.driver = pictures.driver_name();
        facts.refresh_hz = stage.refresh_hz();
        facts.simulated_people = request.gaze == "simulated" || request.controller == "simulated";
        outcome.file =
            new_session_file(request.data_folder, protocol.name, request.participant, std::time(nullptr));
        log.emplace(SessionLog::create(outcome.file, facts, protocol, make_plan(protocol, index, seed),
                                       read_clock_anchor(clock->now())));
    }

    SessionHooks hooks;
    hooks.stop = stop;
    hooks.on_progress = [&](const SessionProgress& progress) {
        if (progress.next && progress.state == "trial")
            person.begin_trial(progress.next->number, attempts_before(*log, progress.next->number));
        on_progress(progress);
    };
    if (gaze_follows_targets(request.gaze))
        hooks.calibrate = [&] { return measure_calibration(stage, *gaze.source, *clock, stop); };
    SessionOptions options;
    options.real_time = real_time;
    outcome.end = run_session(*log, stage, *gaze.source, *controller.source, *clock, hooks, options);
    return outcome;
}

}  // namespace parafovea
