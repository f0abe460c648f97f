// What the operator may know and ask for, between the session's thread and the console's.
#pragma once

#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "devices/clock.h"
#include "devices/gaze_source.h"
#include "study/session_runner.h"
#include "study/stage.h"

namespace parafovea {

struct AnsweredTrial {
    int number = 0;
    TrialKind kind = TrialKind::condition;
    std::string condition;  // what was compared with the reference
    std::optional<bool> identical;
    double reaction_s = 0;
    std::string invalid;  // the rules it broke
};

// One moment of a session.
struct OperatorView {
    std::string state;  // as in SessionProgress
    int done = 0, total = 0, session = 0, sessions = 0;
    std::optional<PlannedTrial> trial;   // running now
    Picture picture;                     // on the screen now
    std::vector<AnsweredTrial> answers;  // newest first
    int answered = 0, identical = 0, failed_validations = 0, invalid = 0;
    std::optional<double> seconds_left;  // by the pace so far, pages and rests included

    std::vector<GazeSample> gaze;  // of the last second
    double gaze_rate_hz = 0;       // delivered in the last second
    double gaze_lost_share = 0;    // of the last ten seconds' samples: blinks and losses
    bool gaze_silent = false;      // nothing for half a second

    std::vector<double> frame_ms;  // times between the last frames
    int missed = 0;                // refreshes missed within trials
    double refresh_hz = 0;
    std::optional<CalibrationRecord> calibration, drift;  // the last ones; drift since that calibration
    bool controller_connected = true;
    OperatorRequest asked = OperatorRequest::none;  // and not served yet
};

// Each call holds a lock for microseconds.
class OperatorBoard {
  public:
    explicit OperatorBoard(Clock& clock) : clock_(clock) {}

    // The console's side.
    OperatorView view() const;
    void ask(OperatorRequest request);
    void write_note(std::string text);

    // The session's side.
    void set_progress(const SessionProgress& progress);
    void add_trial(const TrialRecord& record);
    void add_frame(const Picture& picture, const ShownFrame& shown, double refresh_hz);
    void add_gaze(std::span<const GazeSample> samples);
    void add_calibration(const CalibrationRecord& record);
    OperatorRequest take_request();
    std::vector<std::pair<HostTime, std::string>> take_notes();

  private:
    Clock& clock_;
    mutable std::mutex mutex_;
    OperatorView now_;  // but for what view() works out
    OperatorRequest request_ = OperatorRequest::none;
    std::vector<std::pair<HostTime, std::string>> notes_;
    std::deque<GazeSample> recent_gaze_;
    std::deque<HostTime> recent_frames_;
    std::optional<HostTime> first_trial_;
    int done_at_first_ = 0;
};

// A stage and a gaze source that tell the board what passes through them.
class WatchedStage final : public Stage {
  public:
    WatchedStage(Stage& stage, OperatorBoard& board) : stage_(stage), board_(board) {}
    ShownFrame show(const Picture& picture) override;
    double refresh_hz() const override { return stage_.refresh_hz(); }
    ViewGeometry view() const override { return stage_.view(); }

  private:
    Stage& stage_;
    OperatorBoard& board_;
};

class WatchedGaze final : public GazeSource {
  public:
    WatchedGaze(GazeSource& gaze, OperatorBoard& board) : gaze_(gaze), board_(board) {}
    void drain(std::vector<GazeSample>& samples) override;
    std::string description() const override { return gaze_.description(); }

  private:
    GazeSource& gaze_;
    OperatorBoard& board_;
};

}  // namespace parafovea
