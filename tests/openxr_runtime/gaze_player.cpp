// Plays gaze, round after round.
#include "tests/openxr_runtime/gaze_player.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "devices/gaze_recording.h"

namespace parafovea::headset {

GazePlayer::GazePlayer(const Settings& settings)
    : kind_(settings.gaze), latency_(std::llround(settings.gaze_latency_ms * 1e6)) {
    if (kind_ == GazeKind::recording) {
        const GazeRecording recording = read_gaze_recording(settings.recording);
        samples_ = recording.samples;
        if (samples_.empty())
            throw std::runtime_error(settings.recording.string() + ": the recording holds no samples");
        for (const GazeSample& sample : samples_)
            offsets_.push_back((sample.host_time - samples_.front().host_time).ns);
        length_ = offsets_.back() + std::llround(1e9 / recording.rate_hz);
    } else if (kind_ == GazeKind::fixed) {
        GazeSample sample;
        sample.status = GazeStatus::tracked;
        sample.direction = settings.fixed_gaze;
        samples_.push_back(sample);
        offsets_.push_back(0);
        length_ = std::llround(1e9 / 120);
    }
}

XrTime GazePlayer::made(std::int64_t index) const {
    const auto count = static_cast<std::int64_t>(offsets_.size());
    return start_ + index / count * length_ + offsets_[static_cast<std::size_t>(index % count)];
}

PlayedGaze GazePlayer::at(XrTime asked, XrTime now) const {
    const XrTime latest = now - latency_;
    if (!present() || latest < start_) return {};

    // The last sample made at or before a time.
    const auto index_before = [this](XrTime time) {
        const XrDuration since = std::max<XrDuration>(time - start_, 0);
        const auto within = std::upper_bound(offsets_.begin(), offsets_.end(), since % length_);
        return since / length_ * static_cast<std::int64_t>(offsets_.size()) + (within - offsets_.begin()) - 1;
    };
    std::int64_t index = index_before(std::min(asked, latest));
    if (asked < latest && made(index + 1) <= latest && made(index + 1) - asked < asked - made(index)) ++index;

    const GazeSample& sample = samples_[static_cast<std::size_t>(index) % samples_.size()];
    return {sample.direction ? sample.status : GazeStatus::lost, sample.direction.value_or(DirectionDeg{}),
            made(index)};
}

}  // namespace parafovea::headset
