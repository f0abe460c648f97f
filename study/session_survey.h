// What an overview of many session files needs of each, in few and light queries.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "devices/geometry.h"
#include "study/session_log.h"
#include "study/trial_record.h"

namespace parafovea {

class Database;

// Whose session of which study it is.
struct SessionHead {
    std::string protocol_name;
    std::string protocol_text;
    std::string protocol_file;
    std::string protocol_hash;
    SessionFacts facts;
    std::int64_t answers = 0;  // showings answered, training included
    std::map<std::string, std::map<std::string, std::string>> questionnaires;
};

// A frame as it was seen, and a gaze as it was measured, without what only a replay needs.
struct FrameTime {
    Phase phase = Phase::lead_in;
    HostTime display;
    std::optional<Duration> gaze_age;
};
struct GazeDirection {
    HostTime time;
    std::optional<DirectionDeg> direction;  // absent: blink or loss
};

// One file held open, for one thread at a time. Throws std::runtime_error where the file is not a session or
// is damaged.
class SessionSurvey {
  public:
    explicit SessionSurvey(const std::filesystem::path& path);
    ~SessionSurvey();

    SessionHead head();

    // Of one showing (TrialRow::shown), in the order they came. Each table is read once from its beginning to
    // its end: ask for showings in the order shown.
    std::vector<FrameTime> frame_times(int shown);
    std::vector<GazeDirection> gaze_directions(int shown);

  private:
    class Rows;
    std::unique_ptr<Database> database_;
    std::unique_ptr<Rows> frames_, gaze_;  // absent before their first use
};

}  // namespace parafovea
