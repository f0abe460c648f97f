// How far a threshold of a whole group may lie off because other people could have been asked.
#include "analysis/psychometric_people.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "analysis/expanded_percentile.h"
#include "analysis/random_draw.h"

namespace parafovea {

std::optional<CriterionThreshold> threshold_over_people(
    std::span<const std::vector<PsychometricLevel>> people, const PsychometricFit& group,
    const PsychometricFitOptions& options, int resamples) {
    const auto took_part = [](const std::vector<PsychometricLevel>& levels) {
        return std::any_of(levels.begin(), levels.end(),
                           [](const PsychometricLevel& level) { return level.n > 0; });
    };
    std::vector<const std::vector<PsychometricLevel>*> asked;
    for (const auto& levels : people)
        if (took_part(levels)) asked.push_back(&levels);
    if (asked.size() < 2 || resamples < 1) return std::nullopt;

    // Lay the counts out over the group's levels, so that a resample is a sum of rows.
    const std::size_t width = group.levels.size();
    std::vector<PsychometricLevel> rows(asked.size() * width);
    for (std::size_t i = 0; i < asked.size(); ++i)
        for (const PsychometricLevel& level : *asked[i]) {
            const auto at = std::lower_bound(group.levels.begin(), group.levels.end(), level.x,
                                             [](const PsychometricLevel& a, double x) { return a.x < x; });
            assert(level.n == 0 || (at != group.levels.end() && at->x == level.x));
            if (at == group.levels.end()) continue;
            PsychometricLevel& cell = rows[i * width + static_cast<std::size_t>(at - group.levels.begin())];
            cell.n += level.n;
            cell.different += level.different;
        }

    PsychometricFitOptions search = options;
    search.draws = 0;
    search.start = group.best;
    // All resamples share the priors of the whole group, also where a resample lacks its outermost levels.
    const Interval range{group.levels.front().x, group.levels.back().x};
    if (!search.model.x_range && range.high > range.low) search.model.x_range = range;

    std::mt19937_64 generator(options.seed);
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    std::vector<double> thresholds;
    std::vector<PsychometricLevel> drawn(width);
    for (int r = 0; r < resamples; ++r) {
        for (std::size_t j = 0; j < width; ++j) drawn[j] = {group.levels[j].x, 0, 0};
        for (std::size_t i = 0; i < asked.size(); ++i) {
            const std::size_t row = draw_below(generator, static_cast<std::uint32_t>(asked.size())) * width;
            for (std::size_t j = 0; j < width; ++j) {
                drawn[j].n += rows[row + j].n;
                drawn[j].different += rows[row + j].different;
            }
        }
        const auto fit = fit_psychometric(drawn, search);
        if (!fit) continue;
        if (fit->at_criterion.value)
            thresholds.push_back(*fit->at_criterion.value);
        else
            thresholds.push_back(fit->best.gamma >= options.criterion_share ? -kInfinity : kInfinity);
    }
    if (thresholds.empty()) return std::nullopt;
    std::sort(thresholds.begin(), thresholds.end());
    const auto quantile = [&](double share) {
        return thresholds[static_cast<std::size_t>(
            std::lround(share * static_cast<double>(thresholds.size() - 1)))];
    };
    const CriterionThreshold& credible = group.at_criterion;
    CriterionThreshold result{credible.value, {}, {}, credible.median};
    const double low = quantile(0.025), high = quantile(0.975);
    if (!credible.low || !credible.high || !credible.median || !std::isfinite(low) || !std::isfinite(high)) {
        // Where an end lies beyond everything, the other is the draws' own.
        const double tail = expanded_percentile_tail(static_cast<std::int64_t>(asked.size()));
        if (credible.low && std::isfinite(quantile(tail)))
            result.low = std::min(*credible.low, quantile(tail));
        if (credible.high && std::isfinite(quantile(1.0 - tail)))
            result.high = std::max(*credible.high, quantile(1.0 - tail));
        return result;
    }
    const double wider = student_widening(static_cast<std::int64_t>(asked.size())) *
                         std::max(1.0, (high - low) / std::max(*credible.high - *credible.low, 1e-300));
    result.low = *credible.median - wider * (*credible.median - *credible.low);
    result.high = *credible.median + wider * (*credible.high - *credible.median);
    return result;
}

}  // namespace parafovea
