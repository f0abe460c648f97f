// What a trial needs from whatever shows pictures: "show this for one frame; tell me when it was seen".
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "devices/geometry.h"
#include "devices/time.h"
#include "study/protocol.h"

namespace parafovea {

// What is on the screen during one frame.
enum class PictureKind { black, fixation, stimulus, question, text, target };

struct Picture {
    PictureKind kind = PictureKind::black;
    std::string scene;     // stimulus only: a scene's name or glTF path
    MethodSetting method;  // stimulus only: how it is rendered
    PointPx fovea;         // stimulus: where the foveation is centred; target: where the dot to look at is
    std::string text;      // text and question only
    // The photodiode's patch in a corner: white (true) during the two intervals, else black. Absent: no
    // patch.
    std::optional<bool> patch;
};

enum class TimeSource { predicted, compositor, gpu, simulated };

struct ShownFrame {
    std::int64_t index = 0;  // counts every frame of the session
    HostTime display_time;   // when the frame is (predicted to be) seen
    TimeSource time_source = TimeSource::predicted;
    int missed_vsyncs = 0;  // refreshes since the previous frame beyond the one expected
    std::optional<Duration> gpu_time;
    std::optional<std::uint64_t> image_hash;  // of the rendered pixels, where the stage rendered this frame
    std::string fault;  // what the display did wrong, e.g. "display_time_backwards"; empty: nothing
};

class Stage {
  public:
    virtual ~Stage() = default;

    // Shows the picture for exactly one refresh and returns when the next one may be prepared.
    virtual ShownFrame show(const Picture& picture) = 0;

    virtual double refresh_hz() const = 0;
    virtual ViewGeometry view() const = 0;
};

}  // namespace parafovea
