// Where a simulated participant's eye truly points: saccades, fixation jitter and blinks.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "devices/geometry.h"
#include "devices/random.h"
#include "devices/time.h"

namespace parafovea {

// Oculomotor constants. Sources: Dai et al. 2016 (saccade form), Bentivoglio et al. 1997 (blink rate); where
// a line says "typical" it is a value from the general literature, not one measured for this program.
struct SimulatedEyeSettings {
    // Saccades: main sequence Vp = speed (1 - exp(-A / scale)) (Dai et al. 2016).
    double saccade_speed_deg_per_s = 550;
    double saccade_scale_deg = 6;
    double saccade_latency_median_s = 0.190;  // typical, clipped to 0.1 .. 0.4 s
    double saccade_latency_sigma = 0.2;
    double saccade_gain = 0.93;         // mean undershoot, typical 0.90 to 0.95
    double saccade_scatter = 0.03;      // SD of the landing error per degree of amplitude, along and across
    double correction_above_deg = 0.5;  // a larger error is corrected after another 0.1 to 0.2 s

    // Fixation: Ornstein-Uhlenbeck drift and microsaccades (typical).
    double drift_diffusion_deg2_per_s = 0.005;
    double drift_return_per_s = 1.5;
    double microsaccade_rate_hz = 1.2;
    double microsaccade_median_deg = 0.3;
    double microsaccade_sigma = 0.5;
    double microsaccade_limit_deg = 1.0;
    double microsaccade_homing = 0.6;  // share of them that aim back at the target

    // Blinks in primary gaze: interval 6.4 +- 2.4 s, positively skewed (Bentivoglio et al. 1997).
    double blink_interval_mean_s = 6.4;
    double blink_interval_sd_s = 2.4;
    double blink_duration_median_s = 0.170;  // typical, clipped to 0.08 .. 0.5 s
    double blink_duration_sigma = 0.3;
};

// Directions are Fick angles; saccades and jitter are computed as if these were flat, which is true to 1.5 %
// of a movement within 10 degrees of straight ahead.
class SimulatedEye {
  public:
    // How long the past can be asked about.
    static constexpr Duration kHistory{30'000'000'000};

    // The eye rests on straight ahead at `start`.
    SimulatedEye(std::uint64_t seed, HostTime start, const SimulatedEyeSettings& settings = {});

    // From `now` on the participant wants to look at `target`; the eye leaves one saccade latency later.
    // Calls come in the order of time; none may be earlier than the time the eye was last asked about.
    void fixate(HostTime now, DirectionDeg target);

    // Where the eye points at `time`, behind the lid too. Times within kHistory of the latest one asked
    // about.
    DirectionDeg direction(HostTime time);

    // How far the lid is down: 0 open, 1 closed; between them in the 20 to 50 ms around the closed phase.
    double lid_closure(HostTime time);

  private:
    struct Saccade {
        HostTime start;
        DirectionDeg from, by;
    };
    struct Blink {
        HostTime lid_falls, closed, opens, open;
        double transient_deg;  // how far the eye dips
    };

    void advance_to(HostTime time);
    void step();
    void draw_blink(HostTime after);
    void start_saccade(HostTime start, DirectionDeg by);
    Duration saccade_duration(double amplitude_deg) const;
    DirectionDeg anchor(HostTime time) const;  // without drift and blink
    DirectionDeg drift(HostTime time) const;
    const Blink* blink_at(HostTime time) const;
    DirectionDeg error_now() const;

    SimulatedEyeSettings settings_;
    Random drift_random_, saccade_random_, blink_random_;
    HostTime time_;  // the model has been run up to here
    DirectionDeg target_;
    std::optional<HostTime> next_saccade_;
    bool next_is_correction_ = false;
    std::deque<Saccade> saccades_;
    std::deque<DirectionDeg> drifts_;  // one a step, the last at time_
    std::deque<Blink> blinks_;         // the last one lies in the future
};

}  // namespace parafovea
