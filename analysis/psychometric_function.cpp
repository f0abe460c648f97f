// A psychometric function: P("different") against the strength of the foveation, its likelihood and its
// priors.
#include "analysis/psychometric_function.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace parafovea {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBetaPrior = 10.0;
constexpr double kNormalSpan = 2.0 * 1.6448536269514722;  // between the 5th and the 95th percentile
const double kLogisticSpan = 2.0 * std::log(1.0 / 0.05 - 1.0);
const double kWeibullShift = std::log(-std::log(0.5));
const double kWeibullSpan = std::log(-std::log(0.05)) - std::log(-std::log(0.95));

// S as a function of (place - threshold) / width.
double standard_sigmoid(Sigmoid sigmoid, double t) {
    switch (sigmoid) {
        case Sigmoid::logistic:
            return 1.0 / (1.0 + std::exp(-kLogisticSpan * t));
        case Sigmoid::normal:
            return 0.5 * std::erfc(-kNormalSpan * t / std::numbers::sqrt2);
        case Sigmoid::weibull:
            return -std::expm1(-std::exp(kWeibullSpan * t + kWeibullShift));
    }
    return 0.0;
}

double standard_quantile(Sigmoid sigmoid, double s) {
    switch (sigmoid) {
        case Sigmoid::logistic:
            return std::log(s / (1.0 - s)) / kLogisticSpan;
        case Sigmoid::normal:
            return boost::math::quantile(boost::math::normal_distribution<double>(), s) / kNormalSpan;
        case Sigmoid::weibull:
            return (std::log(-std::log1p(-s)) - kWeibullShift) / kWeibullSpan;
    }
    return 0.0;
}

double place_of(Sigmoid sigmoid, double x) {
    return sigmoid == Sigmoid::weibull ? std::log(x) : x;
}

// log of the rising products prod (a + i) prod (b + i) / prod (a + b + i), which is the beta-binomial
// likelihood.
double log_beta_binomial(std::int64_t k, std::int64_t rest, double a, double b) {
    const double total = a + b;
    if (k + rest > 256) {
        using boost::math::lgamma;
        double sum = lgamma(total) - lgamma(total + static_cast<double>(k + rest));
        if (k > 0) sum += lgamma(a + static_cast<double>(k)) - lgamma(a);
        if (rest > 0) sum += lgamma(b + static_cast<double>(rest)) - lgamma(b);
        return sum;
    }
    // Few factors: one logarithm per handful is cheaper and loses nothing.
    double sum = 0.0, product = 1.0, i = 0.0;
    const auto factor = [&](double part) {
        product *= part / (total + i);
        i += 1.0;
        if (product < 1e-200) {
            sum += std::log(product);
            product = 1.0;
        }
    };
    for (std::int64_t j = 0; j < k; ++j) factor(a + static_cast<double>(j));
    for (std::int64_t j = 0; j < rest; ++j) factor(b + static_cast<double>(j));
    return sum + std::log(product);
}

double log_beta_prior(double value) {
    if (value == 0.0) return std::log(kBetaPrior);
    return std::log(kBetaPrior) + (kBetaPrior - 1.0) * std::log1p(-value);
}

}  // namespace

double sigmoid_value(Sigmoid sigmoid, double x, double threshold, double width) {
    return standard_sigmoid(sigmoid, (place_of(sigmoid, x) - place_of(sigmoid, threshold)) / width);
}

double psychometric_value(const PsychometricModel& model, const PsychometricParameters& p, double x) {
    return p.gamma + (1.0 - p.lambda - p.gamma) * sigmoid_value(model.sigmoid, x, p.threshold, p.width);
}

std::optional<double> psychometric_inverse(const PsychometricModel& model, const PsychometricParameters& p,
                                           double share) {
    const double s = (share - p.gamma) / (1.0 - p.lambda - p.gamma);
    if (!(s > 0.0 && s < 1.0)) return std::nullopt;
    const double place = place_of(model.sigmoid, p.threshold) + p.width * standard_quantile(model.sigmoid, s);
    const double x = model.sigmoid == Sigmoid::weibull ? std::exp(place) : place;
    return std::isfinite(x) ? std::optional(x) : std::nullopt;
}

PsychometricPosterior::PsychometricPosterior(std::span<const PsychometricLevel> levels,
                                             const PsychometricModel& model)
    : model_(model) {
    // Join the levels of one x.
    std::vector<PsychometricLevel> sorted(levels.begin(), levels.end());
    std::sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
    for (const PsychometricLevel& level : sorted) {
        assert(level.n >= 0 && level.different >= 0 && level.different <= level.n);
        if (level.n == 0) continue;
        if (levels_.empty() || levels_.back().x != level.x) {
            levels_.push_back(level);
        } else {
            levels_.back().n += level.n;
            levels_.back().different += level.different;
        }
    }
    assert(!levels_.empty());
    for (const PsychometricLevel& level : levels_) places_.push_back(place_of(model.sigmoid, level.x));

    // Find the range and the smallest step that the priors rest on.
    range_ = {places_.front(), places_.back()};
    if (model.x_range)
        range_ = {place_of(model.sigmoid, model.x_range->low), place_of(model.sigmoid, model.x_range->high)};
    if (!(range_.high > range_.low)) {
        const double half = std::max(0.5 * std::abs(range_.low), 0.5);  // one level only: any scale must do
        range_ = {range_.low - half, range_.low + half};
    }
    spacing_ = range_.high - range_.low;
    for (std::size_t i = 1; i < places_.size(); ++i)
        spacing_ = std::min(spacing_, places_[i] - places_[i - 1]);
    if (model.x_spacing) spacing_ = *model.x_spacing;
}

double PsychometricPosterior::log_likelihood(const PsychometricParameters& p) const {
    const double threshold = place_of(model_.sigmoid, p.threshold), variance = p.eta * p.eta;
    const double strength = 1.0 / variance - 1.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        const PsychometricLevel& level = levels_[i];
        const double s = standard_sigmoid(model_.sigmoid, (places_[i] - threshold) / p.width);
        const double psi = std::clamp(p.gamma + (1.0 - p.lambda - p.gamma) * s, 1e-300, 1.0 - 1e-16);
        const std::int64_t same = level.n - level.different;
        if (variance <= 1e-9) {
            if (level.different > 0) sum += static_cast<double>(level.different) * std::log(psi);
            if (same > 0) sum += static_cast<double>(same) * std::log1p(-psi);
        } else {
            sum += log_beta_binomial(level.different, same, psi * strength, (1.0 - psi) * strength);
        }
    }
    return sum;
}

double PsychometricPosterior::log_prior(const PsychometricParameters& p) const {
    if (p.lambda < 0.0 || p.lambda > 0.5 || p.gamma < 0.0 || p.gamma > 0.5 || p.eta < 0.0 || p.eta >= 1.0 ||
        p.width <= 0.0)
        return -kInfinity;
    if (model_.sigmoid == Sigmoid::weibull && p.threshold <= 0.0) return -kInfinity;
    const double m = place_of(model_.sigmoid, p.threshold), span = range_.high - range_.low;
    constexpr double kPi = std::numbers::pi;

    double threshold = 1.0;
    const double beyond = std::max(range_.low - m, m - range_.high);
    if (beyond >= span / 2.0) return -kInfinity;
    if (beyond > 0.0) threshold = (1.0 + std::cos(2.0 * kPi * beyond / span)) / 2.0;

    double width = 1.0;
    if (p.width < spacing_ || p.width > 3.0 * span) return -kInfinity;
    if (p.width < 2.0 * spacing_)
        width = (1.0 - std::cos(kPi * (p.width - spacing_) / spacing_)) / 2.0;
    else if (p.width > span)
        width = (1.0 + std::cos(kPi / 2.0 * (p.width - span) / span)) / 2.0;

    // Both are 1, whose logarithm is 0, nearly everywhere.
    double sum = threshold == 1.0 ? 0.0 : std::log(threshold);
    if (width != 1.0) sum += std::log(width);
    sum += log_beta_prior(p.lambda);
    sum += log_beta_prior(p.eta);
    if (model_.asymptotes == Asymptotes::free) sum += log_beta_prior(p.gamma);
    if (model_.asymptotes == Asymptotes::equal) sum += log_beta_prior(p.lambda);  // it stands for both
    return sum;
}

double PsychometricPosterior::log_posterior(const PsychometricParameters& p) const {
    const double prior = log_prior(p);
    return std::isfinite(prior) ? prior + log_likelihood(p) : -kInfinity;
}

}  // namespace parafovea
