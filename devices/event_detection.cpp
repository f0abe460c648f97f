// I-VT and I-DT over samples with gaps.
#include "devices/event_detection.h"

#include <algorithm>
#include <cmath>

#include "devices/unit_vector.h"

namespace parafovea {
namespace {

// Two samples further apart than this many median intervals have a gap between them.
constexpr double kGapIntervals = 2.5;

Duration median_interval(std::span<const GazeSample> samples) {
    std::vector<Duration> intervals;
    for (std::size_t i = 1; i < samples.size(); ++i)
        intervals.push_back(samples[i].host_time - samples[i - 1].host_time);
    if (intervals.empty()) return {};
    const auto middle = intervals.begin() + static_cast<std::ptrdiff_t>(intervals.size() / 2);
    std::nth_element(intervals.begin(), middle, intervals.end());
    return *middle;
}

// Whether the directions of samples i - 1 and i may be connected.
class Continuity {
  public:
    explicit Continuity(std::span<const GazeSample> samples)
        : samples_(samples),
          longest_{std::llround(kGapIntervals * static_cast<double>(median_interval(samples).ns))} {}

    bool joined(std::size_t i) const {
        return samples_[i - 1].direction && samples_[i].direction &&
               samples_[i].host_time - samples_[i - 1].host_time <= longest_;
    }

  private:
    std::span<const GazeSample> samples_;
    Duration longest_;
};

DirectionDeg mean_of(std::span<const GazeSample> samples, std::size_t first, std::size_t last) {
    Vector3 sum;
    for (std::size_t i = first; i <= last; ++i)
        if (samples[i].direction) sum = sum + unit_vector(*samples[i].direction);
    return direction_of(sum);
}

EyeEvent event_of(EyeEventKind kind, std::span<const GazeSample> samples, std::size_t first,
                  std::size_t last) {
    EyeEvent event;
    event.kind = kind;
    event.first = first;
    event.last = last;
    event.begin = samples[first].host_time;
    event.end = samples[last].host_time;
    if (samples[first].direction && samples[last].direction) {
        event.from = *samples[first].direction;
        event.to = *samples[last].direction;
        event.amplitude_deg = angle_between_deg(event.from, event.to);
        event.centre = mean_of(samples, first, last);
    }
    return event;
}

std::vector<EyeEvent> find_gaps(std::span<const GazeSample> samples, const GapSettings& settings) {
    const bool device_tells = std::any_of(samples.begin(), samples.end(),
                                          [](const GazeSample& s) { return s.status == GazeStatus::blink; });
    std::vector<EyeEvent> gaps;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (samples[i].direction) continue;
        std::size_t last = i;
        bool blink = samples[i].status == GazeStatus::blink;
        while (last + 1 < samples.size() && !samples[last + 1].direction) {
            ++last;
            blink = blink || samples[last].status == GazeStatus::blink;
        }
        if (!device_tells) {
            // The lid was down at most from the sample before to the sample after.
            const HostTime before = samples[i > 0 ? i - 1 : i].host_time;
            const HostTime after = samples[std::min(last + 1, samples.size() - 1)].host_time;
            blink = after - before >= settings.shortest_blink &&
                    samples[last].host_time - samples[i].host_time <= settings.longest_blink;
        }
        gaps.push_back(event_of(blink ? EyeEventKind::blink : EyeEventKind::loss, samples, i, last));
        i = last;
    }
    return gaps;
}

void sort_by_time(std::vector<EyeEvent>& events) {
    std::stable_sort(events.begin(), events.end(),
                     [](const EyeEvent& a, const EyeEvent& b) { return a.first < b.first; });
}

}  // namespace

std::vector<std::optional<double>> gaze_velocity(std::span<const GazeSample> samples, Duration window) {
    const Continuity continuity(samples);
    std::vector<std::optional<double>> velocities(samples.size());
    const Duration half{window.ns / 2};
    for (std::size_t i = 0; i < samples.size(); ++i) {
        // Reach out to the neighbours, and further while they are within the window.
        std::size_t first = i, last = i;
        while (first > 0 && continuity.joined(first) &&
               (first == i || samples[i].host_time - samples[first - 1].host_time <= half))
            --first;
        while (last + 1 < samples.size() && continuity.joined(last + 1) &&
               (last == i || samples[last + 1].host_time - samples[i].host_time <= half))
            ++last;
        const double dt = (samples[last].host_time - samples[first].host_time).seconds();
        if (dt > 0)
            velocities[i] = angle_between_deg(*samples[first].direction, *samples[last].direction) / dt;
    }
    return velocities;
}

std::vector<EyeEvent> detect_by_velocity(std::span<const GazeSample> samples,
                                         const VelocityThresholdSettings& settings, const GapSettings& gaps) {
    const Continuity continuity(samples);
    const auto velocities = gaze_velocity(samples, settings.velocity_window);
    std::vector<EyeEvent> fixations, events;

    // Runs of fast and of slow samples.
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!velocities[i]) continue;
        const bool fast = *velocities[i] > settings.velocity_deg_per_s;
        double peak = *velocities[i];
        std::size_t last = i;
        while (last + 1 < samples.size() && velocities[last + 1] && continuity.joined(last + 1) &&
               (*velocities[last + 1] > settings.velocity_deg_per_s) == fast)
            peak = std::max(peak, *velocities[++last]);
        EyeEvent event = event_of(fast ? EyeEventKind::saccade : EyeEventKind::fixation, samples, i, last);
        event.peak_velocity_deg_per_s = fast ? peak : 0;
        (fast ? events : fixations).push_back(event);
        i = last;
    }

    // Join fixations that noise or a short gap broke in two; what moved between them was no saccade.
    std::vector<EyeEvent> joined;
    for (const EyeEvent& fixation : fixations) {
        // Look back past fixations too short to stand.
        std::size_t partner = joined.size();
        while (partner > 0) {
            const EyeEvent& earlier = joined[--partner];
            if (fixation.begin - earlier.end < settings.merge_gap &&
                angle_between_deg(fixation.centre, earlier.centre) < settings.merge_angle_deg) {
                const std::size_t first = earlier.first;
                std::erase_if(events,
                              [&](const EyeEvent& e) { return e.first > first && e.last < fixation.last; });
                joined.resize(partner);
                joined.push_back(event_of(EyeEventKind::fixation, samples, first, fixation.last));
                break;
            }
            if (earlier.end - earlier.begin >= settings.shortest_fixation) partner = 0;
        }
        if (joined.empty() || joined.back().last != fixation.last) joined.push_back(fixation);
    }
    std::erase_if(joined, [&](const EyeEvent& f) { return f.end - f.begin < settings.shortest_fixation; });

    events.insert(events.end(), joined.begin(), joined.end());
    const auto missing = find_gaps(samples, gaps);
    events.insert(events.end(), missing.begin(), missing.end());
    sort_by_time(events);
    return events;
}

std::vector<EyeEvent> detect_by_dispersion(std::span<const GazeSample> samples,
                                           const DispersionThresholdSettings& settings,
                                           const GapSettings& gaps) {
    const Continuity continuity(samples);
    std::vector<EyeEvent> events = find_gaps(samples, gaps);
    for (std::size_t first = 0; first < samples.size();) {
        if (!samples[first].direction) {
            ++first;
            continue;
        }
        // Let the window grow for as long as its directions stay together.
        DirectionDeg low = *samples[first].direction, high = low;
        std::size_t last = first;
        while (last + 1 < samples.size() && continuity.joined(last + 1)) {
            const DirectionDeg d = *samples[last + 1].direction;
            low = {std::min(low.azimuth_deg, d.azimuth_deg), std::min(low.elevation_deg, d.elevation_deg)};
            high = {std::max(high.azimuth_deg, d.azimuth_deg), std::max(high.elevation_deg, d.elevation_deg)};
            const double dispersion =
                high.azimuth_deg - low.azimuth_deg + high.elevation_deg - low.elevation_deg;
            if (dispersion > settings.dispersion_deg) break;
            ++last;
        }
        if (last > first &&
            samples[last].host_time - samples[first].host_time >= settings.shortest_fixation) {
            events.push_back(event_of(EyeEventKind::fixation, samples, first, last));
            first = last + 1;
        } else {
            ++first;
        }
    }
    sort_by_time(events);
    return events;
}

}  // namespace parafovea
