// Fits a psychometric function: its most probable parameters, credible intervals, and the threshold at a
// criterion.
#include "analysis/psychometric_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "analysis/quasi_newton.h"
#include "analysis/random_draw.h"

namespace parafovea {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// The free parameters as numbers of order one, and back: place of the threshold in the range, log width in
// ranges, and the square roots of the rates, so that no bound stops the search.
class Scaled {
  public:
    explicit Scaled(const PsychometricPosterior& posterior)
        : model_(posterior.model()),
          low_(posterior.range().low),
          span_(posterior.range().high - posterior.range().low) {}

    std::size_t size() const {
        return 2 + (model_.dispersion == Dispersion::fitted ? 1 : 0) + (model_.fixed_lambda ? 0 : 1) +
               (model_.asymptotes == Asymptotes::free ? 1 : 0);
    }

    PsychometricParameters parameters(std::span<const double> q) const {
        PsychometricParameters p;
        const double place = low_ + q[0] * span_;
        p.threshold = model_.sigmoid == Sigmoid::weibull ? std::exp(place) : place;
        p.width = std::exp(q[1]) * span_;
        std::size_t next = 2;
        if (model_.dispersion == Dispersion::fitted) {
            p.eta = q[next] * q[next];
            ++next;
        }
        p.lambda = model_.fixed_lambda ? *model_.fixed_lambda : q[next] * q[next];
        if (!model_.fixed_lambda) ++next;
        p.gamma = model_.asymptotes == Asymptotes::fixed   ? model_.fixed_gamma
                  : model_.asymptotes == Asymptotes::equal ? p.lambda
                                                           : q[next] * q[next];
        return p;
    }

    // The numbers of given parameters; rates at 0, where a step has no slope, are moved off it.
    std::vector<double> numbers(const PsychometricParameters& p) const {
        const double place = model_.sigmoid == Sigmoid::weibull ? std::log(p.threshold) : p.threshold;
        std::vector<double> q{(place - low_) / span_, std::log(p.width / span_)};
        const auto root = [&](double rate) { q.push_back(std::max(std::sqrt(rate), 0.05)); };
        if (model_.dispersion == Dispersion::fitted) root(p.eta);
        if (!model_.fixed_lambda) root(p.lambda);
        if (model_.asymptotes == Asymptotes::free) root(p.gamma);
        return q;
    }

    // The slope along the numbers, of a slope along the parameters.
    void slope(std::span<const double> q, const PsychometricParameters& along,
               std::span<double> result) const {
        result[0] = along.threshold * span_;
        result[1] = along.width * std::exp(q[1]) * span_;
        std::size_t next = 2;
        const auto root = [&](double by_rate) {
            result[next] = by_rate * 2.0 * q[next];
            ++next;
        };
        const bool equal = model_.asymptotes == Asymptotes::equal;
        if (model_.dispersion == Dispersion::fitted) root(along.eta);
        if (!model_.fixed_lambda) root(along.lambda + (equal ? along.gamma : 0.0));
        if (model_.asymptotes == Asymptotes::free) root(along.gamma);
    }

    // log of |d parameters / d q|, without which a walk over q would not sample the posterior of the
    // parameters.
    double log_jacobian(std::span<const double> q) const {
        double product = 1.0;
        for (std::size_t i = 2; i < q.size(); ++i) product *= q[i];
        return q[1] + std::log(std::max(std::abs(product), 1e-300));
    }

  private:
    PsychometricModel model_;
    double low_, span_;
};

using Draw = std::array<double, 6>;  // threshold, width, lambda, gamma, eta, x at the criterion (infinite
                                     // where it has none)

// Lower triangle of the Cholesky factor of a small symmetric positive matrix.
std::vector<double> cholesky(const std::vector<double>& matrix, std::size_t n) {
    std::vector<double> factor(n * n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j <= i; ++j) {
            double sum = matrix[i * n + j];
            for (std::size_t k = 0; k < j; ++k) sum -= factor[i * n + k] * factor[j * n + k];
            factor[i * n + j] = i == j ? std::sqrt(std::max(sum, 1e-12)) : sum / factor[j * n + j];
        }
    }
    return factor;
}

std::vector<Draw> walk(const PsychometricPosterior& posterior, const Scaled& scaled, std::vector<double> at,
                       const PsychometricFitOptions& options, double* acceptance) {
    const std::size_t n = at.size();
    std::mt19937_64 generator(options.seed);
    const auto log_density = [&](std::span<const double> q) {
        const double value = posterior.log_posterior(scaled.parameters(q));
        return std::isfinite(value) ? value + scaled.log_jacobian(q) : -kInfinity;
    };
    // The most probable rates are often 0, where the density of their square roots vanishes; start beside it.
    for (std::size_t i = 2; i < n; ++i) at[i] = std::max(std::abs(at[i]), 0.1);
    double density = log_density(at);

    std::vector<double> mean = at, covariance(n * n, 0.0), proposal(n), normal(n);
    for (std::size_t i = 0; i < n; ++i) covariance[i * n + i] = 0.01;
    std::vector<double> factor = cholesky(covariance, n);
    const double scale = 2.38 / std::sqrt(static_cast<double>(n));
    const int burn_in = std::max(1000, options.draws / 4);
    int accepted = 0;
    std::vector<Draw> draws;
    draws.reserve(static_cast<std::size_t>(options.draws));
    for (int step = 0; step < burn_in + options.draws; ++step) {
        for (double& value : normal) value = draw_normal(generator);
        for (std::size_t i = 0; i < n; ++i) {
            proposal[i] = at[i];
            for (std::size_t j = 0; j <= i; ++j) proposal[i] += scale * factor[i * n + j] * normal[j];
        }
        const double proposed = log_density(proposal), unit = draw_unit(generator);
        if (proposed >= density || std::log(1.0 - unit) < proposed - density) {
            at = proposal;
            density = proposed;
            accepted += step >= burn_in ? 1 : 0;
        }
        if (step < burn_in) {
            // Learn the shape of the posterior, then hold it, so that the kept walk is a proper one.
            const double weight = 1.0 / (step + 20.0);
            std::vector<double> off(n);
            for (std::size_t i = 0; i < n; ++i) {
                // Roots of rates may change sign without meaning; learn from their size.
                const double value = i >= 2 ? std::abs(at[i]) : at[i];
                off[i] = value - mean[i];
                mean[i] += weight * off[i];
            }
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t j = 0; j < n; ++j)
                    covariance[i * n + j] += weight * (off[i] * off[j] - covariance[i * n + j]);
            if (step % 50 == 49) factor = cholesky(covariance, n);
            continue;
        }
        const PsychometricParameters p = scaled.parameters(at);
        const auto x = psychometric_inverse(options.model, p, options.criterion_share);
        // Above the criterion everywhere: the threshold lies below every x; below it everywhere: above every
        // x.
        const double threshold = x ? *x : p.gamma >= options.criterion_share ? -kInfinity : kInfinity;
        draws.push_back({p.threshold, p.width, p.lambda, p.gamma, p.eta, threshold});
    }
    *acceptance = options.draws > 0 ? static_cast<double>(accepted) / options.draws : 0.0;
    return draws;
}

std::vector<std::string> data_warnings(const std::vector<PsychometricLevel>& levels,
                                       const PsychometricModel& model) {
    std::vector<std::string> warnings;
    std::int64_t most = 0, different = 0, n = 0;
    for (const PsychometricLevel& level : levels) {
        most = std::max(most, level.n);
        different += level.different;
        n += level.n;
    }
    if (levels.size() == 1)
        warnings.push_back("one level of x only: the threshold is the prior's, not the data's");
    if (different == 0)
        warnings.push_back("no answer was \"different\": the threshold lies beyond the tested range");
    if (different == n)
        warnings.push_back("every answer was \"different\": the threshold lies below the tested range");
    if (most == 1) warnings.push_back("one trial per level: overdispersion cannot be told from the function");
    if (levels.size() > 25)
        warnings.push_back("more than 25 levels: join neighbouring ones to see overdispersion");
    if (levels.size() > 3 && most <= 5 && most > 1 && !model.x_range)
        warnings.push_back("at most 5 trials per level: the priors weigh heavily");
    return warnings;
}

// The parameters (as Scaled's numbers) of the highest posterior that lies downhill of the start, or of a few
// places when none is given or the one given has no probability.
Minimum most_probable(const PsychometricPosterior& posterior, const Scaled& scaled,
                      const std::optional<PsychometricParameters>& given) {
    const auto cost = [&](std::span<const double> q, std::span<double> slope) {
        PsychometricParameters along;
        const double value = posterior.log_posterior(scaled.parameters(q), along);
        scaled.slope(q, along, slope);
        for (double& by : slope) by = -by;
        return std::isfinite(value) ? -value : kInfinity;
    };
    if (given && std::isfinite(posterior.log_posterior(*given)))
        return quasi_newton(cost, scaled.numbers(*given), 1e-8);
    const double span = posterior.range().high - posterior.range().low;
    Minimum best{{}, kInfinity};
    for (const auto& [place, width] :
         {std::pair{0.5, -0.4}, std::pair{0.25, -1.0}, std::pair{0.8, -0.8}, std::pair{0.9, -0.1}}) {
        std::vector<double> start(scaled.size(), 0.15);
        start[0] = place;
        start[1] = std::clamp(width, std::log(2.0 * posterior.spacing() / span), 1.0);
        Minimum found = quasi_newton(cost, start, 1e-13);
        if (found.value < best.value) best = std::move(found);
    }
    return best;
}

}  // namespace

std::optional<PsychometricFit> fit_psychometric(std::span<const PsychometricLevel> levels,
                                                const PsychometricFitOptions& options) {
    if (std::none_of(levels.begin(), levels.end(),
                     [](const PsychometricLevel& level) { return level.n > 0; }))
        return std::nullopt;
    const PsychometricPosterior posterior(levels, options.model);
    const Scaled scaled(posterior);
    const Minimum best = most_probable(posterior, scaled, options.start);

    PsychometricFit fit;
    fit.model = options.model;
    fit.best = scaled.parameters(best.at);
    fit.negative_log_posterior = best.value;
    fit.levels = posterior.levels();
    fit.at_criterion.value = psychometric_inverse(options.model, fit.best, options.criterion_share);
    fit.warnings = data_warnings(fit.levels, options.model);
    if (options.draws <= 0) return fit;

    // Read the intervals off a walk over the posterior.
    std::vector<Draw> draws = walk(posterior, scaled, best.at, options, &fit.acceptance);
    std::vector<double> values(draws.size());
    const auto quantiles = [&](std::size_t which) {
        for (std::size_t i = 0; i < draws.size(); ++i) values[i] = draws[i][which];
        const double tail = (1.0 - options.credibility) / 2.0, last = static_cast<double>(draws.size() - 1);
        const auto at = [&](double share) {
            const auto nth = values.begin() + static_cast<std::ptrdiff_t>(std::lround(share * last));
            std::nth_element(values.begin(), nth, values.end());
            return *nth;
        };
        return Interval{at(tail), at(1.0 - tail)};
    };
    fit.threshold = quantiles(0);
    fit.width = quantiles(1);
    fit.lambda = quantiles(2);
    fit.gamma = quantiles(3);
    fit.eta = quantiles(4);
    const Interval at_criterion = quantiles(5);
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (std::isfinite(*middle)) fit.at_criterion.median = *middle;
    if (std::isfinite(at_criterion.low)) fit.at_criterion.low = at_criterion.low;
    if (std::isfinite(at_criterion.high)) fit.at_criterion.high = at_criterion.high;
    return fit;
}

}  // namespace parafovea
