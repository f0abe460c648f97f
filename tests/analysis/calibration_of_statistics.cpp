// Prints how often 95 % intervals cover the truth and how often tests at 0.05 reject a true null hypothesis,
// as Markdown tables. Usage: analysis_calibration [studies per row, default 2000]
// [all, or one table: answers, people, thresholds, groups, null]
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/cochran_q.h"
#include "analysis/decision.h"
#include "analysis/mcnemar.h"
#include "analysis/parallel.h"
#include "analysis/proportion.h"
#include "analysis/psychometric_fit.h"
#include "analysis/psychometric_people.h"
#include "analysis/random_draw.h"

namespace parafovea {
namespace {

double logit(double p) {
    return std::log(p / (1.0 - p));
}
double inverse_logit(double x) {
    return 1.0 / (1.0 + std::exp(-x));
}

// Runs one study per seed on all cores and counts, per column, how many said yes.
template <std::size_t Columns, typename Study>
std::array<double, Columns> shares(int studies, Study&& study) {
    std::vector<std::array<bool, Columns>> results(static_cast<std::size_t>(studies));
    parallel_for(results.size(), [&](std::size_t i) {
        std::mt19937_64 generator(1000 + i);
        results[i] = study(generator);
    });
    std::array<double, Columns> sums{};
    for (const auto& result : results)
        for (std::size_t c = 0; c < Columns; ++c) sums[c] += result[c] ? 100.0 / studies : 0.0;
    return sums;
}

bool holds(const std::optional<Interval>& interval, double value) {
    return interval && interval->low <= value && value <= interval->high;
}

void intervals_of_independent_answers(int studies) {
    std::printf("| n | p | Wald | Wilson | Clopper-Pearson | Jeffreys |\n|---:|---:|---:|---:|---:|---:|\n");
    for (int n : {18, 36, 72, 200})
        for (double p : {0.5, 0.8, 0.95}) {
            const auto cover = shares<4>(studies * 5, [&](std::mt19937_64& generator) {
                int x = 0;
                for (int i = 0; i < n; ++i) x += draw_unit(generator) < p ? 1 : 0;
                const Proportion result = proportion(x, n);
                const double half = 1.959963984540054 * *result.standard_error;
                return std::array<bool, 4>{std::abs(*result.p - p) <= half, holds(result.wilson, p),
                                           holds(result.clopper_pearson, p), holds(result.jeffreys, p)};
            });
            std::printf("| %d | %.2f | %.1f | %.1f | %.1f | %.1f |\n", n, p, cover[0], cover[1], cover[2],
                        cover[3]);
        }
}

void intervals_over_people(int studies) {
    std::printf(
        "| participants | answers each | SD between people (logit) | Wilson | clustered SE, t | bootstrap "
        "over participants |\n"
        "|---:|---:|---:|---:|---:|---:|\n");
    for (int people : {18, 36})
        for (double sd : {0.0, 1.0, 2.0}) {
            constexpr int kEach = 8;
            // The truth is the mean over all people, by quadrature over the normal distribution.
            double truth = 0.0;
            for (int q = 0; q < 2000; ++q) {
                const double z = -5.0 + 10.0 * (q + 0.5) / 2000.0;
                truth += inverse_logit(logit(0.8) + sd * z) * std::exp(-z * z / 2.0) /
                         std::sqrt(2.0 * std::numbers::pi) * 10.0 / 2000.0;
            }
            const double t =
                people == 18
                    ? 2.1098
                    : 2.0301;  // 97.5 % quantiles of Student's t, participants - 1 degrees of freedom
            const auto cover = shares<3>(studies, [&](std::mt19937_64& generator) {
                Tally tally;
                std::vector<ClusterCount> clusters;
                std::int64_t x = 0;
                for (int i = 0; i < people; ++i) {
                    const double p = inverse_logit(logit(0.8) + sd * draw_normal(generator));
                    ClusterCount cluster{kEach, 0};
                    for (int j = 0; j < kEach; ++j) {
                        Response response;
                        response.participant = std::to_string(i);
                        response.sigma = response.alpha = 1.0;
                        response.identical = draw_unit(generator) < p;
                        cluster.successes += response.identical ? 1 : 0;
                        tally.add(response);
                    }
                    x += cluster.successes;
                    clusters.push_back(cluster);
                }
                const Proportion result = proportion(x, people * kEach);
                const double half = t * *clustered_standard_error(clusters);
                return std::array<bool, 3>{holds(result.wilson, truth), std::abs(*result.p - truth) <= half,
                                           holds(decide(tally, 0.0, 0.1, 999, generator()).bootstrap, truth)};
            });
            std::printf("| %d | %d | %.1f | %.1f | %.1f | %.1f |\n", people, kEach, sd, cover[0], cover[1],
                        cover[2]);
        }
}

void intervals_of_thresholds(int studies) {
    std::printf(
        "| trials per sigma | function | overdispersion | threshold (half way) | sigma^2 at 80 %% identical "
        "|\n|---:|---|---|---:|---:|\n");
    for (int n : {36, 100})
        for (const auto& [sigmoid, dispersion] : {std::pair{Sigmoid::logistic, Dispersion::fitted},
                                                  std::pair{Sigmoid::logistic, Dispersion::binomial},
                                                  std::pair{Sigmoid::normal, Dispersion::fitted},
                                                  std::pair{Sigmoid::normal, Dispersion::binomial},
                                                  std::pair{Sigmoid::weibull, Dispersion::fitted},
                                                  std::pair{Sigmoid::weibull, Dispersion::binomial}}) {
            PsychometricFitOptions options;
            options.model.sigmoid = sigmoid;
            options.model.dispersion = dispersion;
            options.draws = 4000;
            const PsychometricParameters truth{3.5, sigmoid == Sigmoid::weibull ? 1.1 : 3.0, 0.02, 0.04, 0.0};
            const double at = *psychometric_inverse(options.model, truth, 0.2);
            const auto cover = shares<2>(studies / 4, [&](std::mt19937_64& generator) {
                std::vector<PsychometricLevel> levels;
                for (int i = 0; i < 7; ++i) {
                    const double sigma = 1.2 + 0.2 * i;
                    PsychometricLevel level{sigma * sigma, n, 0};
                    const double p = psychometric_value(options.model, truth, level.x);
                    for (int j = 0; j < n; ++j) level.different += draw_unit(generator) < p ? 1 : 0;
                    levels.push_back(level);
                }
                const auto fit = fit_psychometric(levels, options);
                return std::array<bool, 2>{
                    holds(fit->threshold, truth.threshold),
                    fit->at_criterion.low.value_or(-1e9) <= at && at <= fit->at_criterion.high.value_or(1e9)};
            });
            const char* name = sigmoid == Sigmoid::logistic ? "logistic"
                               : sigmoid == Sigmoid::normal ? "cumulative normal"
                                                            : "Weibull";
            std::printf("| %d | %s | %s | %.1f | %.1f |\n", n, name,
                        dispersion == Dispersion::fitted ? "fitted" : "none (binomial)", cover[0], cover[1]);
        }
}

// Two answers of everybody at every sigma, as in the final study's two sessions, joined and fitted; the truth
// is where the mean over all people reaches 20 % "different".
void intervals_of_group_thresholds(int studies) {
    std::printf(
        "| participants | SD of thresholds between people | credible, overdispersion fitted | credible, "
        "binomial | bootstrap "
        "over participants |\n|---:|---:|---:|---:|---:|\n");
    for (int people : {18, 36})
        for (double sd : {0.0, 0.75, 1.5}) {
            PsychometricFitOptions options;
            const PsychometricParameters person{3.5, 3.0, 0.02, 0.04, 0.0};
            const auto mean_over_people = [&](double x) {
                double sum = 0.0, weights = 0.0;
                for (int q = 0; q < 400; ++q) {
                    const double z = -5.0 + 10.0 * (q + 0.5) / 400.0, weight = std::exp(-z * z / 2.0);
                    PsychometricParameters one = person;
                    one.threshold += sd * z;
                    sum += weight * psychometric_value(options.model, one, x);
                    weights += weight;
                }
                return sum / weights;
            };
            double low = 0.0, high = 6.0;
            for (int step = 0; step < 60; ++step)
                (mean_over_people(0.5 * (low + high)) < 0.2 ? low : high) = 0.5 * (low + high);
            const auto cover = shares<3>(studies / 4, [&](std::mt19937_64& generator) {
                std::vector<std::vector<PsychometricLevel>> each;
                std::vector<PsychometricLevel> all;
                for (int i = 0; i < people; ++i) {
                    PsychometricParameters one = person;
                    one.threshold += sd * draw_normal(generator);
                    auto& levels = each.emplace_back();
                    for (int j = 0; j < 7; ++j) {
                        const double sigma = 1.2 + 0.2 * j;
                        PsychometricLevel level{sigma * sigma, 2, 0};
                        const double p = psychometric_value(options.model, one, level.x);
                        for (int k = 0; k < 2; ++k) level.different += draw_unit(generator) < p ? 1 : 0;
                        levels.push_back(level);
                        all.push_back(level);
                    }
                }
                PsychometricFitOptions fitted = options, binomial = options;
                fitted.draws = binomial.draws = 4000;
                fitted.model.dispersion = Dispersion::fitted;
                binomial.model.dispersion = Dispersion::binomial;
                binomial.seed = generator();
                const auto inside = [&](const CriterionThreshold& at) {
                    return at.low.value_or(-1e9) <= low && low <= at.high.value_or(1e9);
                };
                const auto group = fit_psychometric(all, binomial);
                return std::array<bool, 3>{inside(fit_psychometric(all, fitted)->at_criterion),
                                           inside(group->at_criterion),
                                           inside(*threshold_over_people(each, *group, binomial, 400))};
            });
            std::printf("| %d | %.2f | %.1f | %.1f | %.1f |\n", people, sd, cover[0], cover[1], cover[2]);
        }
}

// The null hypothesis: no alpha is better for people in general, though each person may favour one.
void tests_under_the_null(int studies) {
    std::printf(
        "| participants | sessions | P_I | SD person by condition (logit) | Q, chi-square | Q, exact | Q, "
        "mid-p | within participants | "
        "McNemar exact, any pair, Holm | McNemar mid-p, one pair "
        "|\n|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    struct Design {
        int people, sessions;
        double p, tau;
    };
    for (const Design& d : {Design{18, 2, 0.8, 0.0}, Design{18, 2, 0.8, 0.5}, Design{18, 2, 0.8, 1.0},
                            Design{18, 2, 0.95, 0.5}, Design{20, 10, 0.8, 0.0}, Design{20, 10, 0.8, 0.5},
                            Design{20, 10, 0.8, 1.0}, Design{54, 1, 0.8, 1.0}}) {
        const auto reject = shares<6>(studies, [&](std::mt19937_64& generator) {
            constexpr std::size_t kAlphas = 4;
            BinaryTable table{kAlphas, {}};
            std::vector<std::int64_t> sums;
            for (int i = 0; i < d.people; ++i) {
                const double person = draw_normal(generator);
                double x[kAlphas];
                for (double& value : x) value = logit(d.p) + person + d.tau * draw_normal(generator);
                std::int64_t sum[kAlphas] = {};
                for (int s = 0; s < d.sessions; ++s)
                    for (std::size_t j = 0; j < kAlphas; ++j) {
                        const bool identical = draw_unit(generator) < inverse_logit(x[j]);
                        table.values.push_back(identical ? 1 : 0);
                        sum[j] += identical ? 1 : 0;
                    }
                sums.insert(sums.end(), sum, sum + kAlphas);
            }
            CochranQOptions options;
            options.work_limit = 3'000'000;
            options.draws = 999;
            options.seed = generator();
            const CochranQ q = cochran_q(table, options);
            const auto pairs = pairwise_mcnemar(table);
            bool any = false;
            for (const PairwiseRow& row : pairs) any = any || row.holm_exact < 0.05;
            return std::array<bool, 6>{
                q.p_chi2 && *q.p_chi2 < 0.05,
                *q.p_exact < 0.05,
                *q.p_mid < 0.05,
                *permute_within_participants(sums, kAlphas, 499, generator()).p <= 0.05,
                any,
                pairs[0].test.p_mid < 0.05};
        });
        std::printf("| %d | %d | %.2f | %.1f |", d.people, d.sessions, d.p, d.tau);
        for (double share : reject) std::printf(" %.1f |", share);
        std::printf("\n");
    }
}

}  // namespace
}  // namespace parafovea

int main(int argc, char** argv) {
    const int studies = argc > 1 ? std::atoi(argv[1]) : 2000;
    const std::string table = argc > 2 ? argv[2] : "all";
    if (studies < 4 || (table != "all" && table != "thresholds" && table != "groups" && table != "answers" &&
                        table != "people" && table != "null")) {
        std::fprintf(stderr,
                     "usage: analysis_calibration [studies per row, at least 4] "
                     "[all|thresholds|groups|answers|people|null]\n");
        return 2;
    }
    const auto wanted = [&](const char* name) { return table == "all" || table == name; };
    if (wanted("answers")) {
        std::printf("\nCoverage of 95 %% intervals, independent answers (%d studies per row), in %%\n\n",
                    studies * 5);
        parafovea::intervals_of_independent_answers(studies);
    }
    if (wanted("people")) {
        std::printf("\nCoverage of 95 %% intervals of P_I when people differ (%d studies per row), in %%\n\n",
                    studies);
        parafovea::intervals_over_people(studies);
    }
    if (wanted("thresholds")) {
        std::printf(
            "\nCoverage of 95 %% credible intervals of psychometric fits (%d studies per row), in %%\n\n",
            studies / 4);
        parafovea::intervals_of_thresholds(studies);
    }
    if (wanted("groups")) {
        std::printf(
            "\nCoverage of 95 %% intervals of a group's sigma^2 at 80 %% identical (%d studies per row), in "
            "%%\n\n",
            studies / 4);
        parafovea::intervals_of_group_thresholds(studies);
    }
    if (wanted("null")) {
        std::printf("\nRejections of a true null hypothesis at 0.05 (%d studies per row), in %%\n\n",
                    studies);
        parafovea::tests_under_the_null(studies);
    }
}
