// Power by simulation: studies of the planned design with assumed participants, analysed as the real one will
// be.
#include "analysis/power.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <mutex>
#include <stdexcept>

#include "analysis/cochran_q.h"
#include "analysis/mcnemar.h"
#include "analysis/parallel.h"
#include "analysis/random_draw.h"

namespace parafovea {
namespace {

// The plan by sigma: columns are alphas, and every cell has what a trial's probability needs.
struct PlanColumn {
    double logit = 0.0;  // of the average participant's sigmoid
    int trials_per_session = 1;
};
struct PlanRow {
    double sigma = 0.0;
    std::vector<PlanColumn> columns;
};

std::vector<PlanRow> lay_out(const PowerQuestion& question, double effect) {
    const auto& functions = question.assumptions.functions;
    const auto function_of = [&](double alpha) -> const AssumedFunction& {
        for (const AssumedFunction& function : functions)
            if (std::abs(function.alpha - alpha) < 1e-9) return function;
        throw std::runtime_error("power: no assumed function for alpha " + std::to_string(alpha) +
                                 " of the plan");
    };
    // The mean is over the alphas of the plan, so that effect 0 makes them one and the same.
    std::map<double, std::vector<PlanCell>> by_sigma;
    std::map<double, AssumedFunction> used;
    for (const PlanCell& cell : question.plan) {
        if (cell.trials_per_session < 1)
            throw std::runtime_error("power: a condition of the plan has no trial");
        by_sigma[cell.condition.sigma].push_back(cell);
        used[cell.condition.alpha] = function_of(cell.condition.alpha);
    }
    if (by_sigma.empty()) throw std::runtime_error("power: the plan has no condition");
    double threshold = 0.0, width = 0.0;
    for (const auto& [alpha, function] : used) {
        threshold += function.threshold / static_cast<double>(used.size());
        width += function.width / static_cast<double>(used.size());
    }
    const double logit_span = 2.0 * std::log(19.0);  // from 5 to 95 %
    std::vector<PlanRow> rows;
    for (auto& [sigma, cells] : by_sigma) {
        std::sort(cells.begin(), cells.end(),
                  [](const PlanCell& a, const PlanCell& b) { return a.condition.alpha < b.condition.alpha; });
        PlanRow row{sigma, {}};
        for (const PlanCell& cell : cells) {
            const AssumedFunction& function = used[cell.condition.alpha];
            const double m = threshold + effect * (function.threshold - threshold),
                         w = width + effect * (function.width - width);
            row.columns.push_back({logit_span * (sigma * sigma - m) / w, cell.trials_per_session});
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

SimulatedStudy simulate_study(const std::vector<PlanRow>& plan, const PowerQuestion& question, int people,
                              int sessions, std::uint64_t seed) {
    std::mt19937_64 generator(seed);
    const PowerAssumptions& assumed = question.assumptions;
    const std::size_t n_people = static_cast<std::size_t>(people);
    std::vector<double> person(n_people);
    for (double& shift : person) shift = assumed.participant_sd * draw_normal(generator);

    SimulatedStudy outcome;
    std::vector<double> permutation_p;
    double cells = 0.0, clustered_cells = 0.0;
    for (const PlanRow& row : plan) {
        // Everybody answers; a block is a repetition in a session, as in the analysis of a real study.
        const std::size_t k = row.columns.size();
        int blocks = row.columns[0].trials_per_session;
        for (const PlanColumn& column : row.columns) blocks = std::min(blocks, column.trials_per_session);
        const std::size_t rows_each = static_cast<std::size_t>(blocks * sessions);
        BinaryTable table{k, std::vector<std::uint8_t>(n_people * rows_each * k)};
        std::vector<std::int64_t> sums(n_people * k, 0);
        double best = -1.0;
        for (std::size_t j = 0; j < k; ++j) {
            std::vector<ClusterCount> clusters(n_people);
            std::int64_t n = 0, identical = 0;
            for (std::size_t i = 0; i < n_people; ++i) {
                const double logit =
                    row.columns[j].logit - person[i] - assumed.condition_sd * draw_normal(generator);
                const double sigmoid = 1.0 / (1.0 + std::exp(-logit));
                const double different =
                    assumed.guess_rate + (1.0 - assumed.lapse_rate - assumed.guess_rate) * sigmoid;
                const std::size_t trials =
                    static_cast<std::size_t>(row.columns[j].trials_per_session * sessions);
                for (std::size_t t = 0; t < trials; ++t) {
                    const bool same = draw_unit(generator) >= different;
                    clusters[i].successes += same ? 1 : 0;
                    if (t >= rows_each) continue;
                    table.values[(i * rows_each + t) * k + j] = same ? 1 : 0;
                    sums[i * k + j] += same ? 1 : 0;
                }
                clusters[i].n = static_cast<std::int64_t>(trials);
                n += clusters[i].n;
                identical += clusters[i].successes;
            }
            const double p = static_cast<double>(identical) / static_cast<double>(n);
            best = std::max(best, p);
            // Wilson's width in closed form; the full set of intervals would only cost time here.
            const double z = 1.959963984540054, size = static_cast<double>(n);
            outcome.wilson_width += 2.0 * z * std::sqrt(p * (1.0 - p) / size + z * z / (4.0 * size * size)) /
                                    (1.0 + z * z / size);
            cells += 1.0;
            if (const auto se = clustered_standard_error(clusters)) {
                outcome.clustered_width += 2.0 * z * *se;
                clustered_cells += 1.0;
            }
        }
        if (best >= question.criterion - 1e-12)
            outcome.decided_sigma = std::max(outcome.decided_sigma, row.sigma);
        if (k < 2) {
            outcome.cochran.push_back(0);
            outcome.permutation.push_back(0);
            outcome.undefined.push_back(1);
            continue;
        }
        CochranQOptions options;
        options.exact = false;
        const CochranQ q = cochran_q(table, options);
        const PermutationTest test = permute_within_participants(sums, k, question.permutations, generator());
        outcome.cochran.push_back(q.p_chi2 && *q.p_chi2 < question.level ? 1 : 0);
        outcome.permutation.push_back(test.p && *test.p <= question.level ? 1 : 0);
        outcome.undefined.push_back(q.q ? 0 : 1);
        permutation_p.push_back(test.p.value_or(1.0));
    }
    for (double p : holm_adjusted(permutation_p)) outcome.any_holm = outcome.any_holm || p <= question.level;
    outcome.wilson_width /= std::max(cells, 1.0);
    outcome.clustered_width /= std::max(clustered_cells, 1.0);
    return outcome;
}

// The combinations of a question and how each lays its plan out.
struct Combinations {
    std::vector<PowerPoint> points;
    std::vector<std::vector<PlanRow>> plans;
};

Combinations combinations_of(const PowerQuestion& question) {
    if (question.studies < 1 || question.permutations < 1)
        throw std::runtime_error("power: at least one study and one permutation are needed");
    Combinations all;
    for (int sessions : question.sessions)
        for (double effect : question.effects)
            for (int people : question.participants) {
                if (people < 1 || sessions < 1)
                    throw std::runtime_error("power: participants and sessions must be at least 1");
                PowerPoint point;
                point.participants = people;
                point.sessions = sessions;
                point.effect = effect;
                point.studies = question.studies;
                all.points.push_back(point);
                all.plans.push_back(lay_out(question, effect));
            }
    return all;
}

}  // namespace

double monte_carlo_error(double share, int studies) {
    return studies > 0 ? std::sqrt(std::max(0.0, share * (1.0 - share)) / studies) : 0.0;
}

std::size_t study_count(const PowerQuestion& question) {
    return question.sessions.size() * question.effects.size() * question.participants.size() *
           static_cast<std::size_t>(question.studies);
}

std::vector<SimulatedStudy> simulate_studies(
    const PowerQuestion& question, const StudyShard& shard,
    const std::function<void(std::int64_t, std::int64_t)>& progress) {
    const Combinations all = combinations_of(question);
    // Every study has a seed of its own, so that neither threads nor shards can change the answer.
    const std::size_t studies = static_cast<std::size_t>(question.studies);
    std::mt19937_64 seeds(question.seed);
    std::vector<std::uint64_t> seed(study_count(question));
    for (std::uint64_t& value : seed) value = seeds();
    std::vector<std::size_t> own;
    for (std::size_t i = static_cast<std::size_t>(shard.index - 1); i < seed.size();
         i += static_cast<std::size_t>(shard.count))
        own.push_back(i);

    std::vector<SimulatedStudy> outcomes(own.size());
    std::mutex progress_mutex;
    std::int64_t done = 0;
    constexpr std::size_t kBatch = 16;
    parallel_for((own.size() + kBatch - 1) / kBatch, [&](std::size_t batch) {
        const std::size_t end = std::min(own.size(), (batch + 1) * kBatch);
        for (std::size_t k = batch * kBatch; k < end; ++k) {
            const std::size_t i = own[k];
            const PowerPoint& point = all.points[i / studies];
            outcomes[k] =
                simulate_study(all.plans[i / studies], question, point.participants, point.sessions, seed[i]);
        }
        if (!progress) return;
        const std::lock_guard lock(progress_mutex);
        done += static_cast<std::int64_t>(end - batch * kBatch);
        progress(done, static_cast<std::int64_t>(own.size()));
    });
    return outcomes;
}

std::vector<PowerPoint> power_of_studies(const PowerQuestion& question,
                                         const std::vector<SimulatedStudy>& outcomes) {
    Combinations all = combinations_of(question);
    const std::size_t studies = static_cast<std::size_t>(question.studies);
    if (outcomes.size() != all.points.size() * studies)
        throw std::runtime_error("power: " + std::to_string(outcomes.size()) + " studies; expected " +
                                 std::to_string(all.points.size() * studies));
    // Add up each point's studies in their order.
    for (std::size_t p = 0; p < all.points.size(); ++p) {
        PowerPoint& point = all.points[p];
        const double share = 1.0 / question.studies;
        for (const PlanRow& row : all.plans[p]) point.sigmas.push_back({row.sigma, 0.0, 0.0, 0.0});
        std::map<double, int> decided{{0.0, 0}};
        for (const PlanRow& row : all.plans[p]) decided[row.sigma] = 0;
        int survived = 0;
        std::vector<std::array<int, 3>> counts(point.sigmas.size());
        for (std::size_t i = p * studies; i < (p + 1) * studies; ++i) {
            for (std::size_t s = 0; s < point.sigmas.size(); ++s) {
                counts[s][0] += outcomes[i].cochran[s];
                counts[s][1] += outcomes[i].permutation[s];
                counts[s][2] += outcomes[i].undefined[s];
            }
            survived += outcomes[i].any_holm ? 1 : 0;
            point.wilson_width += share * outcomes[i].wilson_width;
            point.clustered_width += share * outcomes[i].clustered_width;
            ++decided[outcomes[i].decided_sigma];
        }
        for (std::size_t s = 0; s < point.sigmas.size(); ++s) {
            point.sigmas[s].cochran = share * counts[s][0];
            point.sigmas[s].permutation = share * counts[s][1];
            point.sigmas[s].undefined = share * counts[s][2];
        }
        point.any_holm = share * survived;
        for (const auto& [sigma, count] : decided) point.decided_sigma.push_back({sigma, share * count});
    }
    return all.points;
}

std::vector<PowerPoint> simulate_power(const PowerQuestion& question,
                                       const std::function<void(std::int64_t, std::int64_t)>& progress) {
    return power_of_studies(question, simulate_studies(question, {}, progress));
}

}  // namespace parafovea
