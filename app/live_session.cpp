// Wires a session.
#include "app/live_session.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <memory>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>

#include "app/calibration_page.h"
#include "app/headless_stage.h"
#include "app/openxr_stage.h"
#include "app/operator_board.h"
#include "app/operator_console.h"
#include "app/participant_id.h"
#include "app/questionnaire_page.h"
#include "app/session_file.h"
#include "app/simulated_person.h"
#include "app/source_choice.h"
#include "app/window_input.h"
#include "app/window_stage.h"
#include "app/window_surface.h"
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

// The windows of a session: the participant's, and the operator's beside it or on another monitor.
struct Windows {
    WindowSystem system;
    std::vector<Monitor> monitors = connected_monitors();
    std::unique_ptr<WindowSurface> participant, operators;

    const Monitor& participants_monitor(const LiveSessionRequest& request) const {
        const auto count = monitors.size();
        if (request.monitor < 0 || static_cast<std::size_t>(request.monitor) >= count)
            throw std::runtime_error("--monitor " + std::to_string(request.monitor) + ": expected 0 to " +
                                     std::to_string(count - 1));
        return monitors[static_cast<std::size_t>(request.monitor)];
    }

    Windows(const LiveSessionRequest& request, SizePx picture) {
        const Monitor& shown_on = participants_monitor(request);
        const double scale = placement_of(picture, shown_on.size).scale;
        WindowDescription description;
        description.title = "Parafovea";
        description.size = {static_cast<int>(scale * picture.width),
                            static_cast<int>(scale * picture.height)};
        description.left = shown_on.left;
        description.top = shown_on.top;
        if (request.full_screen) {
            description.size = shown_on.size;
            description.full_screen_on = request.monitor;
        }
        participant = std::make_unique<WindowSurface>(description);
        if (!request.console) return;

        const bool other = monitors.size() > 1;
        const Monitor& console_on = other ? monitors[request.monitor == 0 ? 1 : 0] : shown_on;
        WindowDescription console;
        console.title = "Parafovea: operator";
        console.left = console_on.left + (other ? 0 : description.size.width);
        console.top = console_on.top;
        console.size = {std::clamp(console_on.left + console_on.size.width - console.left, 640, 1280),
                        std::min(console_on.size.height, 1080)};
        console.resizable = true;
        console.takes_focus = false;
        operators = std::make_unique<WindowSurface>(console);
    }
};

// A session and everything it needs. Made in the order in which things depend on each other.
class LiveSession {
  public:
    LiveSession(const LiveSessionRequest& request, std::stop_source stop,
                const std::function<void(const SessionProgress&)>& on_progress)
        : request_(request),
          stop_(std::move(stop)),
          on_progress_(on_progress),
          protocol_(load_protocol(request.protocol_file)),
          participant_index_(participant_index(request.participant)),
          real_time_(request.display != "headless" || !gaze_keeps_any_clock(request.gaze) ||
                     !controller_keeps_any_clock(request.controller)),
          clock_(real_time_ ? std::unique_ptr<Clock>(std::make_unique<SteadyClock>())
                            : std::make_unique<SimulatedClock>()),
          board_(*clock_),
          pictures_(protocol_.display.view),
          judge_(display_model(protocol_.display.view, protocol_.display.peak_luminance_cd_m2)) {
        // The file comes first when resuming, since its plan's seed makes the simulated person.
        if (request_.resume) {
            file_ = latest_session_file(request_.data_folder, protocol_.name, request_.participant);
            log_.emplace(open_latest(request_, protocol_, file_, *clock_));
        }
        seed_ = log_ ? log_->plan().seed : request_.seed.value_or(seed_from_the_system());
        person_.emplace(protocol_, *clock_, judge_,
                        SimulatedPersonSettings{.seed = seed_, .thinks_in_background = real_time_});
        make_stage();
        const SourceParts parts{*clock_, *person_, input_.get(), headset_ ? &headset_->session() : nullptr};
        gaze_ = choose_gaze(request_.gaze, parts);
        controller_ = choose_controller(request_.controller, parts);
        if (!log_) create_log();
    }

    LiveSessionOutcome run() {
        if (windows_)
            run_beside_windows();
        else
            end_ = run_here();
        return {file_, end_};
    }

  private:
    void make_stage() {
        if (request_.display == "headless") {
            headless_ = std::make_unique<HeadlessStage>(protocol_.display.view, protocol_.display.refresh_hz,
                                                        *clock_, pictures_, *person_);
            stage_ = headless_.get();
            display_ = real_time_ ? "headless" : "headless, simulated clock";
            return;
        }
        if (request_.display == "openxr") {
            put_on_headset();
            return;
        }
        windows_ = std::make_unique<Windows>(request_, protocol_.display.view.size);
        input_ =
            std::make_unique<WindowInput>(windows_->participant->window(), protocol_.display.view, *clock_);
        window_stage_ =
            std::make_unique<WindowStage>(*windows_->participant, windows_->participants_monitor(request_),
                                          protocol_, *clock_, pictures_, &*person_);
        stage_ = window_stage_.get();
        display_ = window_stage_->description();
        if (window_stage_->paced_by_clock())
            std::fprintf(
                stderr,
                "parafovea: the display keeps no refresh of its own; frames follow the clock at %g Hz\n",
                window_stage_->refresh_hz());
        if (window_stage_->scale() < 1)
            std::fprintf(stderr,
                         "parafovea: the picture does not fit the monitor and is shown at %.3g of its size\n",
                         window_stage_->scale());
        if (windows_->operators)
            console_ =
                std::make_unique<OperatorConsole>(*windows_->operators, board_, pictures_, protocol_, stop_);
    }

    void put_on_headset() {
        OpenXrStageOptions options;
        options.stop = stop_.get_token();
        options.hash_pictures = request_.hash_pictures;
        if (request_.gaze == "simulated" || request_.controller == "simulated") options.audience = &*person_;
        headset_ = std::make_unique<OpenXrStage>(*clock_, options);
        stage_ = headset_.get();
        display_ = headset_->description();
        const ViewGeometry wanted = protocol_.display.view, real = headset_->view();
        if (std::abs(real.pixels_per_degree() / wanted.pixels_per_degree() - 1) > 0.02)
            std::fprintf(stderr,
                         "parafovea: the headset has %.1f pixels a degree in the middle, the protocol's view "
                         "%.1f; the headset's is shown and stored\n",
                         real.pixels_per_degree(), wanted.pixels_per_degree());
    }

    void create_log() {
        SessionFacts facts;
        facts.uuid = make_uuid();
        facts.participant = request_.participant;
        facts.program_version = PARAFOVEA_VERSION;
        facts.display = display_;
        facts.gaze_source = gaze_.source->description();
        facts.controller = controller_.source->description();
        facts.device = headset_ ? headset_->gpu().device_name() : pictures_.device_name();
        facts.driver = headset_ ? headset_->gpu().driver_name() : pictures_.driver_name();
        facts.refresh_hz = stage_->refresh_hz();
        facts.view = stage_->view();
        if (headset_) facts.other["eyes"] = to_text(headset_->eyes());
        facts.simulated_people = request_.gaze == "simulated" || request_.controller == "simulated";
        file_ =
            new_session_file(request_.data_folder, protocol_.name, request_.participant, std::time(nullptr));
        log_.emplace(SessionLog::create(file_, facts, protocol_,
                                        make_plan(protocol_, participant_index_, seed_),
                                        read_clock_anchor(clock_->now())));
    }

    SessionEnd run_here() {
        WatchedStage stage(*stage_, board_);
        WatchedGaze gaze(*gaze_.source, board_);
        const std::stop_token stop = stop_.get_token();
        SessionHooks hooks;
        hooks.stop = stop;
        hooks.on_progress = [&](const SessionProgress& progress) { prepare_for(progress); };
        hooks.on_trial = [&](const TrialRecord& record) { board_.add_trial(record); };
        hooks.operator_request = [&] {
            for (auto& [time, note] : board_.take_notes()) log_->append_note(time, std::move(note));
            return board_.take_request();
        };
        hooks.ask = [&](const Questionnaire& questionnaire) {
            return ask_questionnaire(questionnaire, protocol_, stage, *controller_.source, stop);
        };
        if (gaze_follows_targets(request_.gaze))
            hooks.calibrate = [&] {
                return told(measure_calibration(stage, gaze, *clock_, protocol_.calibration, stop));
            };
        if (gaze_follows_targets(request_.gaze))
            hooks.check_drift = [&] {
                return told(measure_drift(stage, gaze, *clock_, protocol_.calibration, stop));
            };
        SessionOptions options;
        options.real_time = real_time_;
        return run_session(*log_, stage, gaze, *controller_.source, *clock_, hooks, options);
    }

    std::optional<CalibrationRecord> told(std::optional<CalibrationRecord> record) {
        if (record) board_.add_calibration(*record);
        return record;
    }

    void prepare_for(const SessionProgress& progress) {
        board_.set_progress(progress);
        on_progress_(progress);
        if (window_stage_ && progress.total > 0)
            window_stage_->set_progress(static_cast<double>(progress.done) / progress.total);
        if (!progress.next || progress.state != "trial") return;
        if (window_stage_) window_stage_->prepare(*progress.next);
        if (headset_) {
            headset_->prepare(progress.next->scene, progress.next->first);
            headset_->prepare(progress.next->scene, progress.next->second);
        }
        person_->begin_trial(progress.next->number, progress.attempt);
    }

    // The session runs in a thread of its own, so that its frames do not wait for the window system's events
    // or for the operator's console, which belong to this one.
    void run_beside_windows() {
        std::exception_ptr failure;
        std::atomic<bool> over = false;
        {
            const std::jthread session([&] {
                try {
                    end_ = run_here();
                } catch (...) {
                    failure = std::current_exception();
                }
                over = true;
            });
            try {
                while (!over) {
                    windows_->system.wait_for_events(0.004);
                    input_->poll();
                    const bool closed = windows_->participant->close_requested() ||
                                        (windows_->operators && windows_->operators->close_requested());
                    if (closed) stop_.request_stop();
                    if (console_) console_->draw_when_due();
                }
            } catch (...) {
                stop_.request_stop();
                throw;
            }
        }
        if (failure) std::rethrow_exception(failure);
    }

    const LiveSessionRequest& request_;
    std::stop_source stop_;
    const std::function<void(const SessionProgress&)>& on_progress_;
    Protocol protocol_;
    int participant_index_;
    bool real_time_;
    std::unique_ptr<Clock> clock_;
    OperatorBoard board_;
    PictureSource pictures_;
    PicturePairJudge judge_;
    std::filesystem::path file_;
    std::optional<SessionLog> log_;
    std::uint64_t seed_ = 0;
    std::optional<SimulatedPerson> person_;
    std::unique_ptr<Windows> windows_;
    std::unique_ptr<WindowInput> input_;
    std::unique_ptr<WindowStage> window_stage_;
    std::unique_ptr<HeadlessStage> headless_;
    std::unique_ptr<OperatorConsole> console_;
    std::unique_ptr<OpenXrStage> headset_;
    Stage* stage_ = nullptr;
    std::string display_;
    ChosenSource<GazeSource> gaze_;
    ChosenSource<ControllerSource> controller_;
    SessionEnd end_ = SessionEnd::stopped;
};

}  // namespace

LiveSessionOutcome run_live_session(const LiveSessionRequest& request, std::stop_source stop,
                                    const std::function<void(const SessionProgress&)>& on_progress) {
    return LiveSession(request, std::move(stop), on_progress).run();
}

}  // namespace parafovea
