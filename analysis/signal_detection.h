// Same/different answers as signal detection: sensitivity apart from the readiness to say "different".
#pragma once

#include <cstdint>
#include <optional>

namespace parafovea {

struct DetectionRates {
    double hit = 0.5;          // P("different") when the pictures differ
    double false_alarm = 0.5;  // P("different") when they are the same (validation pairs)
};

// (x + 1/2) / (n + 1) for both rates (log-linear, Hautus 1995), so that 0 and 1 give finite answers. Absent
// when either kind of trial is missing.
std::optional<DetectionRates> corrected_rates(std::int64_t hits, std::int64_t different_trials,
                                              std::int64_t false_alarms, std::int64_t same_trials);

// All of the following take rates strictly between 0 and 1.

// z(H) - z(F), and the criterion -(z(H) + z(F)) / 2: positive is a leaning to "same" (Green and Swets 1966).
double yes_no_d_prime(const DetectionRates& rates);
double criterion(const DetectionRates& rates);

// Independent observations, the best an observer can do: 2 z((1 + sqrt(2 Phi((z(H) - z(F)) / 2) - 1)) / 2); 0
// when H <= F (Macmillan and Creelman 2005, ch. 9).
double independent_observation_d_prime(const DetectionRates& rates);

// Differencing, the observer who compares the two intervals: F = 2 Phi(-kappa / sqrt 2),
// H = Phi((d - kappa) / sqrt 2) + Phi((-d - kappa) / sqrt 2); 0 when H <= F (Macmillan and Creelman 2005, ch.
// 9).
double differencing_d_prime(const DetectionRates& rates);

}  // namespace parafovea
