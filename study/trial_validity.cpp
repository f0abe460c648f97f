// The validity rules.
#include "study/trial_validity.h"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace parafovea {
namespace {

const IntervalRecord& of(const TrialRecord& record, Phase phase) {
    return record.intervals[static_cast<std::size_t>(phase)];
}

bool seen_during(const GazeSample& sample, const IntervalRecord& interval) {
    return interval.presented_frames > 0 && sample.host_time >= interval.first_display &&
           sample.host_time < interval.end;
}

struct GazeCounts {
    int all = 0, with_direction = 0, off_center = 0;
};

// The tracker's own rate, from the median spacing of the trial's samples; none where there are too few.
std::optional<Duration> sample_period(const TrialRecord& record) {
    std::vector<std::int64_t> spacing;
    for (std::size_t i = 1; i < record.gaze.size(); ++i)
        spacing.push_back((record.gaze[i].host_time - record.gaze[i - 1].host_time).ns);
    std::erase_if(spacing, [](std::int64_t ns) { return ns <= 0; });
    if (spacing.empty()) return std::nullopt;
    const auto middle = spacing.begin() + static_cast<std::ptrdiff_t>(spacing.size() / 2);
    std::nth_element(spacing.begin(), middle, spacing.end());
    return Duration{*middle};
}

// How many samples a tracker that fell silent did not deliver: those that a span without any, longer than a
// few periods, would have held. Shorter spans are a tracker's jitter.
int samples_missing(HostTime from, HostTime to, Duration period) {
    constexpr std::int64_t kSilentPeriods = 4;
    if (to - from <= period * kSilentPeriods) return 0;
    return static_cast<int>((to - from).ns / period.ns) - 1;
}

GazeCounts count_gaze(const TrialRecord& record, double off_center_deg) {
    GazeCounts counts;
    const std::optional<Duration> period = sample_period(record);
    for (const Phase phase : {Phase::first_interval, Phase::second_interval}) {
        const IntervalRecord& interval = of(record, phase);
        HostTime last = interval.first_display;
        int missing = 0;
        for (const GazeSample& sample : record.gaze) {
            if (!seen_during(sample, interval)) continue;
            if (period) missing += samples_missing(last, sample.host_time, *period);
            last = std::max(last, sample.host_time);
            ++counts.all;
            if (!sample.direction) continue;
            ++counts.with_direction;
            if (angle_between_deg(*sample.direction, {}) > off_center_deg) ++counts.off_center;
        }
        if (period && interval.presented_frames > 0) missing += samples_missing(last, interval.end, *period);
        counts.all += missing;
    }
    return counts;
}

bool any_frame_older(const TrialRecord& record, double age_ms) {
    for (const FrameRecord& frame : record.frames)
        if (frame.gaze_age && frame.gaze_age->ms() > age_ms) return true;
    return false;
}

// A runtime's display times are its own word; one that does not move on means that none of them can be
// trusted.
bool display_times_rise(const TrialRecord& record) {
    for (std::size_t i = 1; i < record.frames.size(); ++i)
        if (record.frames[i].shown.display_time <= record.frames[i - 1].shown.display_time) return false;
    return true;
}

}  // namespace

std::vector<std::string> broken_rules(const TrialRecord& record, const Protocol& protocol) {
    const ValidityRules& rules = protocol.validity;
    std::vector<std::string> broken;
    const GazeCounts gaze = count_gaze(record, rules.gaze_off_center_deg.value_or(180));
    if (rules.gaze_off_center_deg && gaze.off_center > rules.gaze_off_share.value_or(0) * gaze.with_direction)
        broken.push_back("gaze_off_center");
    // No sample at all is the worst loss of all.
    if (rules.gaze_lost_share &&
        (gaze.all == 0 || gaze.all - gaze.with_direction > *rules.gaze_lost_share * gaze.all))
        broken.push_back("gaze_lost");
    if (rules.gaze_age_ms && any_frame_older(record, *rules.gaze_age_ms)) broken.push_back("gaze_age");
    const int missed =
        of(record, Phase::first_interval).missed_vsyncs + of(record, Phase::second_interval).missed_vsyncs;
    if (rules.missed_frames && missed > *rules.missed_frames) broken.push_back("missed_frames");
    if (!display_times_rise(record)) broken.push_back("display_time");
    if (rules.unanswered && !record.answer) broken.push_back("unanswered");
    for (const FrameRecord& frame : record.frames)
        if (!frame.shown.fault.empty() && std::ranges::find(broken, frame.shown.fault) == broken.end())
            broken.push_back(frame.shown.fault);
    return broken;
}

}  // namespace parafovea
