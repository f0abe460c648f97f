// Plain rows out of a session file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "devices/gaze_source.h"
#include "study/method_setting.h"
#include "study/session_log.h"
#include "study/trial_plan.h"
#include "study/trial_record.h"

namespace parafovea {

// One showing of a planned trial.
struct TrialRow {
    PlannedTrial planned;         // as planned: an adaptive procedure's level is beside it
    std::optional<double> level;  // see study/adaptive.h, at_level
    int attempt = 0;
    int shown = 0;  // order of showing in the session, from 0
    HostTime started;
    std::optional<Answer> answer;
    std::vector<std::string> invalid;
    bool interrupted = false;
    bool superseded = false;
    std::vector<IntervalRecord> intervals;

    // This showing is the one the analysis uses.
    bool counts() const { return answer.has_value() && invalid.empty() && !interrupted && !superseded; }
};

struct EventRow {
    HostTime time;
    std::string kind, detail;
};

struct SessionRows {
    std::string protocol_name;
    std::string protocol_text;
    std::string protocol_file;
    std::string protocol_hash;
    SessionFacts facts;
    std::vector<ClockAnchor> anchors;  // one for the start and one for each resumption
    TrialPlan plan;
    bool finished = false;
    std::vector<TrialRow> trials;  // in the order shown
    std::vector<EventRow> events;
    std::vector<EventRow> notes;
    std::vector<CalibrationRecord> calibrations;  // drift checks too; without their gaze
    std::map<std::string, std::map<std::string, std::string>> questionnaires;

    // The last one that is no drift check; null where there is none.
    const CalibrationRecord* last_calibration() const;
};

// Everything but frames, gaze and button events, which are read trial by trial. Throws std::runtime_error
// where the file is not a session or is damaged.
SessionRows read_session(const std::filesystem::path& path);

// One showing, complete: a row of read_session with its frames, gaze and button events.
struct StoredTrial {
    TrialRecord record;
    std::optional<std::uint64_t> content_hash;  // as it was when written; absent in files of version 1
};
StoredTrial read_trial(const std::filesystem::path& path, const TrialRow& row);

// Its parts, in order.
std::vector<FrameRecord> read_frames(const std::filesystem::path& path, int trial_number, int attempt = 0);
std::vector<GazeSample> read_gaze(const std::filesystem::path& path, int trial_number, int attempt = 0);
std::vector<ControllerEvent> read_controller_events(const std::filesystem::path& path, int trial_number,
                                                    int attempt = 0);

// Gaze that belongs to no showing, in the order of arrival.
struct GazeBetween {
    std::string phase;  // as in SessionLog::append_gaze
    GazeSample sample;
};
std::vector<GazeBetween> read_gaze_between(const std::filesystem::path& path);

}  // namespace parafovea
