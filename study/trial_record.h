// What happened in one trial: everything the log keeps of it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "devices/controller_source.h"
#include "devices/gaze_source.h"
#include "study/stage.h"
#include "study/trial_plan.h"

namespace parafovea {

enum class Phase { lead_in, first_interval, gap, second_interval, question };

struct FrameRecord {
    Phase phase = Phase::lead_in;
    ShownFrame shown;
    PointPx fovea;          // where a stimulus was foveated; the centre in other phases
    bool fallback = false;  // tracked foveation without fresh gaze: last valid, or the centre
    std::optional<std::int64_t>
        gaze_sequence;                 // the sample the fovea came from; absent with foveation at the centre
    std::optional<Duration> gaze_age;  // that sample's age at display
    int gaze_known = 0;    // gaze samples of the trial that had arrived when the frame was prepared
    int events_known = 0;  // controller events of the trial that had arrived when it had been shown
};

// One phase of whole frames. Durations are rounded to frames of the real rate once, before the trial.
struct IntervalRecord {
    Phase phase = Phase::lead_in;
    int intended_frames = 0;   // refreshes it should last; 0 for the question, which ends with the answer
    int presented_frames = 0;  // pictures shown; a missed refresh costs one, so that the duration is kept
    HostTime first_display, last_display;  // of the first and the last frame
    HostTime end;                          // last_display plus one frame period
    TimeSource time_source = TimeSource::predicted;
    int missed_vsyncs = 0;   // refreshes on which a frame of this phase stayed on for want of the next
    Duration longest_frame;  // longest time between two of its frames' display times
};

// Presses before the question or of other keys are events, not answers.
struct Answer {
    bool identical = false;
    Button button = Button::a;
    HostTime time;
    Duration reaction;  // from the question's first display
};

struct TrialRecord {
    PlannedTrial planned;
    int attempt = 0;              // 0, or how often this planned trial had been shown before
    std::optional<double> level;  // of an adaptive procedure's parameter
    HostTime started;
    std::array<IntervalRecord, 5> intervals;  // by Phase
    std::vector<FrameRecord> frames;
    std::vector<GazeSample> gaze;         // all that arrived during the trial
    std::vector<ControllerEvent> events;  // all since the trial, or the page, before
    std::optional<Answer> answer;         // none: the window ended first
    std::vector<std::string> invalid;     // which validity rules it broke, e.g. "missed_frames"; empty: valid
    bool interrupted = false;             // stopped from outside: no answer, and it will be shown again
};

// FNV-1a (64 bits) over every value of the record but those of the plan. It is stored with the record, so
// that a change of any stored value is noticed.
std::uint64_t content_hash(const TrialRecord& record);

}  // namespace parafovea
