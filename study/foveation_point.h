// Where a stimulus is foveated, frame by frame: at the centre, or at the latest gaze.
#pragma once

#include <optional>
#include <span>

#include "devices/gaze_source.h"
#include "devices/geometry.h"
#include "study/protocol.h"

namespace parafovea {

// With tracked gaze, the latest sample that has a direction decides. In a blink, a loss or a silence of the
// tracker the last such sample goes on deciding; before the first there is the centre. Both are fallbacks
// once the newest sample has no direction, or the sample used is older at display than the protocol allows.
class FoveationPoint {
  public:
    struct Choice {
        PointPx point;
        std::optional<std::int64_t> gaze_sequence;  // of the sample used; absent at the centre
        std::optional<HostTime> seen;               // when the eye was there
        bool newest_has_direction = false;
    };

    FoveationPoint(const Protocol& protocol, const ViewGeometry& view);

    void take(std::span<const GazeSample> samples);
    Choice choose() const;
    bool is_fallback(const Choice& choice, HostTime display_time) const;

  private:
    bool tracked_;
    Duration stale_after_;
    ViewGeometry view_;
    std::optional<GazeSample> last_valid_;
    bool newest_has_direction_ = false;
};

}  // namespace parafovea
