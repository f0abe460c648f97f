// A psychometric function: P("different") against the strength of the foveation, its likelihood and its
// priors.
#include "analysis/psychometric_function.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/special_functions/digamma.hpp>
#include <boost/math/special_functions/gamma.hpp>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace parafovea {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kBetaPrior = 10.0;
const double kLogBetaPrior = std::log(kBetaPrior);
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

// The derivative of S by t, where S is the value.
double standard_slope(Sigmoid sigmoid, double t, double value) {
    switch (sigmoid) {
        case Sigmoid::logistic:
            return kLogisticSpan * value * (1.0 - value);
        case Sigmoid::normal:
            return kNormalSpan * std::exp(-0.5 * kNormalSpan * kNormalSpan * t * t) *
                   (std::numbers::inv_sqrtpi / std::numbers::sqrt2);
        case Sigmoid::weibull: {
            const double u = std::exp(kWeibullSpan * t + kWeibullShift);
            return std::isfinite(u) ? kWeibullSpan * u * std::exp(-u) : 0.0;
        }
    }
    return 0.0;
}

// The logarithm of a product of powers: one logarithm for a handful of factors is cheaper than one each, and
// loses nothing.
class LogProduct {
  public:
    void multiply(double base, std::int64_t power) {
        if (power > 64 || base < 1e-3) {
            if (power > 0) sum_ += static_cast<double>(power) * std::log(base);
            return;
        }
        for (; power > 0; power >>= 1, base *= base)
            if (power & 1) product_ *= base;
        if (product_ < 1e-100) {
            sum_ += std::log(product_);
            product_ = 1.0;
        }
    }
    double log() const { return sum_ + std::log(product_); }

  private:
    double sum_ = 0.0, product_ = 1.0;
};

constexpr std::int64_t kFewFactors = 256;

// log of the rising products prod (a + i) prod (b + i) / prod (a + b + i), which is the beta-binomial
// likelihood.
double log_beta_binomial(std::int64_t k, std::int64_t rest, double a, double b) {
    const double total = a + b;
    if (k + rest > kFewFactors) {
        using boost::math::lgamma;
        double sum = lgamma(total) - lgamma(total + static_cast<double>(k + rest));
        if (k > 0) sum += lgamma(a + static_cast<double>(k)) - lgamma(a);
        if (rest > 0) sum += lgamma(b + static_cast<double>(rest)) - lgamma(b);
        return sum;
    }
    LogProduct product;
    double i = 0.0;
    for (std::int64_t j = 0; j < k; ++j, i += 1.0)
        product.multiply((a + static_cast<double>(j)) / (total + i), 1);
    for (std::int64_t j = 0; j < rest; ++j, i += 1.0)
        product.multiply((b + static_cast<double>(j)) / (total + i), 1);
    return product.log();
}

// The derivative of log prod (a + i), i < n, by a.
double rising_slope(double a, std::int64_t n) {
    if (n > kFewFactors) return boost::math::digamma(a + static_cast<double>(n)) - boost::math::digamma(a);
    double sum = 0.0;
    for (std::int64_t i = 0; i < n; ++i) sum += 1.0 / (a + static_cast<double>(i));
    return sum;
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

double PsychometricPosterior::log_likelihood(const PsychometricParameters& p,
                                             PsychometricParameters* slope) const {
    const double threshold = place_of(model_.sigmoid, p.threshold), variance = p.eta * p.eta;
    const double strength = 1.0 / variance - 1.0, span = 1.0 - p.lambda - p.gamma;
    const bool binomial = variance <= 1e-9;
    LogProduct product;
    double sum = 0.0;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        const std::int64_t different = levels_[i].different, same = levels_[i].n - different;
        const double t = (places_[i] - threshold) / p.width, s = standard_sigmoid(model_.sigmoid, t);
        const double psi = std::clamp(p.gamma + span * s, 1e-300, 1.0 - 1e-16);
        if (binomial) {
            product.multiply(psi, different);
            product.multiply(1.0 - psi, same);
        } else {
            sum += log_beta_binomial(different, same, psi * strength, (1.0 - psi) * strength);
        }
        if (slope == nullptr) continue;
        double by_psi = static_cast<double>(different) / psi - static_cast<double>(same) / (1.0 - psi);
        if (!binomial) {
            const double by_a = rising_slope(psi * strength, different),
                         by_b = rising_slope((1.0 - psi) * strength, same);
            by_psi = strength * (by_a - by_b);
            slope->eta -= 2.0 / (variance * p.eta) *
                          (psi * by_a + (1.0 - psi) * by_b - rising_slope(strength, levels_[i].n));
        }
        const double by_t = by_psi * span * standard_slope(model_.sigmoid, t, s);
        slope->threshold -= by_t / p.width;
        slope->width -= by_t * t / p.width;
        slope->lambda -= by_psi * s;
        slope->gamma += by_psi * (1.0 - s);
    }
    return sum + product.log();
}

double PsychometricPosterior::log_prior(const PsychometricParameters& p,
                                        PsychometricParameters* slope) const {
    if (p.lambda < 0.0 || p.lambda > 0.5 || p.gamma < 0.0 || p.gamma > 0.5 || p.eta < 0.0 || p.eta >= 1.0 ||
        p.width <= 0.0)
        return -kInfinity;
    if (model_.sigmoid == Sigmoid::weibull && p.threshold <= 0.0) return -kInfinity;
    const double m = place_of(model_.sigmoid, p.threshold), span = range_.high - range_.low;
    constexpr double kPi = std::numbers::pi;
    double sum = 0.0;
    // A fall from 1 to 0 as a cosine does from 0 to pi; `by` is the derivative of the angle.
    const auto fall = [&](double angle, double by, double PsychometricParameters::*parameter) {
        sum += std::log((1.0 + std::cos(angle)) / 2.0);
        if (slope) slope->*parameter -= by * std::tan(angle / 2.0);
    };

    const double beyond = std::max(range_.low - m, m - range_.high);
    if (beyond >= span / 2.0) return -kInfinity;
    if (beyond > 0.0)
        fall(2.0 * kPi * beyond / span, (m > range_.high ? 2.0 : -2.0) * kPi / span,
             &PsychometricParameters::threshold);

    if (p.width < spacing_ || p.width > 3.0 * span) return -kInfinity;
    if (p.width < 2.0 * spacing_)
        fall(kPi * (2.0 * spacing_ - p.width) / spacing_, -kPi / spacing_, &PsychometricParameters::width);
    else if (p.width > span)
        fall(kPi / 2.0 * (p.width - span) / span, kPi / 2.0 / span, &PsychometricParameters::width);

    // Beta(1, 10) of each rate.
    double none = 1.0;
    for (double PsychometricParameters::*rate :
         {&PsychometricParameters::lambda, &PsychometricParameters::gamma, &PsychometricParameters::eta}) {
        if (rate == &PsychometricParameters::gamma && model_.asymptotes == Asymptotes::fixed) continue;
        sum += kLogBetaPrior;
        none *= 1.0 - p.*rate;
        if (slope) slope->*rate -= (kBetaPrior - 1.0) / (1.0 - p.*rate);
    }
    return sum + (kBetaPrior - 1.0) * std::log(none);
}

double PsychometricPosterior::log_likelihood(const PsychometricParameters& p) const {
    return log_likelihood(p, nullptr);
}

double PsychometricPosterior::log_posterior(const PsychometricParameters& p) const {
    const double prior = log_prior(p, nullptr);
    return std::isfinite(prior) ? prior + log_likelihood(p, nullptr) : -kInfinity;
}

double PsychometricPosterior::log_posterior(const PsychometricParameters& p,
                                            PsychometricParameters& slope) const {
    slope = {0.0, 0.0, 0.0, 0.0, 0.0};
    const double prior = log_prior(p, &slope);
    return std::isfinite(prior) ? prior + log_likelihood(p, &slope) : -kInfinity;
}

}  // namespace parafovea
