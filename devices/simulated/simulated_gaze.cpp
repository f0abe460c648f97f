// The measurement model: offset, position-dependent error, coloured noise, latency, jitter, drops and losses.
#include "devices/simulated/simulated_gaze.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace parafovea {
namespace {

// How strongly blinks pull the two eyes towards the nose, as a share of how far they dip.
constexpr double kBlinkNasal = 0.3;
// Half of the difference between the two eyes' offsets, SD per axis; it cancels in the cyclopean direction.
constexpr double kInterocularOffset_deg = 0.3;
constexpr double kPupilMean_mm = 3.5, kPupilPersonSd_mm = 0.5, kPupilNoiseSd_mm = 0.02;

}  // namespace

SimulatedGaze::SimulatedGaze(Clock& clock, const SimulatedGazeSettings& settings)
    : clock_(clock),
      settings_(settings),
      start_(clock.now()),
      eye_(settings.seed, start_, settings.eye),
      noise_random_(Random::stream(settings.seed, "tracker noise")),
      timing_random_(Random::stream(settings.seed, "tracker timing")),
      loss_random_(Random::stream(settings.seed, "tracker losses")),
      mapping_({.least_latency = settings.latency, .resolution = {1000}}) {
    assert(settings.rate_hz > 0 && settings.bunch >= 1 && std::abs(settings.noise_correlation) < 1);

    // Half of the offset's variance belongs to the person, half to this fit of the headset.
    Random person = Random::stream(settings.person_seed, "person");
    Random session = Random::stream(settings.fit_seed.value_or(settings.seed), "session");
    const double half = std::sqrt(0.5);
    offset_.azimuth_deg = settings.offset_sd_azimuth_deg * half * (person.normal() + session.normal());
    offset_.elevation_deg = settings.offset_sd_elevation_deg * half * (person.normal() + session.normal());
    eye_offset_ = {session.normal(0, kInterocularOffset_deg), session.normal(0, kInterocularOffset_deg)};
    pupil_mm_ = std::clamp(person.normal(kPupilMean_mm, kPupilPersonSd_mm), 2.0, 7.0);
    for (auto& axis : waves_)
        for (Wave& wave : axis) {
            const double wavelength_deg = session.uniform(15, 40);
            const double heading = session.uniform(0, 2 * std::numbers::pi);
            wave = {2 * std::numbers::pi / wavelength_deg * std::cos(heading),
                    2 * std::numbers::pi / wavelength_deg * std::sin(heading),
                    session.uniform(0, 2 * std::numbers::pi)};
        }
    for (DirectionDeg& noise : noise_)
        noise = {noise_random_.normal(0, settings.noise_sd_deg),
                 noise_random_.normal(0, settings.noise_sd_deg)};
    loss_begins_ = loss_ends_ = start_;
    prepare_next();
}

void SimulatedGaze::fixate(DirectionDeg target) {
    eye_.fixate(clock_.now(), target);
}

DirectionDeg SimulatedGaze::true_direction(HostTime time) {
    assert(time <= clock_.now());
    return eye_.direction(time);
}

bool SimulatedGaze::eye_closed(HostTime time) {
    assert(time <= clock_.now());
    return eye_.lid_closure(time) > 0.5;
}

void SimulatedGaze::drain(std::vector<GazeSample>& samples) {
    const HostTime now = clock_.now();
    while (next_arrival_ <= now) {
        const GazeSample sample = measure();
        if (!next_dropped_) samples.push_back(sample);
        prepare_next();
    }
}

std::string SimulatedGaze::description() const {
    char text[160];
    std::snprintf(text, sizeof text,
                  "simulated FOVE-like, %g Hz, latency %g ms, noise %g deg, seed %llu, person %llu",
                  settings_.rate_hz, settings_.latency.ms(), settings_.noise_sd_deg,
                  static_cast<unsigned long long>(settings_.seed),
                  static_cast<unsigned long long>(settings_.person_seed));
    return text;
}

HostTime SimulatedGaze::exposure(std::int64_t index) const {
    return start_ + Duration::from_seconds(static_cast<double>(index) / settings_.rate_hz);
}

void SimulatedGaze::prepare_next() {
    ++next_index_;
    // Samples of one bunch are handed over 2 ms apart once the last of them is there.
    const std::int64_t place = next_index_ % settings_.bunch;
    const HostTime ready = exposure(next_index_ - place + settings_.bunch - 1) + settings_.latency;
    const Duration jitter =
        Duration::from_seconds(std::abs(timing_random_.normal(0, settings_.arrival_jitter.seconds())));
    next_arrival_ = std::max(next_arrival_, ready + Duration::from_ms(2) * place + jitter);
    next_dropped_ = timing_random_.chance(settings_.drop_probability);
}

GazeSample SimulatedGaze::measure() {
    const HostTime when = exposure(next_index_);
    const double dt = 1 / settings_.rate_hz;

    // Let everything random that has a memory move on, seen or not.
    const double rho = settings_.noise_correlation;
    const double fresh = settings_.noise_sd_deg * std::sqrt(1 - rho * rho);
    for (DirectionDeg& noise : noise_)
        noise = {rho * noise.azimuth_deg + noise_random_.normal(0, fresh),
                 rho * noise.elevation_deg + noise_random_.normal(0, fresh)};
    const double drift_sd = settings_.slow_drift_deg_per_10min * std::sqrt(0.5 * dt / 600);
    slow_drift_.azimuth_deg += noise_random_.normal(0, drift_sd);
    slow_drift_.elevation_deg += noise_random_.normal(0, drift_sd);
    const double pupil_noise_left = noise_random_.normal(0, kPupilNoiseSd_mm);
    const double pupil_noise_right = noise_random_.normal(0, kPupilNoiseSd_mm);
    if (settings_.loss_rate_hz > 0 && when >= loss_ends_) {
        loss_begins_ = when + Duration::from_seconds(loss_random_.exponential(settings_.loss_rate_hz));
        loss_ends_ =
            loss_begins_ + Duration::from_seconds(loss_random_.exponential(1 / settings_.loss_mean_s));
    }

    GazeSample sample;
    sample.sequence = next_index_;
    sample.device_time = settings_.clock_epoch +
                         Duration::from_seconds((when - start_).seconds() * (1 + settings_.clock_skew));
    sample.arrival_time = next_arrival_;
    if (!next_dropped_) {
        const MappedTime mapped = mapping_.map(sample.device_time, sample.arrival_time);
        sample.host_time = mapped.time;
        sample.host_time_error = mapped.error;
    }
    sample.left.emplace();
    sample.right.emplace();

    const double closure = eye_.lid_closure(when);
    if (closure >= 1) {
        sample.status = GazeStatus::blink;
        return sample;
    }
    if (settings_.loss_rate_hz > 0 && when >= loss_begins_ && when < loss_ends_) {
        sample.status = GazeStatus::lost;
        return sample;
    }

    // Where the eye is, and what the tracker makes of it.
    const DirectionDeg truth = eye_.direction(when);
    const DirectionDeg field = field_error(truth);
    const DirectionDeg seen{
        truth.azimuth_deg + offset_.azimuth_deg + slow_drift_.azimuth_deg + field.azimuth_deg,
        truth.elevation_deg + offset_.elevation_deg + slow_drift_.elevation_deg + field.elevation_deg};
    const double nasal = kBlinkNasal * closure;
    sample.left->direction = {seen.azimuth_deg + eye_offset_.azimuth_deg + nasal + noise_[0].azimuth_deg,
                              seen.elevation_deg + eye_offset_.elevation_deg + noise_[0].elevation_deg};
    sample.right->direction = {seen.azimuth_deg - eye_offset_.azimuth_deg - nasal + noise_[1].azimuth_deg,
                               seen.elevation_deg - eye_offset_.elevation_deg + noise_[1].elevation_deg};
    sample.left->pupil_mm = (pupil_mm_ + pupil_noise_left) * (1 - 0.5 * closure);
    sample.right->pupil_mm = (pupil_mm_ + pupil_noise_right) * (1 - 0.5 * closure);
    sample.direction = {(sample.left->direction->azimuth_deg + sample.right->direction->azimuth_deg) / 2,
                        (sample.left->direction->elevation_deg + sample.right->direction->elevation_deg) / 2};
    const bool far_out = angle_between_deg(*sample.direction, {}) > settings_.low_accuracy_beyond_deg;
    sample.status = far_out ? GazeStatus::low_accuracy : GazeStatus::tracked;
    return sample;
}

DirectionDeg SimulatedGaze::field_error(DirectionDeg d) const {
    double error[2] = {0, 0};
    for (int axis = 0; axis < 2; ++axis)
        for (const Wave& wave : waves_[axis])
            error[axis] += std::cos(wave.per_azimuth_deg * d.azimuth_deg +
                                    wave.per_elevation_deg * d.elevation_deg + wave.phase);
    const double sd =
        settings_.field_sd_deg * (1 + settings_.field_growth_per_deg * angle_between_deg(d, {}));
    const double scale = sd / std::sqrt(kWaves / 2.0);
    return {scale * error[0], scale * error[1]};
}

}  // namespace parafovea
