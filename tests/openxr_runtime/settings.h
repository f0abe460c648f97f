// How the simulated headset behaves: read from the environment variable PARAFOVEA_HEADSET.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "devices/geometry.h"

namespace parafovea::headset {

// What can be made to happen at a frame. Frames count from 0, at each return of xrWaitFrame over the life of
// the instance.
enum class EventKind {
    late,            // the frame is granted `count` refreshes too late
    negative_time,   // for `count` frames the predicted display time is negative
    backwards_time,  // for `count` frames it lies five refreshes back
    gaze_missing,    // for `count` frames the eye tracker is active but sees no eye
    gaze_inactive,   // for `count` frames it is not active at all
    unfocused,       // another application has the input for `count` frames: state VISIBLE
    hidden,          // nothing of ours is shown for `count` frames: state SYNCHRONIZED
    stopping,        // the headset is taken off, and put on again once the application has ended the session
    exiting,         // the user quits: STOPPING, then EXITING
    session_lost,    // the session is lost; a new one can be made
    recentred,       // the user recentres: LOCAL turns to where the head looks now
    capture,         // for `count` frames what is shown is written to the folder of capture=
};

struct ScriptedEvent {
    EventKind kind = EventKind::late;
    std::int64_t frame = 0;
    std::int64_t count = 1;
};

enum class SampleTimes { made, zero, echo };  // what XrEyeGazeSampleTimeEXT gets; runtimes differ
enum class GazeKind { none, fixed, recording };

struct Settings {
    bool simulated_pacing = false;  // time moves only in xrWaitFrame, by whole refreshes
    int views = 2;                  // 1, 2 or 4
    double refresh_hz = 70;
    int shrink = 1;  // recommended pictures are so many times smaller each way
    GazeKind gaze = GazeKind::fixed;
    DirectionDeg fixed_gaze;
    std::filesystem::path recording;  // played from the session's begin, over and over
    double gaze_latency_ms = 15;      // from a sample's time until it can be had
    SampleTimes sample_times = SampleTimes::made;
    bool plugged_in = true;
    std::vector<std::string> without;  // extensions that are not offered
    std::filesystem::path log;         // CSV, a line a frame
    std::filesystem::path capture;     // folder of frame_<n>_view_<i>.ppm
    std::filesystem::path control;     // a growing file: each new line KIND[:COUNT] happens at the next frame
    std::vector<ScriptedEvent> events;
};

// Entries separated by ';' or line ends: NAME=VALUE as above, or KIND@FRAME[:COUNT].
//   pacing=simulated;views=2;gaze=fixed:5,-3;negative_time@120;late@200:3
//   gaze=none, gaze=fixed:AZIMUTH,ELEVATION in degrees, or gaze=FILE of a recording.
// Throws std::runtime_error naming the entry.
Settings parse_settings(std::string_view text);

// KIND[:COUNT], at the given frame.
ScriptedEvent parse_event(std::string_view text, std::int64_t frame);

}  // namespace parafovea::headset
