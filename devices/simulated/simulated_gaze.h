// A simulated eye tracker like the FOVE 0, watching a simulated eye.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "devices/clock.h"
#include "devices/clock_mapping.h"
#include "devices/gaze_source.h"
#include "devices/random.h"
#include "devices/simulated/simulated_eye.h"

namespace parafovea {

// How well the tracker measures. Defaults imitate a FOVE 0 worn by people like those of the jemr2022 data set
// (Vive Pro Eye, 18 people x 10 sessions: mean error 0.83 deg at the centre, 1.18 deg at 14 deg
// eccentricity).
struct SimulatedGazeSettings {
    std::uint64_t seed = 1;         // this session: everything but the person's own offset
    std::uint64_t person_seed = 1;  // this person: the part of the offset that stays from session to session
    std::optional<std::uint64_t> fit_seed;  // how the headset sits this time; absent: drawn from seed

    double rate_hz = 120;                            // FOVE 0
    Duration latency = Duration::from_ms(14);        // exposure to availability, FOVE 0's stated figure
    Duration arrival_jitter = Duration::from_ms(1);  // SD of the normal whose magnitude is added (guess)
    int bunch = 1;                          // samples handed over together; 2 imitates Windows' camera driver
    double clock_skew = 0;                  // the device clock gains this many seconds a second
    DeviceTime clock_epoch{5'000'000'000};  // what the device clock reads when the session starts

    double offset_sd_azimuth_deg = 0.29,
           offset_sd_elevation_deg = 0.45;  // jemr2022; half person, half session
    double field_sd_deg = 0.54;  // per axis: error that depends on where one looks; fitted to jemr2022
    double field_growth_per_deg = 0.042;    // and grows with eccentricity; fitted to jemr2022
    double slow_drift_deg_per_10min = 0.2;  // guess
    double noise_sd_deg = 0.14;  // per eye and axis (guess: no published figure for the FOVE's raw vectors)
    double noise_correlation = 0.3;  // from sample to sample
    double low_accuracy_beyond_deg = 25;

    double drop_probability = 0.01;  // single frames that never arrive (guess)
    double loss_rate_hz = 0.03;      // eye open but not found (guess)
    double loss_mean_s = 0.12;

    SimulatedEyeSettings eye = {};
};

// The participant's eye and the tracker in one: tell the eye where to look, drain what the tracker saw.
// Samples are made as the clock advances, each from where the eye truly was at its exposure; the same seeds
// and the same calls give the same samples. Not thread safe. The clock must outlive it.
class SimulatedGaze final : public GazeSource {
  public:
    explicit SimulatedGaze(Clock& clock, const SimulatedGazeSettings& settings = {});

    // From now on the participant looks at `target`; the eye gets there after a saccade latency and the
    // saccade.
    void fixate(DirectionDeg target);

    // Where the eye truly points at `time` (not later than now, not older than SimulatedEye::kHistory), which
    // no tracker knows.
    DirectionDeg true_direction(HostTime time);
    DirectionDeg true_direction() { return true_direction(clock_.now()); }

    // Whether the lid covers the pupil at `time`: the participant sees nothing.
    bool eye_closed(HostTime time);
    bool eye_closed() { return eye_closed(clock_.now()); }

    // Host times are mapped from the tracker's own clock, as for a real one whose latency is known.
    void drain(std::vector<GazeSample>& samples) override;
    std::string description() const override;

    // The offset that the tracker adds, without its position-dependent part and slow drift.
    DirectionDeg constant_offset() const { return offset_; }

  private:
    // A smooth error over the field of view: a few plane waves an axis.
    struct Wave {
        double per_azimuth_deg, per_elevation_deg, phase;
    };
    static constexpr int kWaves = 6;

    HostTime exposure(std::int64_t index) const;
    void prepare_next();
    GazeSample measure();
    DirectionDeg field_error(DirectionDeg d) const;

    Clock& clock_;
    SimulatedGazeSettings settings_;
    HostTime start_;
    SimulatedEye eye_;
    Random noise_random_, timing_random_, loss_random_;

    DirectionDeg offset_, eye_offset_, slow_drift_;
    std::array<std::array<Wave, kWaves>, 2> waves_;
    std::array<DirectionDeg, 2> noise_;  // left, right
    double pupil_mm_;
    HostTime loss_begins_, loss_ends_;

    std::int64_t next_index_ = -1;
    HostTime next_arrival_;
    ClockMapping mapping_;
    bool next_dropped_ = false;
};

}  // namespace parafovea
