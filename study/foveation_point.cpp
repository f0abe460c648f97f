// The latest gaze in pixels, with its fallbacks.
#include "study/foveation_point.h"

namespace parafovea {

FoveationPoint::FoveationPoint(const Protocol& protocol, const ViewGeometry& view)
    : tracked_(protocol.foveation_gaze == GazePolicy::tracked),
      stale_after_(Duration::from_ms(protocol.gaze_stale_after_ms)),
      view_(view) {}

void FoveationPoint::take(std::span<const GazeSample> samples) {
    for (const GazeSample& sample : samples) {
        newest_has_direction_ = sample.direction.has_value();
        if (sample.direction) last_valid_ = sample;
    }
}

FoveationPoint::Choice FoveationPoint::choose() const {
    Choice choice;
    choice.point = centre_of(view_.size);
    if (!tracked_ || !last_valid_) return choice;
    choice.point = view_.point_from_direction(*last_valid_->direction);
    choice.gaze_sequence = last_valid_->sequence;
    choice.seen = last_valid_->host_time;
    choice.newest_has_direction = newest_has_direction_;
    return choice;
}

bool FoveationPoint::is_fallback(const Choice& choice, HostTime display_time) const {
    if (!tracked_) return false;
    return !choice.seen || !choice.newest_has_direction || display_time - *choice.seen > stale_after_;
}

}  // namespace parafovea
