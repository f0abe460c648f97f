// One participant's session on disk: an SQLite file that survives a crash at any moment.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/time.h"
#include "study/protocol.h"
#include "study/trial_plan.h"
#include "study/trial_record.h"

namespace parafovea {

// Who, where and with what: stored once, when the file is created.
struct SessionFacts {
    std::string uuid;         // see make_uuid
    std::string participant;  // a pseudonym
    std::string program_version;
    std::string display;  // descriptions of the devices
    std::string gaze_source;
    std::string controller;
    std::string device;  // what renders, and its driver
    std::string driver;
    double refresh_hz = 0;                     // the stage's real rate
    ViewGeometry view;                         // the stage's; the protocol's where its size is left at 0
    bool simulated_people = false;             // answers and gaze come from a simulated participant
    std::map<std::string, std::string> other;  // anything else worth keeping, by name
};

// The same moment on the host's monotonic clock and on the wall clock (UTC, ns since 1970).
struct ClockAnchor {
    HostTime host;
    std::int64_t wall_ns = 0;
};
ClockAnchor read_clock_anchor(HostTime now);

// Version 4, from the system's randomness.
std::string make_uuid();

// What happened to one showing of a planned trial, as far as what comes next depends on it.
struct ShownTrial {
    int number = 0;
    int attempt = 0;
    bool answered = false;
    bool identical = false;
    bool valid = false;
    bool interrupted = false;
    bool superseded = false;      // to be shown again by decision
    std::optional<double> level;  // of an adaptive procedure's parameter
};

struct CalibrationPoint {
    DirectionDeg target;
    std::optional<DirectionDeg> measured;  // mean direction; absent where no sample was valid
    int samples = 0, valid_samples = 0;
    std::optional<double> accuracy_deg, precision_rms_deg, precision_sd_deg;
};
struct CalibrationRecord {
    std::string kind = "calibration";  // or "drift check"
    std::string method;                // who calibrated, e.g. "device", "validation only"
    HostTime started, ended;
    bool accepted = false;
    std::optional<double> mean_accuracy_deg, worst_accuracy_deg, data_loss_share;
    std::vector<CalibrationPoint> points;
    std::vector<GazeSample> gaze;  // all that it was measured from; read back with read_gaze_between
};

// Every append returns at once: a thread of its own writes, one transaction for each, and what durable() or
// wait_until_durable() confirms is on the disk (WAL, synchronous = FULL). What the disk refuses is thrown, as
// one clear line, from the next call. The file is readable by its owner alone. A second process is refused
// the same file. Calls come from one thread.
class SessionLog {
  public:
    // Stores protocol, facts and the whole plan, durable on return. Throws std::runtime_error where the file
    // exists or cannot be made. `vfs` names another SQLite VFS than the default.
    static SessionLog create(const std::filesystem::path& path, const SessionFacts& facts,
                             const Protocol& protocol, const TrialPlan& plan, ClockAnchor anchor,
                             const char* vfs = nullptr);

    // Opens a file to go on with. Throws std::runtime_error where it is missing, damaged, from a newer
    // program, or in use.
    static SessionLog open_to_resume(const std::filesystem::path& path, ClockAnchor anchor);

    SessionLog(SessionLog&&) noexcept;
    ~SessionLog();  // writes what is queued

    const Protocol& protocol() const;
    const TrialPlan& plan() const;
    const std::vector<ShownTrial>& shown() const;            // oldest first, those of earlier runs included
    bool page_was_left(const std::string& page) const;       // by append_page, in this run or an earlier one
    bool was_asked(const std::string& questionnaire) const;  // likewise, by append_questionnaire
    bool simulated_people() const;
    bool resumed() const;  // opened, not created
    bool finished() const;
    double age_h()
        const;  // hours between the last thing stored by an earlier run and the opening; 0 for a new file

    // The record of one trial with its frames, gaze, events and answer.
    void append(TrialRecord record);

    void append_calibration(CalibrationRecord record);
    // Gaze that belongs to no showing; `phase` says to what, e.g. "before trial 7" or a page's name.
    void append_gaze(std::string phase, std::vector<GazeSample> samples);
    void append_page(HostTime time, const std::string& page);  // the participant left this page of text
    void append_event(HostTime time, std::string kind,
                      std::string detail);              // "pause", "resumed", "stopped", ...
    void append_note(HostTime time, std::string text);  // the operator's words
    void append_questionnaire(HostTime time, std::string name, std::map<std::string, std::string> answers);
    void supersede_trial(int trial_number);  // its showings so far no longer count; they stay in the file
    void supersede_session(int session);     // ... for all its trials, and its pages come again
    void finish(HostTime time);              // every trial is settled

    bool durable();  // everything appended so far is on the disk
    void wait_until_durable();

  private:
    struct State;
    explicit SessionLog(std::unique_ptr<State> state);
    static void write_new_file(State& state, const SessionFacts& facts, const Protocol& protocol,
                               const TrialPlan& plan, ClockAnchor anchor);
    std::unique_ptr<State> state_;
};

}  // namespace parafovea
