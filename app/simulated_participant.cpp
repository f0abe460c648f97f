// Signal detection by a simulated person, and its mean over people.
#include "app/simulated_participant.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

namespace parafovea {
namespace {

constexpr double kSqrt2 = std::numbers::sqrt2;
constexpr double kDPrimePerJod = 0.953872552;  // sqrt(2) z(0.75)
constexpr double kLog10SensitivitySd = 0.15;
constexpr double kCriterionSd = 0.3;
constexpr double kLeastLapseRate = 0.01, kMostLapseRate = 0.02;
constexpr double kLogResponseTimeSd = 0.2;

double normal_below(double z) {
    return 0.5 * std::erfc(-z / kSqrt2);
}

double says_different(double d_prime, double criterion) {
    return normal_below((d_prime - criterion) / kSqrt2) + normal_below((-d_prime - criterion) / kSqrt2);
}

}  // namespace

ObserverTraits draw_observer_traits(Random& random) {
    ObserverTraits traits;
    traits.sensitivity = std::pow(10, random.normal(0, kLog10SensitivitySd));
    traits.criterion = std::max(random.normal(traits.criterion, kCriterionSd), 0.0);
    traits.lapse_rate = random.uniform(kLeastLapseRate, kMostLapseRate);
    const double pace = random.lognormal(1, kLogResponseTimeSd);
    traits.normal_response_s *= pace;
    traits.normal_response_sd_s *= pace;
    traits.exponential_response_s *= pace;
    return traits;
}

double sensitivity_index(double jod) {
    return kDPrimePerJod * (10 - jod);
}

double probability_of_different(double jod, const ObserverTraits& traits) {
    return traits.lapse_rate / 2 +
           (1 - traits.lapse_rate) * says_different(sensitivity_index(jod), traits.criterion);
}

SimulatedParticipant::SimulatedParticipant(const ObserverTraits& traits, Random random,
                                           PicturePairJudge& judge)
    : traits_(traits), random_(random), judge_(judge) {
    assert(traits.sensitivity > 0 && traits.criterion >= 0 && traits.lapse_rate >= 0 &&
           traits.lapse_rate <= 1);
}

SameDifferentAnswer SimulatedParticipant::answer(const SeenPicture& first, const SeenPicture& second) {
    SameDifferentAnswer answer;
    if (first.gaze && second.gaze) {
        answer.jod = judge_.jod(first.picture, second.picture, *first.gaze, traits_.sensitivity);
        if (*second.gaze != *first.gaze)
            answer.jod = std::max(
                answer.jod, judge_.jod(first.picture, second.picture, *second.gaze, traits_.sensitivity));
    }

    // Every trial takes the same draws, so that one trial's answer does not shift the next one's.
    const bool lapse = random_.chance(traits_.lapse_rate), coin = random_.chance(0.5);
    const double percept_difference = sensitivity_index(answer.jod) + random_.normal() - random_.normal();
    const double normal_part = random_.normal(traits_.normal_response_s, traits_.normal_response_sd_s);
    const double exponential_part = random_.exponential(1);

    const double margin = std::fabs(percept_difference) - traits_.criterion;
    answer.identical = lapse ? coin : margin <= 0;
    const double doubt = lapse ? 0 : std::exp(-std::fabs(margin));
    answer.response_time = Duration::from_seconds(
        std::max(normal_part, 0.0) + traits_.exponential_response_s * (1 + doubt) * exponential_part);
    return answer;
}

double expected_share_identical(const PictureOnDisplay& a, const PictureOnDisplay& b, PointPx gaze,
                                PicturePairJudge& judge) {
    return expected_share_identical([&](double sensitivity) { return judge.jod(a, b, gaze, sensitivity); });
}

double expected_share_identical(const std::function<double(double)>& jod_at) {
    // Gauss-Hermite quadrature with seven nodes: exact for polynomials to degree 13 of a standard normal.
    constexpr std::array<double, 7> kNode = {-3.750439717725742, -2.366759410734541, -1.154405394739968, 0,
                                             1.154405394739968,  2.366759410734541,  3.750439717725742};
    constexpr std::array<double, 7> kWeight = {0.000548268855972, 0.030757123967586, 0.240123178605013,
                                               0.457142857142857, 0.240123178605013, 0.030757123967586,
                                               0.000548268855972};
    double share = 0;
    for (std::size_t s = 0; s < kNode.size(); ++s) {
        const double jod = jod_at(std::pow(10, kLog10SensitivitySd * kNode[s]));
        for (std::size_t c = 0; c < kNode.size(); ++c) {
            ObserverTraits traits;
            traits.criterion += kCriterionSd * kNode[c];
            traits.lapse_rate = (kLeastLapseRate + kMostLapseRate) / 2;
            share += kWeight[s] * kWeight[c] * (1 - probability_of_different(jod, traits));
        }
    }
    return share;
}

}  // namespace parafovea
