// Shifts a recording to now and hands its samples over as the clock passes their arrival.
#include "devices/replay_gaze.h"

#include <cassert>
#include <utility>

namespace parafovea {

ReplayGaze::ReplayGaze(Clock& clock, GazeRecording recording, ReplayOptions options)
    : clock_(clock), recording_(std::move(recording)), options_(options) {
    assert(!recording_.samples.empty());
    const GazeSample &first = recording_.samples.front(), &last = recording_.samples.back();
    shift_ = clock.now() - first.host_time;
    const double rate_hz = recording_.rate_hz > 0 ? recording_.rate_hz : 120;
    period_ = last.host_time - first.host_time + Duration::from_seconds(1 / rate_hz);
    sequence_period_ = last.sequence - first.sequence + 1;
}

void ReplayGaze::drain(std::vector<GazeSample>& samples) {
    const HostTime now = clock_.now();
    while (!finished()) {
        GazeSample sample = recording_.samples[next_];
        sample.host_time = sample.host_time + shift_;
        sample.arrival_time = sample.arrival_time + shift_;
        sample.sequence += sequence_shift_;
        if (sample.arrival_time > now) return;
        samples.push_back(sample);
        if (++next_ == recording_.samples.size() && options_.repeat) {
            next_ = 0;
            shift_ = shift_ + period_;
            sequence_shift_ += sequence_period_;
        }
    }
}

std::string ReplayGaze::description() const {
    return "replay of " + recording_.name + ", " + recording_.format + ", " +
           std::to_string(recording_.samples.size()) + " samples" + (options_.repeat ? ", repeating" : "");
}

}  // namespace parafovea
