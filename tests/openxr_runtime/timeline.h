// The simulated headset's time: its refreshes, on the real monotonic clock or on one that only frames move.
#pragma once

#include <openxr/openxr.h>

#include <cstdint>

namespace parafovea::headset {

// XrTime has an epoch of its own, so that whoever takes it for host time is found out.
inline constexpr std::int64_t kEpochNs = 1'000'000'000'000'000;

constexpr XrTime time_from_host(std::int64_t host_ns) {
    return host_ns + kEpochNs;
}
constexpr std::int64_t host_from_time(XrTime time) {
    return time - kEpochNs;
}

// A refresh that was waited for.
struct Refresh {
    XrTime start = 0;      // when the frame's turn begins
    XrTime displayed = 0;  // when a frame that is prepared in that turn is seen
};

class Timeline {
  public:
    Timeline(bool simulated, double refresh_hz);

    XrTime now() const;
    double refresh_hz() const { return refresh_hz_; }
    XrDuration period() const;

    // From now on.
    void set_refresh_hz(double hz);

    // Chooses the first refresh after now and after the last one chosen, plus `late` more.
    Refresh choose_refresh(std::int64_t late);

    // Returns once now() >= time.
    void wait_until(XrTime time);

  private:
    XrTime refresh_time(std::int64_t index) const;

    bool simulated_;
    double refresh_hz_;
    XrTime simulated_now_ = 0;
    XrTime start_ = 0;        // of refresh 0
    std::int64_t last_ = -1;  // refresh chosen last
};

}  // namespace parafovea::headset
