// The lower envelope of arrival delays, kept over a sliding window.
#include "devices/clock_mapping.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace parafovea {
namespace {

// Enough of a baseline for the slope to mean something: jitter of 1 ms over 10 s is 100e-6.
constexpr double kSlopeBaseline_s = 10;

// Of n exponential delays with mean J the least exceeds 5 J / n once in 150 times.
constexpr double kLeastDelayQuantile = 5;

// How many samples' worth the assumed jitter counts against the seen one.
constexpr double kJitterPrior = 4;

}  // namespace

MappedTime ClockMapping::map(DeviceTime device, HostTime arrival) {
    if (!started_) start(device, arrival);

    // A clock that runs backwards has been reset.
    if (device < last_device_) {
        ++resets_;
        start(device, arrival);
    }
    last_device_ = device;

    Pair pair{(device - reference_device_).seconds(),
              static_cast<double>(arrival.ns - device.ns - reference_offset_ns_)};
    double excess_ns = pair.offset_ns - envelope_ns(pair.device_s);
    if (excess_ns > static_cast<double>(settings_.reset_jump.ns)) {
        if (!late_since_) late_since_ = arrival;
    } else {
        late_since_.reset();
    }
    const bool proved_late = late_since_ && arrival - *late_since_ >= settings_.late_for;
    if (count_ > 0 && (excess_ns < -static_cast<double>(settings_.reset_jump.ns) || proved_late)) {
        ++resets_;
        start(device, arrival);
        pair = {0, 0};
    }

    add(pair);
    fit();
    excess_ns = pair.offset_ns - envelope_ns(pair.device_s);
    // A stall says nothing about the jitter of the samples that are not stalled.
    if (!late_since_) excess_sum_ns_ += std::max(0.0, excess_ns);
    ++count_;

    // The error: how far above the truth the least delay may still be, how badly a line fits, what is not
    // known.
    const double jitter_ns =
        (excess_sum_ns_ + kJitterPrior * static_cast<double>(settings_.expected_jitter.ns)) /
        (static_cast<double>(count_) + kJitterPrior);
    double error_ns = static_cast<double>(settings_.least_latency_error.ns + settings_.resolution.ns) +
                      kLeastDelayQuantile * jitter_ns / static_cast<double>(count_);
    // The newest bucket may hold late samples only, so far.
    for (std::size_t i = 0; i + 1 < least_.size(); ++i)
        error_ns = std::max(error_ns, least_[i].offset_ns - envelope_ns(least_[i].device_s));
    if (!slope_known_) error_ns += settings_.greatest_skew * 1e9 * (pair.device_s - least_.front().device_s);

    const auto mapped_ns = static_cast<std::int64_t>(std::llround(envelope_ns(pair.device_s))) +
                           reference_offset_ns_ + device.ns - settings_.least_latency.ns;
    return {{mapped_ns}, {static_cast<std::int64_t>(std::llround(error_ns))}};
}

std::optional<double> ClockMapping::skew() const {
    if (!slope_known_) return std::nullopt;
    return -slope_ns_per_s_ * 1e-9;
}

void ClockMapping::start(DeviceTime device, HostTime arrival) {
    started_ = true;
    reference_device_ = last_device_ = device;
    reference_offset_ns_ = arrival.ns - device.ns;
    least_.clear();
    intercept_ns_ = slope_ns_per_s_ = excess_sum_ns_ = 0;
    slope_known_ = false;
    count_ = 0;
    late_since_.reset();
}

void ClockMapping::add(const Pair& pair) {
    const auto bucket = static_cast<std::int64_t>(std::floor(pair.device_s / settings_.bucket.seconds()));
    if (least_.empty() || bucket != bucket_) {
        bucket_ = bucket;
        least_.push_back(pair);
        if (least_.size() > static_cast<std::size_t>(settings_.buckets)) least_.pop_front();
    } else if (pair.offset_ns < least_.back().offset_ns) {
        least_.back() = pair;
    }
}

void ClockMapping::fit() {
    // Without a baseline: no slope, the least of all.
    if (least_.back().device_s - least_.front().device_s < kSlopeBaseline_s) {
        slope_known_ = false;
        slope_ns_per_s_ = 0;
        intercept_ns_ = std::min_element(least_.begin(), least_.end(), [](const Pair& a, const Pair& b) {
                            return a.offset_ns < b.offset_ns;
                        })->offset_ns;
        return;
    }

    // The lower convex hull, left to right.
    std::vector<Pair> hull;
    const auto turns_left = [](const Pair& a, const Pair& b, const Pair& c) {
        return (b.device_s - a.device_s) * (c.offset_ns - a.offset_ns) -
                   (b.offset_ns - a.offset_ns) * (c.device_s - a.device_s) >
               0;
    };
    double mean_s = 0;
    for (const Pair& pair : least_) {
        while (hull.size() >= 2 && !turns_left(hull[hull.size() - 2], hull.back(), pair)) hull.pop_back();
        hull.push_back(pair);
        mean_s += pair.device_s / static_cast<double>(least_.size());
    }

    // The line under all points with the least sum of distances is the hull's edge over their mean.
    std::size_t edge = 0;
    while (edge + 2 < hull.size() && hull[edge + 1].device_s < mean_s) ++edge;
    const double steepest = settings_.greatest_skew * 1e9;
    slope_ns_per_s_ =
        (hull[edge + 1].offset_ns - hull[edge].offset_ns) / (hull[edge + 1].device_s - hull[edge].device_s);
    slope_ns_per_s_ = std::clamp(slope_ns_per_s_, -steepest, steepest);
    intercept_ns_ = hull[edge].offset_ns - slope_ns_per_s_ * hull[edge].device_s;
    for (const Pair& pair : hull)
        intercept_ns_ = std::min(intercept_ns_, pair.offset_ns - slope_ns_per_s_ * pair.device_s);
    slope_known_ = true;
}

}  // namespace parafovea
