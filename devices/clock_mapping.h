// Maps a device's own clock to the host's from the times at which its samples arrived, with an error bound.
#pragma once

#include <deque>
#include <optional>

#include "devices/time.h"

namespace parafovea {

struct ClockMappingSettings {
    // The least time between the moment a sample is about and its arrival (exposure, transfer, processing),
    // and how well that is known. Nothing in the data can reveal it: a constant latency looks just like an
    // offset of the clocks.
    Duration least_latency = {};
    Duration least_latency_error = {};

    Duration resolution = {1'000'000};       // of the device's clock
    double greatest_skew = 500e-6;           // relative; crystals keep within 100e-6
    Duration bucket = {1'000'000'000};       // of each such span the least delayed sample is kept
    int buckets = 30;                        // how many spans are remembered
    Duration expected_jitter = {5'000'000};  // mean excess delay assumed before any is seen

    // A sample that is this much earlier than the mapping allows proves that the device's clock was reset;
    // one that is this much later may be a stall, and proves it only when all samples of `late_for` are.
    Duration reset_jump = {100'000'000};
    Duration late_for = {1'000'000'000};
};

struct MappedTime {
    HostTime time;
    Duration error;  // half-width: the truth lies within time +- error
};

// A line below all (device time, arrival - device time) pairs of the last half minute, as near to them as can
// be: the lower envelope (Moon, Skelly and Towsley 1999). Delays only ever add, so bunched, late and jittery
// arrivals lie above the line and do not move it. The raw pairs stay with the samples; the mapping alters
// neither.
class ClockMapping {
  public:
    explicit ClockMapping(const ClockMappingSettings& settings = {}) : settings_(settings) {}

    // Takes a sample into account and maps its device time. Arrivals come in the order of time.
    MappedTime map(DeviceTime device, HostTime arrival);

    // How often the device's clock began anew (device unplugged, firmware restarted).
    int resets() const { return resets_; }

    // Seconds the device's clock gains on the host's each second; nothing until ten seconds have been seen.
    std::optional<double> skew() const;

  private:
    struct Pair {
        double device_s;   // since reference_device_
        double offset_ns;  // arrival - device, less reference_offset_ns_
    };

    void start(DeviceTime device, HostTime arrival);
    void add(const Pair& pair);
    void fit();
    double envelope_ns(double device_s) const { return intercept_ns_ + slope_ns_per_s_ * device_s; }

    ClockMappingSettings settings_;
    bool started_ = false;
    int resets_ = 0;
    DeviceTime reference_device_, last_device_;
    std::int64_t reference_offset_ns_ = 0;
    std::deque<Pair> least_;  // of each bucket, oldest first
    std::int64_t bucket_ = 0;
    double intercept_ns_ = 0, slope_ns_per_s_ = 0;
    bool slope_known_ = false;
    double excess_sum_ns_ = 0;
    std::int64_t count_ = 0;
    std::optional<HostTime> late_since_;
};

}  // namespace parafovea
