// Same/different answers as signal detection: sensitivity apart from the readiness to say "different".
#include "analysis/signal_detection.h"

#include <boost/math/distributions/normal.hpp>
#include <cassert>
#include <cmath>
#include <numbers>

namespace parafovea {
namespace {

double z(double probability) {
    assert(probability > 0.0 && probability < 1.0);
    return boost::math::quantile(boost::math::normal_distribution<double>(), probability);
}

double phi(double x) {
    return 0.5 * std::erfc(-x / std::numbers::sqrt2);
}

}  // namespace

std::optional<DetectionRates> corrected_rates(std::int64_t hits, std::int64_t different_trials,
                                              std::int64_t false_alarms, std::int64_t same_trials) {
    if (different_trials <= 0 || same_trials <= 0) return std::nullopt;
    return DetectionRates{
        (static_cast<double>(hits) + 0.5) / (static_cast<double>(different_trials) + 1.0),
        (static_cast<double>(false_alarms) + 0.5) / (static_cast<double>(same_trials) + 1.0)};
}

double yes_no_d_prime(const DetectionRates& rates) {
    return z(rates.hit) - z(rates.false_alarm);
}

double criterion(const DetectionRates& rates) {
    return -0.5 * (z(rates.hit) + z(rates.false_alarm));
}

double independent_observation_d_prime(const DetectionRates& rates) {
    if (rates.hit <= rates.false_alarm) return 0.0;
    const double correct = phi((z(rates.hit) - z(rates.false_alarm)) / 2.0);
    return 2.0 * z(0.5 * (1.0 + std::sqrt(2.0 * correct - 1.0)));
}

double differencing_d_prime(const DetectionRates& rates) {
    if (rates.hit <= rates.false_alarm) return 0.0;
    const double kappa = -std::numbers::sqrt2 * z(rates.false_alarm / 2.0);
    const auto hit_rate = [&](double d) {
        return phi((d - kappa) / std::numbers::sqrt2) + phi((-d - kappa) / std::numbers::sqrt2);
    };
    // The hit rate rises with d from the false-alarm rate to 1, so halving finds the one solution.
    double low = 0.0, high = 1.0;
    while (hit_rate(high) < rates.hit) high *= 2.0;
    for (int i = 0; i < 200 && high - low > 1e-13 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (hit_rate(middle) < rates.hit ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

}  // namespace parafovea
