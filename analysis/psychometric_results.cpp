// Psychometric functions of a study: P("different") against sigma^2, for every alpha and every participant.
#include "analysis/psychometric_results.h"

#include <cmath>

#include "analysis/csv_text.h"
#include "analysis/number_text.h"
#include "analysis/parallel.h"
#include "analysis/psychometric_people.h"

namespace parafovea {
namespace {

constexpr std::size_t kMostIndividuals = 60;
constexpr int kResamples = 400;

struct Job {
    std::optional<std::size_t> participant;
    double alpha;
    Sigmoid sigmoid;
    std::vector<PsychometricLevel> levels;
    const std::vector<std::vector<PsychometricLevel>>*
        people;  // whose answers the levels join; null for one person
    std::optional<PsychometricFit> fit;
    std::optional<CriterionThreshold> over_people;
};

const char* name_of(Sigmoid sigmoid) {
    switch (sigmoid) {
        case Sigmoid::logistic:
            return "logistic";
        case Sigmoid::normal:
            return "normal";
        case Sigmoid::weibull:
            return "weibull";
    }
    return "";
}

}  // namespace

PsychometricResults psychometric_results(const Tally& tally, double criterion, std::uint64_t seed,
                                         Dispersion dispersion) {
    PsychometricResults results;
    results.criterion = criterion;
    const std::size_t people = tally.participants().size();
    results.individuals_left_out = people > kMostIndividuals;
    if (!results.individuals_left_out) results.participants = tally.participants();

    // Gather the counts of every fit, everybody's first.
    std::vector<Job> jobs;
    std::vector<std::vector<std::vector<PsychometricLevel>>> by_alpha(tally.alphas().size());
    for (std::size_t a = 0; a < by_alpha.size(); ++a) {
        const double alpha = tally.alphas()[a];
        std::vector<PsychometricLevel> pooled;
        std::vector<std::vector<PsychometricLevel>>& individual = by_alpha[a];
        individual.resize(people);
        for (double sigma : tally.sigmas()) {
            if (!tally.has({sigma, alpha})) continue;
            PsychometricLevel all{sigma * sigma, 0, 0};
            const auto counts = tally.by_participant({sigma, alpha});
            for (std::size_t i = 0; i < counts.size(); ++i) {
                all.n += counts[i].n;
                all.different += counts[i].n - counts[i].successes;
                if (counts[i].n > 0)
                    individual[i].push_back({sigma * sigma, counts[i].n, counts[i].n - counts[i].successes});
            }
            pooled.push_back(all);
        }
        for (Sigmoid sigmoid : {Sigmoid::logistic, Sigmoid::normal, Sigmoid::weibull})
            jobs.push_back({std::nullopt, alpha, sigmoid, pooled, &individual, {}, {}});
        for (std::size_t i = 0; i < results.participants.size(); ++i)
            jobs.push_back({i, alpha, Sigmoid::logistic, individual[i], nullptr, {}, {}});
    }
    parallel_for(jobs.size(), [&](std::size_t i) {
        PsychometricFitOptions options;
        options.model.sigmoid = jobs[i].sigmoid;
        options.model.dispersion = dispersion;
        options.criterion_share = 1.0 - criterion;
        options.seed = seed + i;
        options.draws = jobs[i].participant ? 2000 : 10'000;
        jobs[i].fit = fit_psychometric(jobs[i].levels, options);
        if (jobs[i].fit && jobs[i].people)
            jobs[i].over_people = threshold_over_people(*jobs[i].people, *jobs[i].fit, options, kResamples);
    });
    for (Job& job : jobs) {
        if (!job.fit) continue;
        auto& list = job.participant                    ? results.individual
                     : job.sigmoid == Sigmoid::logistic ? results.pooled
                                                        : results.other_sigmoids;
        list.push_back({job.participant, job.alpha, std::move(*job.fit), job.over_people});
    }
    return results;
}

std::string psychometric_csv(const PsychometricResults& results) {
    std::string csv =
        "participant,alpha,sigmoid,trials,threshold,threshold_low,threshold_high,width,width_low,width_high,"
        "lambda,gamma,eta,"
        "sigma2_at_criterion,sigma2_at_criterion_low,sigma2_at_criterion_high,sigma_at_criterion,negative_"
        "log_posterior,sigma2_over_people_low,sigma2_over_people_high,warnings\n";
    const auto add = [&](const StudyFit& study_fit) {
        const PsychometricFit& fit = study_fit.fit;
        std::int64_t trials = 0;
        for (const PsychometricLevel& level : fit.levels) trials += level.n;
        std::string warnings;
        for (const std::string& warning : fit.warnings) warnings += (warnings.empty() ? "" : "; ") + warning;
        csv += csv_field(study_fit.participant ? results.participants[*study_fit.participant] : "all") + "," +
               short_text(study_fit.alpha) + "," + name_of(fit.model.sigmoid) + "," + std::to_string(trials);
        for (double value : {fit.best.threshold, fit.threshold.low, fit.threshold.high, fit.best.width,
                             fit.width.low, fit.width.high, fit.best.lambda, fit.best.gamma, fit.best.eta})
            csv += "," + general_text(value, 6);
        const CriterionThreshold& at = fit.at_criterion;
        csv += "," + csv_text(at.value, 6) + "," + csv_text(at.low, 6) + "," + csv_text(at.high, 6) + "," +
               (at.value && *at.value >= 0.0 ? general_text(std::sqrt(*at.value), 6) : std::string()) + "," +
               general_text(fit.negative_log_posterior, 9) + "," +
               csv_text(study_fit.over_people ? study_fit.over_people->low : std::nullopt, 6) + "," +
               csv_text(study_fit.over_people ? study_fit.over_people->high : std::nullopt, 6) + "," +
               csv_field(warnings) + "\n";
    };
    for (const auto* list : {&results.pooled, &results.other_sigmoids, &results.individual})
        for (const StudyFit& fit : *list) add(fit);
    return csv;
}

}  // namespace parafovea
