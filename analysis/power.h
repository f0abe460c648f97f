// Power by simulation: studies of the planned design with assumed participants, analysed as the real one will
// be.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "analysis/tally.h"

namespace parafovea {

// One condition of the plan and how often a participant meets it in one session.
struct PlanCell {
    Condition condition;
    int trials_per_session = 1;
};

// P("different") of the average participant at one alpha: logistic in sigma^2.
struct AssumedFunction {
    double alpha = 1.0;
    double threshold = 4.0;  // sigma^2 where half of the answers are "different"
    double width = 5.0;      // of sigma^2, from 5 to 95 %
};

struct PowerAssumptions {
    std::vector<AssumedFunction> functions;  // one for every alpha of the plan
    double lapse_rate = 0.02;
    double guess_rate = 0.05;
    // Spread between people of their threshold, in logit units: the same in all conditions, and anew in each
    // condition.
    double participant_sd = 1.0;
    double condition_sd = 0.5;
    // Multiplies the differences between the alphas' thresholds and their mean: 0 is the null hypothesis, 1
    // as assumed.
    double effect = 1.0;
};

// The functions fitted to an earlier study, from the psychometric.csv that the analysis writes (its "all"
// rows with the logistic function). Throws std::runtime_error naming file and line when it cannot be read or
// holds no such row.
PowerAssumptions read_power_assumptions(const std::filesystem::path& psychometric_csv);

struct PowerQuestion {
    std::vector<PlanCell> plan;
    PowerAssumptions assumptions;
    std::vector<int> participants{12, 18, 24, 36};
    std::vector<int> sessions{2};
    std::vector<double> effects{1.0};
    int studies = 1000;  // simulated per combination
    int permutations = 199;
    double criterion = 0.8;
    double level = 0.05;
    std::uint64_t seed = 1;
};

struct SigmaPower {
    double sigma = 0.0;
    double cochran = 0.0;      // share of studies with Q's chi-square p below the level
    double permutation = 0.0;  // with the p within participants below it; the one that keeps the level
    double undefined = 0.0;    // without an informative block
};

struct PowerPoint {
    int participants = 0;
    int sessions = 0;
    double effect = 1.0;
    int studies = 0;
    std::vector<SigmaPower> sigmas;
    double any_holm =
        0.0;  // share of studies in which some sigma survives Holm's adjustment of the permutation p
    double wilson_width = 0.0;     // mean over conditions and studies
    double clustered_width = 0.0;  // 2 x 1.96 clustered standard errors, the same mean
    std::vector<std::pair<double, double>>
        decided_sigma;  // highest accepted sigma (0: none) and its share of the studies
};

// Standard error of a simulated share: at most 1 / (2 sqrt(studies)).
double monte_carlo_error(double share, int studies);

// What one simulated study found; a value for each sigma of the plan, in rising order.
struct SimulatedStudy {
    std::vector<std::uint8_t> cochran, permutation, undefined;  // see SigmaPower
    bool any_holm = false;
    double wilson_width = 0.0, clustered_width = 0.0;
    double decided_sigma = 0.0;

    bool operator==(const SimulatedStudy&) const = default;
};

// Which of a question's studies to simulate: the index-th, counted from 1, of every `count`.
struct StudyShard {
    int index = 1;
    int count = 1;

    bool operator==(const StudyShard&) const = default;
};

// How many studies there are: those of every combination of participants, sessions and effects.
std::size_t study_count(const PowerQuestion& question);

// Simulates a shard's studies in their order. Runs on all cores; what a study finds does not depend on how
// many, nor on the shard. progress, when given, is called with studies done and all, from any thread but one
// at a time. Throws std::runtime_error when the plan is empty or an alpha of the plan has no assumed
// function.
std::vector<SimulatedStudy> simulate_studies(
    const PowerQuestion& question, const StudyShard& shard = {},
    const std::function<void(std::int64_t, std::int64_t)>& progress = {});

// Adds up all studies of a question, in their order.
std::vector<PowerPoint> power_of_studies(const PowerQuestion& question,
                                         const std::vector<SimulatedStudy>& studies);

// The two above in one.
std::vector<PowerPoint> simulate_power(const PowerQuestion& question,
                                       const std::function<void(std::int64_t, std::int64_t)>& progress = {});

// CSV: participants, sessions, effect, studies, sigma, power_cochran, power_permutation, se_permutation,
// undefined, any_holm, wilson_width, clustered_width, decided_share (of the studies: this sigma is the
// highest accepted one).
std::string power_csv(const std::vector<PowerPoint>& points);
std::string power_markdown(const std::vector<PowerPoint>& points, const PowerQuestion& question);

// Writes power.csv, power.md and power.{svg,pdf,png} into out; gives their paths.
std::vector<std::filesystem::path> write_power(const std::vector<PowerPoint>& points,
                                               const PowerQuestion& question,
                                               const std::filesystem::path& out);

}  // namespace parafovea
