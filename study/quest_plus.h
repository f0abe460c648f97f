// QUEST+: the level that is expected to teach most, as a pure function of the answers so far.
#pragma once

#include <vector>

namespace parafovea {

// Watson 2017, "QUEST+: A general multidimensional Bayesian adaptive psychometric method", for one stimulus
// dimension and two outcomes. A prior that is uniform over a grid of parameters.
enum class PsychometricShape {
    weibull_db,  // guess + (1 - guess - lapse) (1 - exp(-10^(slope (x - threshold) / 20))), x and threshold
                 // in dB
    normal       // guess + (1 - guess - lapse) Phi((x - threshold) / slope): slope is the standard deviation
};

struct QuestPlus {
    PsychometricShape shape = PsychometricShape::normal;
    std::vector<double> levels;      // that may be shown
    std::vector<double> thresholds;  // the grid
    std::vector<double> slopes;
    std::vector<double> guesses = {0};  // probability of a positive answer far below threshold
    std::vector<double> lapses = {0};   // of a negative one far above
    bool guess_is_lapse = false;  // both ends are off by `lapse`; guesses is not used (Watson's example 3)
};

// One trial's level (an index into levels) and whether its answer was positive.
struct QuestPlusTrial {
    int level = 0;
    bool positive = false;
};

struct QuestPlusEstimate {
    double threshold = 0, slope = 0, guess = 0, lapse = 0;
};

// Probability of a positive answer.
double psychometric_probability(PsychometricShape shape, double level, const QuestPlusEstimate& parameters);

// The index of the level whose answer is expected to leave the least entropy; the last of equals.
int quest_plus_next(const QuestPlus& quest, const std::vector<QuestPlusTrial>& trials);

// The most probable point of the grid, and the mean over the grid.
QuestPlusEstimate quest_plus_mode(const QuestPlus& quest, const std::vector<QuestPlusTrial>& trials);
QuestPlusEstimate quest_plus_mean(const QuestPlus& quest, const std::vector<QuestPlusTrial>& trials);

}  // namespace parafovea
