// Runs a session from the first trial that is still to do.
#include "study/session_runner.h"

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <utility>
#include <vector>

#include "study/adaptive.h"
#include "study/trial_runner.h"

namespace parafovea {
namespace {

// What became of one planned trial so far.
struct Standing {
    int showings = 0;    // that were not interrupted or superseded
    int rows = 0;        // all
    bool valid = false;  // one of them counts
    int last_shown = -1;
};

std::vector<Standing> standings(const TrialPlan& plan, const std::vector<ShownTrial>& shown) {
    std::vector<Standing> all(plan.trials.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
        Standing& standing = all.at(static_cast<std::size_t>(shown[i].number));
        ++standing.rows;
        if (shown[i].interrupted || shown[i].superseded) continue;
        ++standing.showings;
        standing.valid = standing.valid || shown[i].valid;
        standing.last_shown = static_cast<int>(i);
    }
    return all;
}

bool settled(const PlannedTrial& trial, const Standing& standing, const ValidityRules& rules) {
    if (standing.showings == 0) return false;
    return standing.valid || trial.kind == TrialKind::training || standing.showings > rules.repeats;
}

std::string replaced(std::string text, const std::string& name, int value) {
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at))
        text.replace(at, name.size(), std::to_string(value));
    return text;
}

class RunningSession {
  public:
    RunningSession(SessionLog& log, Stage& stage, GazeSource& gaze, ControllerSource& controller,
                   Clock& clock, const SessionHooks& hooks, const SessionOptions& options)
        : log_(log),
          protocol_(log.protocol()),
          stage_(stage),
          gaze_(gaze),
          controller_(controller),
          clock_(clock),
          hooks_(hooks),
          options_(options) {}

    SessionEnd run() {
        if (log_.resumed()) go_on_after_interruption();
        if (!ask_all(questionnaires_before(protocol_))) return stopped();
        forget_gaze();
        page("introduction", protocol_.text().introduction);
        calibrate();
        while (const std::optional<NextTrial> next =
                   next_trial(log_.plan(), log_.shown(), protocol_.validity)) {
            if (!prepare_for(*next->planned)) return stopped();
            if (!serve_operator()) {
                if (stop_requested() || aborted_) return stopped();
                continue;
            }
            if (!show_trial(*next)) return stopped();
        }
        if (hooks_.stop.stop_requested()) return stopped();
        if (!log_.finished()) log_.finish(clock_.now());
        tell("finished", nullptr);
        if (!ask_all(questionnaires_after(protocol_))) return stopped();
        if (!protocol_.text().finished.empty()) page("finished", protocol_.text().finished);
        log_.wait_until_durable();
        return SessionEnd::finished;
    }

  private:
    bool stop_requested() const { return hooks_.stop.stop_requested() || aborted_; }

    SessionEnd stopped() {
        keep_gaze();
        // The operator's abort stops the running trial before it is read here.
        if (hooks_.operator_request && hooks_.operator_request() == OperatorRequest::abort) aborted_ = true;
        log_.append_event(clock_.now(), "stopped", aborted_ ? "by the operator" : "");
        log_.wait_until_durable();
        return SessionEnd::stopped;
    }

    // False where the participant leaves or cannot take part.
    bool ask_all(const std::vector<Questionnaire>& questionnaires) {
        for (const Questionnaire& questionnaire : questionnaires) {
            if (log_.was_asked(questionnaire.name) || log_.simulated_people()) continue;
            if (!hooks_.ask) {
                if (questionnaire.name == "consent")
                    throw std::runtime_error(
                        "consent: expected the participant's consent in the session file, found none; record "
                        "it first");
                log_.append_event(clock_.now(), "not asked", questionnaire.name);
                continue;
            }
            tell(questionnaire.name.c_str(), nullptr);
            const std::optional<QuestionnaireAnswers> answers = hooks_.ask(questionnaire);
            if (!answers) return false;
            log_.append_questionnaire(clock_.now(), questionnaire.name, *answers);
            if (const auto reason = reason_not_to_take_part(protocol_, questionnaire, *answers)) {
                log_.append_event(clock_.now(), "not taking part", *reason);
                return false;
            }
        }
        return true;
    }

    void go_on_after_interruption() {
        const std::optional<NextTrial> next = next_trial(log_.plan(), log_.shown(), protocol_.validity);
        if (!next) return;
        const ResumePolicy policy = protocol_.resume.policy(log_.age_h());
        if (policy == ResumePolicy::refuse)
            throw std::runtime_error("resume: expected a session left at most " +
                                     std::to_string(protocol_.resume.refuse_after_h) + " hours ago, found " +
                                     std::to_string(log_.age_h()) + "; start a new session");
        const bool restart = policy == ResumePolicy::restart_block;
        if (restart) log_.supersede_session(next->planned->session);
        log_.append_event(clock_.now(), "resumed",
                          restart ? "session restarted" : "at the first unanswered trial");
    }

    void tell(const char* state, const NextTrial* next) {
        if (!hooks_.on_progress) return;
        const std::vector<Standing> all = standings(log_.plan(), log_.shown());
        SessionProgress progress;
        progress.total = static_cast<int>(all.size());
        for (std::size_t i = 0; i < all.size(); ++i)
            if (settled(log_.plan().trials[i], all[i], protocol_.validity)) ++progress.done;
        progress.session = next ? next->planned->session : session_;
        progress.sessions = protocol_.design.sessions;
        progress.next = next ? next->planned : nullptr;
        progress.attempt = next ? next->attempt : 0;
        progress.state = state;
        hooks_.on_progress(progress);
    }

    // Everything that comes before a trial: a rest, the pages of its session, and a look at the eye tracker.
    // False: stop.
    bool prepare_for(const PlannedTrial& next) {
        session_ = next.session;
        const bool rested = rest_if_due(next);
        const bool began = next.session == 0
                               ? page("training", protocol_.text().training)
                               : page("session " + std::to_string(next.session), protocol_.text().session);
        // The first session begins right after the calibration where there is no training.
        if (rested || (began && !just_calibrated_)) check_drift();
        just_calibrated_ = false;
        return !stop_requested();
    }

    // Whether there was a rest.
    bool rest_if_due(const PlannedTrial& next) {
        if (log_.shown().empty()) return false;
        const ShownTrial& last = log_.shown().back();
        if (last.interrupted || last.superseded) return false;
        const PlannedTrial& planned = log_.plan().trials[static_cast<std::size_t>(last.number)];
        const bool failed = planned.kind == TrialKind::validation && last.answered && !last.identical;
        const bool session_over = planned.session > 0 && planned.session != next.session;
        const int in_session = static_cast<int>(
            std::count_if(log_.shown().begin(), log_.shown().end(), [&](const ShownTrial& shown) {
                return log_.plan().trials[static_cast<std::size_t>(shown.number)].session == planned.session;
            }));
        const bool reminder = protocol_.rests.every_trials && planned.session > 0 &&
                              in_session % *protocol_.rests.every_trials == 0;
        const bool after_failed = failed && protocol_.rests.after_failed_validation;
        if (!after_failed && !reminder && !(session_over && protocol_.rests.after_session)) return false;
        // Named after the trial, so that a rest cut short by a crash is given again and a completed one is
        // not.
        const std::string name =
            "rest after trial " + std::to_string(last.number) + " attempt " + std::to_string(last.attempt);
        const Texts& texts = protocol_.text();
        const bool other_text = after_failed && !texts.rest_after_failed_validation.empty();
        return page(name, other_text ? texts.rest_after_failed_validation : texts.rest,
                    protocol_.rests.at_least_s);
    }

    // Shows a page of text until the participant leaves it, once in a session's life. Whether it was left
    // now.
    bool page(const std::string& name, const std::string& text, double at_least_s = 0) {
        if (!options_.show_texts || text.empty() || log_.page_was_left(name) || stop_requested())
            return false;
        tell(name.c_str(), nullptr);
        if (!show_text(name, text, at_least_s, true)) return false;
        log_.append_page(clock_.now(), name);
        return true;
    }

    // How a page of text was left: the participant's button or the operator's request; neither: by a stop.
    struct PageEnd {
        std::optional<Button> button;
        OperatorRequest request = OperatorRequest::none;
    };

    // False where it was ended by a stop.
    bool show_text(const std::string& name, const std::string& text, double at_least_s,
                   bool participant_may_leave) {
        std::vector<Button> buttons;
        if (participant_may_leave) buttons.push_back(protocol_.keys.proceed);
        const PageEnd end = wait_on_page(name, text, at_least_s, buttons);
        return end.button || end.request == OperatorRequest::proceed;
    }

    // Shows text until one of the buttons is pressed, or until the operator goes on, or asks for what
    // `answers` holds; what else the operator asks for is done after the page.
    PageEnd wait_on_page(const std::string& name, const std::string& text, double at_least_s,
                         const std::vector<Button>& buttons,
                         OperatorRequest answers = OperatorRequest::proceed) {
        Picture picture;
        picture.kind = PictureKind::text;
        picture.text = filled(text);
        gaze_belongs_to(name);
        std::vector<ControllerEvent> events;
        controller_.drain(events);
        std::optional<HostTime> may_leave;
        while (!stop_requested()) {
            const ShownFrame frame = stage_.show(picture);
            collect_gaze();
            if (!may_leave) may_leave = frame.display_time + Duration::from_seconds(at_least_s);
            events.clear();
            controller_.drain(events);
            for (const ControllerEvent& event : events) {
                const bool leaves = std::ranges::find(buttons, event.button) != buttons.end();
                if (event.kind == ControllerEventKind::press && leaves && event.time >= *may_leave)
                    return {event.button, OperatorRequest::none};
            }
            if (!hooks_.operator_request) continue;
            const OperatorRequest request = hooks_.operator_request();
            if (request == OperatorRequest::abort) aborted_ = true;
            if (request == OperatorRequest::proceed || request == answers) return {std::nullopt, request};
            if (request != OperatorRequest::none) waiting_request_ = request;
        }
        return {};
    }

    // What arrived before now was seen before the participant agreed, or is nobody's.
    void forget_gaze() {
        gaze_.drain(between_);
        between_.clear();
    }

    // Gaze that arrives from now on belongs to this part of the session.
    void gaze_belongs_to(const std::string& phase) {
        keep_gaze();
        gaze_phase_ = phase;
    }

    void collect_gaze() {
        constexpr std::size_t kManySamples = 1200;  // ten seconds at 120 Hz
        gaze_.drain(between_);
        if (between_.size() >= kManySamples) store_gaze();
    }

    void keep_gaze() {
        if (gaze_phase_.empty()) return;
        gaze_.drain(between_);
        store_gaze();
    }

    void store_gaze() {
        if (!between_.empty()) log_.append_gaze(gaze_phase_, std::exchange(between_, {}));
    }

    std::string filled(const std::string& text) const {
        const int trials = static_cast<int>(log_.plan().trials.size());
        const std::string with_trial = replaced(replaced(text, "{trials}", trials), "{trial}",
                                                std::min(trials, static_cast<int>(log_.shown().size()) + 1));
        return replaced(replaced(with_trial, "{sessions}", protocol_.design.sessions), "{session}", session_);
    }

    // Calibrates at the start of every run: after an interruption the headset has been off.
    void calibrate() {
        if (!hooks_.calibrate || stop_requested() ||
            !next_trial(log_.plan(), log_.shown(), protocol_.validity))
            return;
        constexpr int kMostTimes = 3;
        for (int times = 1; measure_calibration(); ++times)
            if (times == kMostTimes || !recalibration_wanted()) break;
        just_calibrated_ = true;
    }

    // Whether it was measured and is not good enough.
    bool measure_calibration() {
        tell("calibration", nullptr);
        if (options_.show_texts && !protocol_.text().calibration.empty())
            show_text("before calibration", protocol_.text().calibration, 0, true);
        if (stop_requested()) return false;
        return measure("calibration", hooks_.calibrate);
    }

    // Between blocks: measured, stored and told; nothing is corrected.
    void check_drift() {
        if (!hooks_.check_drift || !protocol_.calibration.drift_check_deg || stop_requested()) return;
        tell("drift check", nullptr);
        if (measure("drift check", hooks_.check_drift) && recalibration_wanted()) calibrate();
    }

    bool measure(const char* phase, const std::function<std::optional<CalibrationRecord>()>& how) {
        gaze_belongs_to(phase);
        std::optional<CalibrationRecord> record = how();
        // What it drained comes with the record.
        if (!record) return false;
        const bool no_go = !record->accepted;
        if (no_go) {
            char detail[64] = "no gaze";
            if (record->mean_accuracy_deg)
                std::snprintf(detail, sizeof detail, "%.2f degrees", *record->mean_accuracy_deg);
            log_.append_event(clock_.now(), std::string(phase) + " not good enough", detail);
        }
        log_.append_calibration(*std::move(record));
        return no_go;
    }

    // Offers a calibration to the participant (proceed: yes, different: no) and to the operator. Without a
    // text for it, the operator alone sees the figures and may ask for one.
    bool recalibration_wanted() {
        if (!options_.show_texts || protocol_.text().recalibrate.empty() || stop_requested()) return false;
        tell("recalibration offered", nullptr);
        const PageEnd end =
            wait_on_page("recalibration offered", protocol_.text().recalibrate, 0,
                         {protocol_.keys.proceed, protocol_.keys.different}, OperatorRequest::recalibrate);
        const bool wanted =
            end.button == protocol_.keys.proceed || end.request == OperatorRequest::recalibrate;
        if (!stop_requested())
            log_.append_event(clock_.now(), wanted ? "recalibration" : "no recalibration",
                              end.button ? "by the participant" : "by the operator");
        return wanted;
    }

    // Between trials. False where what comes next has to be found out anew.
    bool serve_operator() {
        if (!hooks_.operator_request) return true;
        const OperatorRequest request = hooks_.operator_request();
        const OperatorRequest before = std::exchange(waiting_request_, OperatorRequest::none);
        switch (request != OperatorRequest::none ? request : before) {
            case OperatorRequest::none:
            case OperatorRequest::proceed:
                return true;
            case OperatorRequest::pause:
                tell("paused", nullptr);
                log_.append_event(clock_.now(), "paused", "by the operator");
                show_text("paused", protocol_.text().paused, 0, false);
                log_.append_event(clock_.now(), "pause ended", "by the operator");
                return false;
            case OperatorRequest::rest:
                tell("rest", nullptr);
                log_.append_event(clock_.now(), "rest", "by the operator");
                show_text("rest", protocol_.text().rest, protocol_.rests.at_least_s, true);
                check_drift();
                return false;
            case OperatorRequest::recalibrate:
                log_.append_event(clock_.now(), "recalibration", "by the operator");
                calibrate();
                return false;
            case OperatorRequest::repeat_last:
                if (log_.shown().empty()) return true;
                log_.append_event(clock_.now(), "repeat",
                                  "trial " + std::to_string(log_.shown().back().number));
                log_.supersede_trial(log_.shown().back().number);
                return false;
            case OperatorRequest::abort:
                aborted_ = true;
                return false;
        }
        return true;
    }

    bool show_trial(const NextTrial& next) {
        // Scenes may be loaded and pictures drawn now; what the eyes do meanwhile is not of the trial.
        gaze_belongs_to("before trial " + std::to_string(next.planned->number));
        tell("trial", &next);
        keep_gaze();
        TrialControl control;
        control.stop = hooks_.stop;
        // Every answer is on the disk before the next stimulus.
        control.stimulus_ready = [this] {
            if (options_.real_time) return log_.durable();
            log_.wait_until_durable();
            return true;
        };
        const std::optional<double> level =
            adaptive_level(protocol_, log_.plan(), log_.shown(), *next.planned);
        TrialRecord record = run_trial(at_level(*next.planned, protocol_, level), protocol_, stage_, gaze_,
                                       controller_, clock_, control);
        record.attempt = next.attempt;
        record.level = level;
        if (hooks_.on_trial) hooks_.on_trial(record);
        gaze_phase_ = "after trial " + std::to_string(next.planned->number);
        const bool interrupted = record.interrupted;
        log_.append(std::move(record));
        return !interrupted;
    }

    SessionLog& log_;
    const Protocol& protocol_;
    Stage& stage_;
    GazeSource& gaze_;
    ControllerSource& controller_;
    Clock& clock_;
    const SessionHooks& hooks_;
    const SessionOptions& options_;
    int session_ = 0;
    bool aborted_ = false, just_calibrated_ = false;
    std::vector<GazeSample> between_;  // that belongs to no trial and is not with the log yet
    std::string gaze_phase_;           // what it belongs to
    OperatorRequest waiting_request_ = OperatorRequest::none;
};

}  // namespace

std::optional<NextTrial> next_trial(const TrialPlan& plan, const std::vector<ShownTrial>& shown,
                                    const ValidityRules& rules) {
    const std::vector<Standing> all = standings(plan, shown);
    for (std::size_t first = 0; first < plan.trials.size();) {
        std::size_t end = first;
        while (end < plan.trials.size() && plan.trials[end].session == plan.trials[first].session) ++end;
        // What this session has not shown comes in the plan's order; what has to be shown again comes after,
        // oldest first.
        std::optional<std::size_t> again;
        for (std::size_t i = first; i < end; ++i) {
            if (settled(plan.trials[i], all[i], rules)) continue;
            if (all[i].showings == 0) return NextTrial{&plan.trials[i], all[i].rows};
            if (!again || all[i].last_shown < all[*again].last_shown) again = i;
        }
        if (again) return NextTrial{&plan.trials[*again], all[*again].rows};
        first = end;
    }
    return std::nullopt;
}

SessionEnd run_session(SessionLog& log, Stage& stage, GazeSource& gaze, ControllerSource& controller,
                       Clock& clock, const SessionHooks& hooks, const SessionOptions& options) {
    return RunningSession(log, stage, gaze, controller, clock, hooks, options).run();
}

}  // namespace parafovea
