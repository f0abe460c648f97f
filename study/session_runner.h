// A whole session: training, testing sessions, rests and pages of text, from the first trial that is still to
// do.
#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>

#include "devices/clock.h"
#include "devices/controller_source.h"
#include "devices/gaze_source.h"
#include "study/questionnaire.h"
#include "study/session_log.h"
#include "study/stage.h"

namespace parafovea {

// Where a session stands, told before each trial and on each page of text.
struct SessionProgress {
    int done = 0;   // planned trials settled so far
    int total = 0;  // planned trials
    int session = 0, sessions = 0;
    const PlannedTrial* next = nullptr;  // absent between trials
    int attempt = 0;                     // how often the next was shown before, broken-off showings included
    std::string state;                   // "introduction", "trial", "rest", "paused", "finished", ...
};

// What the operator may ask for; read between trials and on every frame of a page of text.
enum class OperatorRequest { none, pause, proceed, rest, repeat_last, recalibrate, abort };

// The session's connections to the program. All may be left empty.
struct SessionHooks {
    std::function<void(const SessionProgress&)> on_progress;
    std::function<void(const TrialRecord&)> on_trial;  // after each, before the next
    std::function<OperatorRequest()> operator_request;
    std::function<std::optional<CalibrationRecord>()>
        calibrate;  // runs and measures a calibration; none if it was skipped
    std::function<std::optional<CalibrationRecord>()> check_drift;  // measures how far the gaze is off
    // Asks the participant; nothing where they leave instead. Needed where the protocol asks for consent and
    // people are real, unless the log holds their consent already. Every answer must pass answer_mistake.
    std::function<std::optional<QuestionnaireAnswers>(const Questionnaire&)> ask;
    std::stop_token stop;  // ends the session; it can be resumed
};

struct SessionOptions {
    // Real time: the lead-in is prolonged while an answer is still on its way to the disk. Otherwise the disk
    // is waited for between frames, so that a simulated session repeats to the frame.
    bool real_time = false;
    bool show_texts = true;  // pages of text wait for the proceed key
};

enum class SessionEnd { finished, stopped };

// Runs what is still to do in the log's plan, consent and questions before any gaze is read. Every answer is
// durable before the next stimulus. Throws what stage, devices or disk throw; the log then holds every answer
// given.
SessionEnd run_session(SessionLog& log, Stage& stage, GazeSource& gaze, ControllerSource& controller,
                       Clock& clock, const SessionHooks& hooks = {}, const SessionOptions& options = {});

// The trial to show next: the first of the plan that has not been shown, then a session's invalid ones again
// at that session's end, as often as the rules allow; none when all is done. A pure function of what was
// shown, so a resumed session goes on as the uninterrupted one would have.
struct NextTrial {
    const PlannedTrial* planned = nullptr;
    int attempt = 0;
};
std::optional<NextTrial> next_trial(const TrialPlan& plan, const std::vector<ShownTrial>& shown,
                                    const ValidityRules& rules);

}  // namespace parafovea
