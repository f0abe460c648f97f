// The oculomotor model, run in steps of 4 ms; saccades are closed forms between the steps.
#include "devices/simulated/simulated_eye.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace parafovea {
namespace {

constexpr Duration kStep = {4'000'000};
constexpr Duration kMicrosaccadeRefractory = {100'000'000};

// A saccade's velocity has infinite tails; this much of each is played.
constexpr double kSaccadeTail_s = 0.030;
// The movement passes 30 deg/s, its visible onset, about this long after its first played moment.
constexpr Duration kSaccadeOnset = {20'000'000};

// The antiderivative of the rising velocity profile of Dai et al. 2016.
double saccade_f(double t) {
    return t >= 0 ? t + 0.25 * std::exp(-2 * t) : 0.25 * std::exp(2 * t);
}

DirectionDeg operator+(DirectionDeg a, DirectionDeg b) {
    return {a.azimuth_deg + b.azimuth_deg, a.elevation_deg + b.elevation_deg};
}
DirectionDeg operator-(DirectionDeg a, DirectionDeg b) {
    return {a.azimuth_deg - b.azimuth_deg, a.elevation_deg - b.elevation_deg};
}
DirectionDeg operator*(double factor, DirectionDeg a) {
    return {factor * a.azimuth_deg, factor * a.elevation_deg};
}
double length_deg(DirectionDeg a) {
    return std::hypot(a.azimuth_deg, a.elevation_deg);
}

}  // namespace

SimulatedEye::SimulatedEye(std::uint64_t seed, HostTime start, const SimulatedEyeSettings& settings)
    : settings_(settings),
      drift_random_(Random::stream(seed, "eye drift")),
      saccade_random_(Random::stream(seed, "saccades")),
      blink_random_(Random::stream(seed, "blinks")),
      time_(start) {
    saccades_.push_back({start - saccade_duration(0), {}, {}});
    drifts_.push_back({});
    draw_blink(start);
}

void SimulatedEye::fixate(HostTime now, DirectionDeg target) {
    assert(now + kStep >= time_ && "fixate() in the past");
    advance_to(now);
    if (target == target_) return;
    target_ = target;
    const double latency_s =
        saccade_random_.lognormal(settings_.saccade_latency_median_s, settings_.saccade_latency_sigma);
    next_saccade_ = now + Duration::from_seconds(std::clamp(latency_s, 0.1, 0.4)) - kSaccadeOnset;
    next_is_correction_ = false;
}

DirectionDeg SimulatedEye::direction(HostTime time) {
    advance_to(time);
    DirectionDeg d = anchor(time) + drift(time);
    if (const Blink* blink = blink_at(time)) d.elevation_deg -= blink->transient_deg * lid_closure(time);
    return d;
}

double SimulatedEye::lid_closure(HostTime time) {
    advance_to(time);
    const Blink* blink = blink_at(time);
    if (!blink) return 0;
    if (time < blink->closed)
        return (time - blink->lid_falls).seconds() / (blink->closed - blink->lid_falls).seconds();
    if (time < blink->opens) return 1;
    return (blink->open - time).seconds() / (blink->open - blink->opens).seconds();
}

void SimulatedEye::advance_to(HostTime time) {
    assert(time_ - time <= kHistory && "asked about a time the eye has forgotten");
    while (time_ < time) step();
}

void SimulatedEye::step() {
    time_ = time_ + kStep;
    const double dt = kStep.seconds();

    // Drift, by the exact transition of the Ornstein-Uhlenbeck process.
    const double keep = std::exp(-settings_.drift_return_per_s * dt);
    const double stationary_sd =
        std::sqrt(settings_.drift_diffusion_deg2_per_s / settings_.drift_return_per_s);
    const double sd = stationary_sd * std::sqrt(1 - keep * keep);
    const DirectionDeg kick{drift_random_.normal(0, sd), drift_random_.normal(0, sd)};
    drifts_.push_back(keep * drifts_.back() + kick);

    // Blinks come whatever the eye does.
    if (time_ >= blinks_.back().open) draw_blink(blinks_.back().open);

    // One movement at a time: a saccade that is due, else perhaps a microsaccade, else plan a correction.
    const Saccade& last = saccades_.back();
    const HostTime last_end = last.start + saccade_duration(length_deg(last.by));
    const DirectionDeg error = error_now();
    const bool micro_due = saccade_random_.chance(settings_.microsaccade_rate_hz * dt);
    if (time_ >= last_end) {
        if (next_saccade_ && time_ >= *next_saccade_) {
            const double gain = next_is_correction_ ? 1 : settings_.saccade_gain;
            const double along = gain + saccade_random_.normal(0, settings_.saccade_scatter);
            const double across = saccade_random_.normal(0, settings_.saccade_scatter);
            start_saccade(time_, {along * error.azimuth_deg - across * error.elevation_deg,
                                  along * error.elevation_deg + across * error.azimuth_deg});
            next_saccade_.reset();
        } else if (micro_due && !next_saccade_ && time_ - last_end >= kMicrosaccadeRefractory) {
            const double amplitude = std::min(
                saccade_random_.lognormal(settings_.microsaccade_median_deg, settings_.microsaccade_sigma),
                settings_.microsaccade_limit_deg);
            const bool homing = saccade_random_.chance(settings_.microsaccade_homing);
            const double any_way = saccade_random_.uniform(0, 2 * std::numbers::pi);
            const double heading = homing ? std::atan2(error.elevation_deg, error.azimuth_deg) : any_way;
            start_saccade(time_, {amplitude * std::cos(heading), amplitude * std::sin(heading)});
        } else if (!next_saccade_ && length_deg(error) > settings_.correction_above_deg) {
            next_saccade_ = time_ + Duration::from_seconds(saccade_random_.uniform(0.1, 0.2)) - kSaccadeOnset;
            next_is_correction_ = true;
        }
    }

    // Forget what nobody may ask about any more.
    const HostTime oldest = time_ - kHistory - kStep;
    while (drifts_.size() > static_cast<std::size_t>(kHistory.ns / kStep.ns) + 2) drifts_.pop_front();
    while (saccades_.size() > 1 && saccades_[1].start < oldest) saccades_.pop_front();
    while (blinks_.size() > 1 && blinks_.front().open < oldest) blinks_.pop_front();
}

void SimulatedEye::draw_blink(HostTime after) {
    // A lognormal with the given mean and SD.
    const double ratio = settings_.blink_interval_sd_s / settings_.blink_interval_mean_s;
    const double sigma = std::sqrt(std::log(1 + ratio * ratio));
    const double median_s = settings_.blink_interval_mean_s / std::sqrt(1 + ratio * ratio);
    const double interval_s = blink_random_.lognormal(median_s, sigma);
    const double closed_s =
        std::clamp(blink_random_.lognormal(settings_.blink_duration_median_s, settings_.blink_duration_sigma),
                   0.08, 0.5);
    Blink blink;
    blink.lid_falls = after + Duration::from_seconds(interval_s);
    blink.closed = blink.lid_falls + Duration::from_seconds(blink_random_.uniform(0.02, 0.05));
    blink.opens = blink.closed + Duration::from_seconds(closed_s);
    blink.open = blink.opens + Duration::from_seconds(blink_random_.uniform(0.02, 0.05));
    blink.transient_deg = blink_random_.uniform(1, 2);
    blinks_.push_back(blink);
}

void SimulatedEye::start_saccade(HostTime start, DirectionDeg by) {
    const Saccade& last = saccades_.back();
    saccades_.push_back({start, last.from + last.by, by});
}

Duration SimulatedEye::saccade_duration(double amplitude_deg) const {
    return Duration::from_seconds(amplitude_deg / settings_.saccade_speed_deg_per_s + 2 * kSaccadeTail_s);
}

DirectionDeg SimulatedEye::anchor(HostTime time) const {
    auto later = std::upper_bound(saccades_.begin(), saccades_.end(), time,
                                  [](HostTime t, const Saccade& s) { return t < s.start; });
    if (later == saccades_.begin()) return saccades_.front().from;
    const Saccade& saccade = *std::prev(later);
    const double amplitude = length_deg(saccade.by);
    const double t = (time - saccade.start).seconds();
    const double duration = saccade_duration(amplitude).seconds();
    if (amplitude == 0 || t >= duration) return saccade.from + saccade.by;

    const double c = settings_.saccade_scale_deg, rate = settings_.saccade_speed_deg_per_s / c;
    const auto travelled = [&](double at) {
        return c *
               (saccade_f(rate * (at - kSaccadeTail_s)) - saccade_f(rate * (at - duration + kSaccadeTail_s)));
    };
    const double begin = travelled(0), end = travelled(duration);
    return saccade.from + ((travelled(t) - begin) / (end - begin)) * saccade.by;
}

DirectionDeg SimulatedEye::drift(HostTime time) const {
    const double steps_back = static_cast<double>((time_ - time).ns) / static_cast<double>(kStep.ns);
    const double position = std::max(0.0, static_cast<double>(drifts_.size() - 1) - steps_back);
    const auto index = static_cast<std::size_t>(position);
    if (index + 1 >= drifts_.size()) return drifts_.back();
    const double fraction = position - static_cast<double>(index);
    return (1 - fraction) * drifts_[index] + fraction * drifts_[index + 1];
}

const SimulatedEye::Blink* SimulatedEye::blink_at(HostTime time) const {
    for (auto blink = blinks_.rbegin(); blink != blinks_.rend(); ++blink) {
        if (time >= blink->open) return nullptr;
        if (time >= blink->lid_falls) return &*blink;
    }
    return nullptr;
}

DirectionDeg SimulatedEye::error_now() const {
    return target_ - (anchor(time_) + drifts_.back());
}

}  // namespace parafovea
