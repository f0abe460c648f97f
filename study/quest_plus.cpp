// The posterior over the grid, and the expected entropy of each next level.
#include "study/quest_plus.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace parafovea {
namespace {

std::vector<QuestPlusEstimate> grid_of(const QuestPlus& quest) {
    std::vector<QuestPlusEstimate> grid;
    for (const double threshold : quest.thresholds)
        for (const double slope : quest.slopes)
            for (const double lapse : quest.lapses) {
                if (quest.guess_is_lapse) grid.push_back({threshold, slope, lapse, lapse});
                if (!quest.guess_is_lapse)
                    for (const double guess : quest.guesses) grid.push_back({threshold, slope, guess, lapse});
            }
    assert(!grid.empty() && !quest.levels.empty());
    return grid;
}

std::vector<double> posterior_of(const QuestPlus& quest, const std::vector<QuestPlusEstimate>& grid,
                                 const std::vector<QuestPlusTrial>& trials) {
    std::vector<double> posterior(grid.size(), 1.0 / static_cast<double>(grid.size()));
    for (const QuestPlusTrial& trial : trials) {
        const double level = quest.levels.at(static_cast<std::size_t>(trial.level));
        double sum = 0;
        for (std::size_t i = 0; i < grid.size(); ++i) {
            const double positive = psychometric_probability(quest.shape, level, grid[i]);
            posterior[i] *= trial.positive ? positive : 1 - positive;
            sum += posterior[i];
        }
        // Answers that the grid holds to be impossible leave it as it was.
        if (sum > 0)
            for (double& probability : posterior) probability /= sum;
        else
            std::fill(posterior.begin(), posterior.end(), 1.0 / static_cast<double>(grid.size()));
    }
    return posterior;
}

double entropy_term(double probability) {
    return probability > 0 ? -probability * std::log(probability) : 0;
}

// The entropy expected after one more trial at the level.
double expected_entropy(const QuestPlus& quest, const std::vector<QuestPlusEstimate>& grid,
                        const std::vector<double>& posterior, double level) {
    double positive_sum = 0, positive_terms = 0, negative_sum = 0, negative_terms = 0;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        const double positive = posterior[i] * psychometric_probability(quest.shape, level, grid[i]);
        const double negative = posterior[i] - positive;
        positive_sum += positive;
        negative_sum += negative;
        positive_terms += entropy_term(positive);
        negative_terms += entropy_term(negative);
    }
    // Sum over outcomes of P(outcome) H(posterior | outcome), with H written for unnormalised weights.
    return positive_terms - entropy_term(positive_sum) + negative_terms - entropy_term(negative_sum);
}

}  // namespace

double psychometric_probability(PsychometricShape shape, double level, const QuestPlusEstimate& parameters) {
    const double rising =
        shape == PsychometricShape::weibull_db
            ? 1 - std::exp(-std::pow(10, parameters.slope * (level - parameters.threshold) / 20))
            : 0.5 * std::erfc(-(level - parameters.threshold) / (parameters.slope * std::numbers::sqrt2));
    return parameters.guess + (1 - parameters.guess - parameters.lapse) * rising;
}

int quest_plus_next(const QuestPlus& quest, const std::vector<QuestPlusTrial>& trials) {
    const std::vector<QuestPlusEstimate> grid = grid_of(quest);
    const std::vector<double> posterior = posterior_of(quest, grid, trials);
    int best = 0;
    double least = 0;
    for (std::size_t i = 0; i < quest.levels.size(); ++i) {
        const double entropy = expected_entropy(quest, grid, posterior, quest.levels[i]);
        // Differences in the last digits are rounding. Where a curve has saturated, each higher level still
        // teaches a trifle more than double precision can tell: of equals the last.
        if (i == 0 || entropy < least + 1e-12) {
            best = static_cast<int>(i);
            least = entropy;
        }
    }
    return best;
}

QuestPlusEstimate quest_plus_mode(const QuestPlus& quest, const std::vector<QuestPlusTrial>& trials) {
    const std::vector<QuestPlusEstimate> grid = grid_of(quest);
    const std::vector<double> posterior = posterior_of(quest, grid, trials);
    return grid[static_cast<std::size_t>(std::max_element(posterior.begin(), posterior.end()) -
                                         posterior.begin())];
}

QuestPlusEstimate quest_plus_mean(const QuestPlus& quest, const std::vector<QuestPlusTrial>& trials) {
    const std::vector<QuestPlusEstimate> grid = grid_of(quest);
    const std::vector<double> posterior = posterior_of(quest, grid, trials);
    QuestPlusEstimate mean;
    for (std::size_t i = 0; i < grid.size(); ++i) {
        mean.threshold += posterior[i] * grid[i].threshold;
        mean.slope += posterior[i] * grid[i].slope;
        mean.guess += posterior[i] * grid[i].guess;
        mean.lapse += posterior[i] * grid[i].lapse;
    }
    return mean;
}

}  // namespace parafovea
