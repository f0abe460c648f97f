// Psychometric functions: reference fits, recovery of known parameters, coverage-relevant algebra and
// extremes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "analysis/psychometric_fit.h"
#include "analysis/random_draw.h"
#include "tests/analysis/nelder_mead.h"

namespace parafovea {
namespace {

// psignifit's demonstration data and test data; the answers counted are "correct" or "yes".
std::vector<PsychometricLevel> demo_levels() {
    const double x[] = {.001, .0015, .002, .0025, .003, .0035, .004, .0045, .005, .006, .007, .008, .01};
    const std::int64_t k[] = {45, 50, 44, 44, 52, 53, 62, 64, 76, 79, 88, 90, 90};
    std::vector<PsychometricLevel> levels;
    for (int i = 0; i < 13; ++i) levels.push_back({x[i], 90, k[i]});
    return levels;
}

std::vector<PsychometricLevel> ten_levels(std::initializer_list<std::int64_t> k) {
    std::vector<PsychometricLevel> levels;
    for (std::int64_t correct : k)
        levels.push_back({.25 + 1.5 * static_cast<double>(levels.size()) / 9.0, 10, correct});
    return levels;
}

PsychometricFit fit(const std::vector<PsychometricLevel>& levels, Sigmoid sigmoid, bool two_alternatives,
                    std::optional<double> lambda = std::nullopt) {
    PsychometricFitOptions options;
    options.draws = 0;
    options.model.sigmoid = sigmoid;
    options.model.fixed_lambda = lambda;
    if (two_alternatives) {
        options.model.asymptotes = Asymptotes::fixed;
        options.model.fixed_gamma = 0.5;
    }
    return *fit_psychometric(levels, options);
}

// Reference optima: an independent search in R, psig.R, and psignifit's own MATLAB values, which lie up to
// 0.5 % off it.
TEST(PsychometricFit, finds_the_reference_optima) {
    const PsychometricFit demo = fit(demo_levels(), Sigmoid::normal, true);
    EXPECT_NEAR(demo.best.threshold, .0046478, .0046478e-3);
    EXPECT_NEAR(demo.best.width, .0046591, .0046591e-3);
    EXPECT_LT(demo.best.lambda, 1e-4);
    EXPECT_LT(demo.best.eta, 1e-2);
    EXPECT_NEAR(demo.negative_log_posterior, 561.34999, 1e-5);
    EXPECT_NEAR(demo.best.threshold, .0046448, .0046448e-2);
    EXPECT_NEAR(demo.best.width, .0046838, .0046838e-2);

    const PsychometricFit fixed = fit(demo_levels(), Sigmoid::normal, true, .01);
    EXPECT_NEAR(fixed.best.threshold, .0045935, .0045935e-3);
    EXPECT_NEAR(fixed.best.width, .0044779, .0044779e-3);

    const PsychometricFit noisy = fit(ten_levels({4, 6, 3, 8, 7, 5, 8, 9, 9, 10}), Sigmoid::normal, true);
    EXPECT_NEAR(noisy.best.threshold, 1.191928, 1.2e-3);
    EXPECT_NEAR(noisy.best.width, 1.136292, 1.2e-3);
    EXPECT_NEAR(noisy.negative_log_posterior, 48.622711, 1e-6);
    EXPECT_NEAR(noisy.best.threshold, 1.192337, 1.2e-2);
    EXPECT_NEAR(noisy.best.width, 1.135902, 1.2e-2);

    const PsychometricFit yes_no = fit(ten_levels({0, 2, 2, 3, 7, 7, 8, 8, 9, 10}), Sigmoid::normal, false);
    EXPECT_NEAR(yes_no.best.threshold, .898926, 9e-4);
    EXPECT_NEAR(yes_no.best.width, 1.434311, 1.5e-3);
    EXPECT_LT(yes_no.best.gamma, 1e-3);
    EXPECT_NEAR(yes_no.negative_log_posterior, 37.090030, 1e-6);

    const PsychometricFit logistic =
        fit(ten_levels({5, 5, 5, 6, 5, 7, 9, 9, 8, 10}), Sigmoid::logistic, true);
    EXPECT_NEAR(logistic.best.threshold, 1.188664, 1.2e-3);
    EXPECT_NEAR(logistic.best.width, 1.349707, 1.4e-3);
    EXPECT_NEAR(logistic.negative_log_posterior, 49.527626, 1e-6);

    // psignifit's own values for the last three.
    EXPECT_NEAR(fixed.best.threshold, .0046, .0046e-2);
    EXPECT_NEAR(fixed.best.width, .0045, .0045e-2);
    EXPECT_NEAR(yes_no.best.threshold, .897274, .897274e-2);
    EXPECT_NEAR(yes_no.best.width, 1.434103, 1.434103e-2);
    EXPECT_NEAR(logistic.best.threshold, 1.189541, 1.189541e-2);
    EXPECT_NEAR(logistic.best.width, 1.345906, 1.345906e-2);
}

TEST(PsychometricFunction, is_half_at_threshold_spans_its_width_and_inverts) {
    for (Sigmoid sigmoid : {Sigmoid::logistic, Sigmoid::normal, Sigmoid::weibull}) {
        const double m = 3.2, w = 0.9;
        EXPECT_NEAR(sigmoid_value(sigmoid, m, m, w), 0.5, 1e-12);
        const PsychometricModel model{sigmoid, Asymptotes::free, 0.0, {}, {}, {}};
        const double x05 = *psychometric_inverse(model, {m, w, 0, 0, 0}, .05),
                     x95 = *psychometric_inverse(model, {m, w, 0, 0, 0}, .95);
        EXPECT_NEAR(sigmoid == Sigmoid::weibull ? std::log(x95 / x05) : x95 - x05, w, 1e-9);
        for (double share : {0.1, 0.2, 0.5, 0.9}) {
            const PsychometricParameters p{m, w, .03, .06, .1};
            EXPECT_NEAR(psychometric_value(model, p, *psychometric_inverse(model, p, share)), share, 1e-12);
        }
        EXPECT_FALSE(psychometric_inverse(model, {m, w, .02, .25, 0}, .2))
            << "the guess rate is above the criterion";
    }
}

TEST(PsychometricPosterior, with_vanishing_overdispersion_tends_to_the_binomial) {
    const PsychometricPosterior posterior(ten_levels({0, 2, 2, 3, 7, 7, 8, 8, 9, 10}), {});
    PsychometricParameters p{.9, 1.4, .02, .02, 0.0};
    const double binomial = posterior.log_likelihood(p);
    p.eta = 1e-4;
    EXPECT_NEAR(posterior.log_likelihood(p), binomial, 1e-4);
    // Both ways to evaluate the beta-binomial (few and many trials) must meet: compare with lgamma term by
    // term.
    p.eta = 0.2;
    const std::vector<PsychometricLevel> many{{1.0, 400, 130}, {2.0, 200, 150}};
    const PsychometricPosterior large(many, {});
    double expected = 0.0;
    for (const auto& level : many) {
        const double psi = psychometric_value({}, p, level.x), nu = 1.0 / (p.eta * p.eta) - 1.0, a = psi * nu,
                     b = (1 - psi) * nu;
        const double k = static_cast<double>(level.different), n = static_cast<double>(level.n);
        expected += std::lgamma(k + a) + std::lgamma(n - k + b) - std::lgamma(n + nu) - std::lgamma(a) -
                    std::lgamma(b) + std::lgamma(nu);
    }
    EXPECT_NEAR(large.log_likelihood(p), expected, 1e-8);
}

TEST(PsychometricFit, recovers_known_parameters_and_its_interval_holds_them) {
    std::mt19937_64 generator(41);
    for (Sigmoid sigmoid : {Sigmoid::logistic, Sigmoid::normal, Sigmoid::weibull}) {
        const PsychometricModel model{sigmoid, Asymptotes::free, 0.0, {}, {}, {}};
        const PsychometricParameters truth{3.4, sigmoid == Sigmoid::weibull ? 1.0 : 2.8, .02, .06, 0.0};
        std::vector<PsychometricLevel> levels;
        for (double sigma : {1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.4, 2.6}) {
            PsychometricLevel level{sigma * sigma, 600, 0};
            const double p = psychometric_value(model, truth, level.x);
            for (int i = 0; i < 600; ++i) level.different += draw_unit(generator) < p ? 1 : 0;
            levels.push_back(level);
        }
        PsychometricFitOptions options;
        options.model = model;
        const auto result = fit_psychometric(levels, options);
        EXPECT_NEAR(result->best.threshold, truth.threshold, 0.2);
        const double at = *psychometric_inverse(model, truth, .2);
        EXPECT_NEAR(*result->at_criterion.value, at, 0.15);
        EXPECT_LT(*result->at_criterion.low, at);
        EXPECT_GT(*result->at_criterion.high, at);
        EXPECT_LT(*result->at_criterion.high - *result->at_criterion.low, 0.8);
        EXPECT_GT(result->acceptance, 0.05);
        EXPECT_LT(result->acceptance, 0.7);
    }
}

TEST(PsychometricFit, of_binomial_dispersion_holds_eta_at_0_and_is_surer_of_noisy_data) {
    const auto levels = ten_levels({4, 0, 6, 1, 9, 3, 10, 4, 10, 7});  // far from any monotonic function
    PsychometricFitOptions options;
    const PsychometricFit fitted = *fit_psychometric(levels, options);
    options.model.dispersion = Dispersion::binomial;
    const PsychometricFit binomial = *fit_psychometric(levels, options);
    EXPECT_EQ(binomial.best.eta, 0.0);
    EXPECT_EQ(binomial.eta.low, 0.0);
    EXPECT_EQ(binomial.eta.high, 0.0);
    EXPECT_GT(fitted.best.eta, 0.1);
    EXPECT_LT(fitted.negative_log_posterior, binomial.negative_log_posterior);
    EXPECT_LT(binomial.threshold.high - binomial.threshold.low, fitted.threshold.high - fitted.threshold.low);

    // The likelihood is the binomial one, written out.
    const PsychometricPosterior posterior(levels, options.model);
    double sum = 0.0;
    for (const PsychometricLevel& level : levels) {
        const double psi = psychometric_value(options.model, binomial.best, level.x);
        sum += static_cast<double>(level.different) * std::log(psi) +
               static_cast<double>(level.n - level.different) * std::log(1.0 - psi);
    }
    EXPECT_NEAR(posterior.log_likelihood(binomial.best), sum, 1e-9);
}

TEST(PsychometricFit, does_not_depend_on_the_scale_of_x) {
    auto levels = ten_levels({0, 2, 2, 3, 7, 7, 8, 8, 9, 10});
    PsychometricFitOptions options;
    options.draws = 2000;
    const auto plain = fit_psychometric(levels, options);
    for (auto& level : levels) level.x *= 1e6;
    const auto scaled = fit_psychometric(levels, options);
    EXPECT_NEAR(scaled->best.threshold * 1e-6, plain->best.threshold, 1e-5);
    EXPECT_NEAR(*scaled->at_criterion.low * 1e-6, *plain->at_criterion.low, 1e-3);
}

// The walk against a plain grid over threshold and width (both asymptotes and eta held at 0 by the data's own
// weight are not possible, so lambda is fixed and gamma too; eta is summed over).
TEST(PsychometricFit, its_interval_agrees_with_a_grid_over_the_posterior) {
    const auto levels = ten_levels({0, 2, 2, 3, 7, 7, 8, 8, 9, 10});
    PsychometricFitOptions options;
    options.model.asymptotes = Asymptotes::fixed;
    options.model.fixed_gamma = 0.02;
    options.model.fixed_lambda = 0.02;
    options.draws = 40'000;
    const auto walked = fit_psychometric(levels, options);
    const PsychometricPosterior posterior(levels, options.model);
    std::vector<std::pair<double, double>> mass;  // threshold, weight
    double total = 0.0;
    for (int i = 0; i < 240; ++i) {
        const double m = -0.5 + 3.0 * (i + 0.5) / 240.0;
        double weight = 0.0;
        for (int j = 0; j < 120; ++j)
            for (int e = 0; e < 60; ++e) {
                const double value =
                    posterior.log_posterior({m, 4.5 * (j + 0.5) / 120.0, .02, .02, (e + 0.5) / 60.0});
                weight += std::isfinite(value) ? std::exp(value + 40.0) : 0.0;
            }
        mass.push_back({m, weight});
        total += weight;
    }
    const auto quantile = [&](double share) {
        double sum = 0.0;
        for (const auto& [m, weight] : mass)
            if ((sum += weight) >= share * total) return m;
        return mass.back().first;
    };
    EXPECT_NEAR(walked->threshold.low, quantile(0.025), 0.03);
    EXPECT_NEAR(walked->threshold.high, quantile(0.975), 0.03);
}

TEST(PsychometricFit, answers_for_no_trial_one_trial_one_level_all_the_same_and_adaptive_data) {
    EXPECT_FALSE(fit_psychometric({}));
    const std::vector<PsychometricLevel> empty{{1.0, 0, 0}};
    EXPECT_FALSE(fit_psychometric(empty));
    const auto expect_finite = [](const std::vector<PsychometricLevel>& levels) {
        PsychometricFitOptions options;
        options.draws = 1000;
        const auto result = fit_psychometric(levels, options);
        for (double value :
             {result->best.threshold, result->best.width, result->threshold.low, result->threshold.high})
            EXPECT_TRUE(std::isfinite(value));
        return *result;
    };
    EXPECT_FALSE(expect_finite({{1.44, 1, 1}}).warnings.empty());
    expect_finite({{1.44, 1000, 500}});
    expect_finite({{1.44, 36, 0}, {1.96, 36, 0}, {5.76, 36, 0}});
    expect_finite({{1.44, 36, 36}, {1.96, 36, 36}, {5.76, 36, 36}});
    expect_finite({{1.44, 1'000'000, 1000}, {5.76, 1'000'000, 900'000}});
    std::mt19937_64 generator(44);
    std::vector<PsychometricLevel>
        adaptive;  // every trial at its own level, as a staircase or QUEST+ leaves them
    for (int i = 0; i < 60; ++i) {
        const double x = 1.0 + 6.0 * draw_unit(generator);
        adaptive.push_back({x, 1, draw_unit(generator) < 1.0 / (1.0 + std::exp(-2.0 * (x - 3.5))) ? 1 : 0});
    }
    PsychometricFitOptions options;
    options.model.x_range = Interval{1.0, 7.0};
    options.model.x_spacing = 0.1;
    const auto result = fit_psychometric(adaptive, options);
    EXPECT_NEAR(result->best.threshold, 3.5, 0.8);
    EXPECT_LT(result->threshold.low, 3.5);
    EXPECT_GT(result->threshold.high, 3.5);
}

// Answers of people who differ, at the final study's levels; from so few to so many of each.
std::vector<PsychometricLevel> drawn_levels(std::mt19937_64& generator, int each) {
    const PsychometricParameters person{3.5 + 1.5 * draw_normal(generator), 3.0, 0.02, 0.04, 0.0};
    std::vector<PsychometricLevel> levels;
    for (double sigma : {1.2, 1.4, 1.6, 1.8, 2.0, 2.2, 2.4}) {
        levels.push_back({sigma * sigma, each, 0});
        const double p = psychometric_value({}, person, levels.back().x);
        for (int i = 0; i < each; ++i) levels.back().different += draw_unit(generator) < p ? 1 : 0;
    }
    return levels;
}

TEST(PsychometricPosterior, its_slope_is_that_of_finite_differences) {
    std::mt19937_64 generator(11);
    for (const Sigmoid sigmoid : {Sigmoid::logistic, Sigmoid::normal, Sigmoid::weibull})
        for (const Dispersion dispersion : {Dispersion::binomial, Dispersion::fitted})
            for (const Asymptotes asymptotes : {Asymptotes::free, Asymptotes::equal, Asymptotes::fixed})
                for (const int each : {2, 36, 400}) {
                    const auto levels = drawn_levels(generator, each);
                    const PsychometricPosterior posterior(
                        levels, {sigmoid, asymptotes, 0.05, {}, {}, {}, dispersion});
                    const bool weibull = sigmoid == Sigmoid::weibull;
                    const double range = posterior.range().high - posterior.range().low;
                    // Inside the flat priors, and on the falling side of each.
                    for (const auto& [place, width] :
                         {std::pair{0.4, 0.8}, std::pair{-0.2, 1.7}, std::pair{1.3, 0.22}}) {
                        const double x = posterior.range().low + place * range;
                        const PsychometricParameters p{weibull ? std::exp(x) : x, width * range, 0.03, 0.05,
                                                       dispersion == Dispersion::fitted ? 0.2 : 0.0};
                        PsychometricParameters slope;
                        EXPECT_EQ(posterior.log_posterior(p, slope), posterior.log_posterior(p));
                        const auto numerical = [&](auto moved) {
                            constexpr double kStep = 1e-5;
                            return (posterior.log_posterior(moved(kStep)) -
                                    posterior.log_posterior(moved(-kStep))) /
                                   (2.0 * kStep);
                        };
                        const auto along = [&](double PsychometricParameters::*parameter) {
                            return numerical([&, parameter](double step) {
                                PsychometricParameters q = p;
                                q.*parameter += step;
                                return q;
                            });
                        };
                        const double by_place = numerical([&](double step) {
                            PsychometricParameters q = p;
                            q.threshold = weibull ? std::exp(x + step) : x + step;
                            return q;
                        });
                        const auto near = [&](double exact, double expected, const char* what) {
                            EXPECT_NEAR(exact, expected, 1e-5 * (1.0 + each + std::abs(expected)))
                                << what << " at " << place << ", " << width << ", n " << each;
                        };
                        near(slope.threshold, by_place, "threshold");
                        near(slope.width, along(&PsychometricParameters::width), "width");
                        near(slope.lambda, along(&PsychometricParameters::lambda), "lambda");
                        near(slope.gamma, along(&PsychometricParameters::gamma), "gamma");
                        if (dispersion == Dispersion::fitted)
                            near(slope.eta, along(&PsychometricParameters::eta), "eta");
                    }
                }
}

// The search by slopes against one that knows none, begun where the first ended and where the data suggest.
TEST(PsychometricFit, no_search_without_slopes_finds_a_more_probable_function) {
    std::mt19937_64 generator(12);
    for (const Sigmoid sigmoid : {Sigmoid::logistic, Sigmoid::normal, Sigmoid::weibull})
        for (const Dispersion dispersion : {Dispersion::binomial, Dispersion::fitted})
            for (const int each : {2, 8, 36, 36, 36, 36}) {
                PsychometricFitOptions options;
                options.draws = 0;
                options.model.sigmoid = sigmoid;
                options.model.dispersion = dispersion;
                const auto levels = drawn_levels(generator, each);
                const PsychometricFit found = *fit_psychometric(levels, options);
                const PsychometricPosterior posterior(found.levels, options.model);
                const bool fitted = dispersion == Dispersion::fitted;
                const auto cost = [&](std::span<const double> q) {  // place, log width, roots of the rates
                    const double value = posterior.log_posterior(
                        {sigmoid == Sigmoid::weibull ? std::exp(q[0]) : q[0], std::exp(q[1]), q[2] * q[2],
                         q[3] * q[3], fitted ? q[4] * q[4] : 0.0});
                    return std::isfinite(value) ? -value : 1e10;
                };
                const PsychometricParameters& best = found.best;
                std::vector<double> at_best{
                    sigmoid == Sigmoid::weibull ? std::log(best.threshold) : best.threshold,
                    std::log(best.width), std::sqrt(best.lambda), std::sqrt(best.gamma)};
                std::vector<double> in_the_middle{
                    0.5 * (posterior.range().low + posterior.range().high),
                    std::log(0.6 * (posterior.range().high - posterior.range().low)), 0.15, 0.15};
                if (fitted) {
                    at_best.push_back(std::sqrt(best.eta));
                    in_the_middle.push_back(0.15);
                }
                EXPECT_NEAR(cost(at_best), found.negative_log_posterior, 1e-9);
                for (const auto& start : {at_best, in_the_middle}) {
                    Minimum other = nelder_mead(cost, start, 0.1, 1e-9);
                    other = nelder_mead(cost, other.at, 0.05, 1e-12);
                    EXPECT_GT(other.value, found.negative_log_posterior - 1e-7)
                        << "sigmoid " << static_cast<int>(sigmoid) << ", n " << each;
                }
            }
}

TEST(QuasiNewton, finds_the_bottom_of_rosenbrocks_valley_and_never_leaves_where_the_function_is_defined) {
    const auto valley = [](std::span<const double> q, std::span<double> slope) {
        const double off = q[1] - q[0] * q[0];
        slope[0] = -400.0 * q[0] * off - 2.0 * (1.0 - q[0]);
        slope[1] = 200.0 * off;
        return 100.0 * off * off + (1.0 - q[0]) * (1.0 - q[0]);
    };
    const std::vector<double> start{-1.2, 1.0};
    const Minimum found = quasi_newton(valley, start, 1e-14);
    EXPECT_NEAR(found.at[0], 1.0, 1e-6);
    EXPECT_NEAR(found.at[1], 1.0, 1e-6);

    // x - log x, which ends at 0, from far up: its bottom is at 1.
    const auto walled = [](std::span<const double> q, std::span<double> slope) {
        if (q[0] <= 0.0) return std::numeric_limits<double>::infinity();
        slope[0] = 1.0 - 1.0 / q[0];
        return q[0] - std::log(q[0]);
    };
    for (const double from : {1e-3, 1.0, 40.0}) {
        const Minimum bottom = quasi_newton(walled, std::vector<double>{from}, 1e-14);
        EXPECT_NEAR(bottom.at[0], 1.0, 1e-6);
    }
}

TEST(NelderMead, finds_the_bottom_of_rosenbrocks_valley) {
    const auto valley = [](std::span<const double> q) {
        return 100.0 * std::pow(q[1] - q[0] * q[0], 2) + std::pow(1.0 - q[0], 2);
    };
    const std::vector<double> start{-1.2, 1.0};
    const Minimum found = nelder_mead(valley, start, 0.5, 1e-14, 4000);
    EXPECT_NEAR(found.at[0], 1.0, 1e-5);
    EXPECT_NEAR(found.at[1], 1.0, 1e-5);
}

}  // namespace
}  // namespace parafovea
