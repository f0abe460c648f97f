// How well gaze and timing were recorded, counted while sessions stream past.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/recordings.h"
#include "study/session_log_reader.h"
#include "study/session_survey.h"

namespace parafovea {

// Counts what was recorded while the two pictures of each testing trial were shown, over all sessions.
class RecordingCount {
  public:
    RecordingCount();

    // A session's file begins; its trials follow.
    void begin(const SessionRows& session);

    // One testing trial, in the order shown. Returns its share of samples without a gaze; absent without
    // samples.
    std::optional<double> add(const TrialRow& trial, SessionSurvey& survey);

    // The session's file is done: one row per testing session is added to `recordings().sessions`.
    void finish();

    // Adds what another count, of sessions that come after this one's, has finished.
    void add(const RecordingCount& later);

    // What came so far; gaze and frames absent where none was recorded.
    StudyRecordings recordings() const;

  private:
    struct Session {  // one testing session of the file
        SessionQuality quality;
        std::int64_t samples = 0, tracked = 0;
        double duration_s = 0;
        std::vector<float> gaze_ages_ms;
    };
    void count(DirectionDeg direction);
    void count(Duration frame_interval);

    GazeHeatMap map_;
    FrameTimes frames_;
    std::vector<SessionQuality> finished_;
    std::vector<Session> open_;
    SessionQuality begun_;  // what the rows of one file share
    bool any_gaze_ = false, any_frame_ = false;
};

}  // namespace parafovea
