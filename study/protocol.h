// A study as data: everything a TOML protocol says, checked on reading.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "devices/controller_source.h"
#include "devices/geometry.h"
#include "study/method_setting.h"
#include "study/quest_plus.h"
#include "study/staircase.h"

namespace parafovea {

// Which of the paper's studies this is: it decides how the analysis names its figure.
enum class StudyKind { free, pilot, final };

struct DisplaySetting {
    ViewGeometry view;                  // one eye's picture
    double refresh_hz = 0;              // intended; the realised rate is the stage's
    double peak_luminance_cd_m2 = 100;  // for models of visibility
    bool photodiode_patch = false;      // a corner that is white during the two intervals and black otherwise
};

// Where the foveation is centred: at the picture's centre, or at the latest gaze, updated every frame.
enum class GazePolicy { center, tracked };

// How scenes are shared out over a testing session.
enum class SceneUse {
    per_session,  // one scene a session, rotating with the participant's index
    crossed       // every condition once with every scene in every session
};

enum class LeadIn { black, fixation };

struct Timing {
    double lead_in_s = 0.5;  // before the first interval
    LeadIn lead_in = LeadIn::fixation;
    double interval_s = 0;                    // each of the two pictures
    double gap_s = 0;                         // black between them
    std::optional<double> response_window_s;  // absent: the question stays until it is answered
};

// In which order a session's conditions come.
enum class ConditionOrder {
    williams,  // Williams square over the conditions (2n rows where n is odd), a row for each participant
    shuffled,  // a random permutation for each participant and block
    listed     // as the protocol lists them
};

// Which of the two intervals shows the reference.
enum class IntervalOrder {
    balanced,         // first in exactly half of a session's condition trials (to one), at random places
    random,           // a fair coin for each trial
    reference_first,  // always
    reference_second  // always
};

struct Design {
    int participants = 0;     // planned, fixed before the data are seen; 0: not stated
    int training_trials = 0;      // distinct conditions drawn at random; not analysed
    int sessions = 1;             // testing sessions
    int repetitions = 1;          // of every condition within a session, block after block
    double validation_share = 0;  // of a testing session's trials; full against full, at random places
    ConditionOrder condition_order = ConditionOrder::williams;
    IntervalOrder interval_order = IntervalOrder::balanced;
    std::uint64_t label_seed =
        1;  // which condition gets which letter of the square; the same for all participants
    SceneUse scene_use = SceneUse::per_session;
};

struct Rests {
    bool after_session = true;
    bool after_failed_validation = true;
    std::optional<int> every_trials;  // a break reminder after so many trials
    double at_least_s = 0;            // a rest cannot be ended sooner
};

// What the buttons mean.
struct Keys {
    Button same = Button::a;
    Button different = Button::b;
    Button proceed = Button::a;  // leaves a page of text
};

// How well the eye tracker must know the eye, before the session and between its blocks.
struct CalibrationRules {
    int targets = 9;         // 5, 9 or 13
    double extent_deg = 15;  // farthest target from straight ahead; less where the picture ends sooner
    double each_s = 1.5;     // a target stays; the first half second is the eye's way there and is not used
    double greatest_mean_accuracy_deg = 2;  // no go beyond, ...
    double greatest_loss_share = 0.2;  // ... beyond this share of lost samples, or without data at a target
    // One target in the middle after each rest and at the start of each session; no go where the gaze misses
    // it by more. Measured and stored, never corrected. Absent: no drift check.
    std::optional<double> drift_check_deg;
};

// When a trial does not count, decided before the session. An absent rule is not applied.
struct ValidityRules {
    std::optional<double>
        gaze_off_center_deg;  // a tracked sample farther from the centre, in either interval
    std::optional<double>
        gaze_off_share;  // ... tolerated up to this share of the tracked samples (default 0)
    std::optional<double> gaze_lost_share;  // blinks, losses and silences, of the intervals' samples
    std::optional<double> gaze_age_ms;      // the oldest gaze any frame of the intervals was drawn with
    std::optional<int> missed_frames;       // more missed refreshes than this in the two intervals together
    bool unanswered = true;                 // no answer in time
    int repeats = 1;                        // how often an invalid trial is shown again, at its session's end
};

// Which participants the analysis leaves out, fixed before their data are seen.
struct ExclusionRules {
    std::optional<double>
        failed_validation_share;  // more of the validation trials than this called "different"
    std::optional<double>
        invalid_trial_share;  // more of the condition trials than this left without a valid answer
};

// What an interrupted session may do, by how long it was left.
enum class ResumePolicy { resume, restart_block, refuse };
struct ResumeRules {
    double restart_after_h = 1;  // older than this: the running session (block) starts over
    double refuse_after_h = 24;  // older than this: not at all
    ResumePolicy policy(double age_h) const {
        if (age_h > refuse_after_h) return ResumePolicy::refuse;
        return age_h > restart_after_h ? ResumePolicy::restart_block : ResumePolicy::resume;
    }
};

// What the participant reads. "{trial}", "{trials}", "{session}" and "{sessions}" are replaced when shown.
struct Texts {
    std::string introduction, calibration, recalibrate, training, session, question, rest,
        rest_after_failed_validation, paused, finished;
};

// What is asked beside the trials.
struct Questions {
    bool consent = false;                // a consent record is required before the first gaze sample
    int minimum_age_years = 0;           // 0: not asked
    bool vision = false;                 // normal or corrected-to-normal vision is asked
    bool sickness_before_after = false;  // Simulator Sickness Questionnaire
};

// A procedure that chooses the level of one number of the method from the answers so far, instead of constant
// stimuli: each condition gets one of its own in each testing session. See study/adaptive.h.
struct Procedure {
    std::string parameter;                // e.g. "sigma"
    Staircase staircase;                  // its levels are the procedure's
    std::optional<QuestPlus> quest_plus;  // in place of the staircase
};

struct Protocol {
    std::string name;  // also names files; letters, digits, '-' and '_'
    StudyKind kind = StudyKind::free;
    std::string description;
    std::string language = "en";
    DisplaySetting display;
    std::vector<std::string> scenes;  // built-in names or glTF paths
    GazePolicy foveation_gaze = GazePolicy::center;
    double gaze_stale_after_ms = 100;  // tracked: gaze older than this at display is a fallback frame
    Timing timing;
    MethodSetting reference;                // one side of every pair
    std::vector<MethodSetting> conditions;  // the other side, in the order listed (first factor slowest)
    std::vector<std::string> factors;    // the parameters that differ between conditions, in the file's order
    std::optional<Procedure> procedure;  // absent: constant stimuli
    Design design;
    Rests rests;
    Keys keys;
    CalibrationRules calibration;
    ValidityRules validity;
    ExclusionRules exclusion;
    ResumeRules resume;
    Questions questions;
    std::map<std::string, Texts> texts;  // by language

    std::string source;     // the TOML text itself
    std::string file_name;  // as given

    const Texts& text() const { return texts.at(language); }
    int conditions_per_session() const;
    int validation_per_session() const;  // rounded to whole trials
};

// One mistake in a protocol, e.g. line 12 "expected a number above 0, found \"two\"; write e.g. interval_s
// = 2.5".
struct ProtocolMistake {
    int line = 0;  // 1 for what is missing from the whole file
    std::string message;
};

// What parse_protocol throws: every mistake at once. what() is "file:line: message", one line for each.
class ProtocolError : public std::runtime_error {
  public:
    ProtocolError(const std::string& file_name, std::vector<ProtocolMistake> found);
    const std::vector<ProtocolMistake>& mistakes() const { return mistakes_; }

  private:
    std::vector<ProtocolMistake> mistakes_;
};

// Reads a protocol, strictly: an unknown key, a wrong type or a value out of range is a mistake. Throws
// ProtocolError.
Protocol parse_protocol(std::string_view text, const std::string& file_name);

// Reads a file. Throws ProtocolError, or std::runtime_error where the file cannot be read.
Protocol load_protocol(const std::filesystem::path& path);

// 16 hexadecimal digits that change with any byte of the protocol's text (FNV-1a, 64 bits).
std::string protocol_hash(const Protocol& protocol);

// The name of a button in protocols and logs: "a", "left_shoulder", ...
std::string_view button_name(Button button);
std::optional<Button> button_from_name(std::string_view name);

}  // namespace parafovea
