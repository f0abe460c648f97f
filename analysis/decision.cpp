// The decision of the study: the highest sigma at which pictures still pass for full resolution, and how sure
// that is.
#include "analysis/decision.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/expanded_percentile.h"
#include "analysis/number_text.h"
#include "analysis/random_draw.h"

namespace parafovea {
namespace {

// n and identical answers of every condition, conditions in rising order.
struct Counts {
    std::vector<std::int64_t> n, identical;
};

std::optional<std::size_t> choose(const std::vector<Condition>& conditions, const Counts& counts,
                                  double criterion) {
    std::optional<std::size_t> best;
    const auto p = [&](std::size_t i) {
        return static_cast<double>(counts.identical[i]) / static_cast<double>(counts.n[i]);
    };
    for (std::size_t i = 0; i < conditions.size(); ++i) {
        // Shares such as 0.8 = 4 / 5 must not fail by rounding.
        if (counts.n[i] == 0 || p(i) < criterion - 1e-12) continue;
        if (!best || conditions[i].sigma > conditions[*best].sigma ||
            (conditions[i].sigma == conditions[*best].sigma && p(i) > p(*best)))
            best = i;
    }
    return best;
}

std::string percent(double share) {
    return fixed_text(100.0 * share, 1) + " %";
}

}  // namespace

Decision decide(const Tally& tally, double criterion, double margin, int resamples, std::uint64_t seed) {
    Decision decision;
    decision.criterion = criterion;
    std::vector<Condition> conditions;
    for (double sigma : tally.sigmas())
        for (double alpha : tally.alphas())
            if (tally.has({sigma, alpha})) conditions.push_back({sigma, alpha});

    // Lay out the counts by participant, so that a resample is a sum of rows.
    const std::size_t people = tally.participants().size(), width = conditions.size();
    std::vector<std::int64_t> n(people * width), identical(people * width);
    Counts all{std::vector<std::int64_t>(width, 0), std::vector<std::int64_t>(width, 0)};
    for (std::size_t c = 0; c < width; ++c) {
        const auto clusters = tally.by_participant(conditions[c]);
        for (std::size_t i = 0; i < people; ++i) {
            all.n[c] += n[i * width + c] = clusters[i].n;
            all.identical[c] += identical[i * width + c] = clusters[i].successes;
        }
    }
    const auto chosen = choose(conditions, all, criterion);
    if (chosen) {
        decision.chosen = conditions[*chosen];
        decision.identical = proportion(all.identical[*chosen], all.n[*chosen]);
    }
    if (people < 2 || resamples < 1) return decision;

    // Draw participants with replacement and decide anew each time.
    std::mt19937_64 generator(seed);
    decision.resamples = resamples;
    std::map<double, int> sigma_count;  // 0 stands for none
    std::vector<double> shares;
    int reached = 0, again = 0;
    Counts counts = all;
    for (int r = 0; r < resamples; ++r) {
        std::fill(counts.n.begin(), counts.n.end(), 0);
        std::fill(counts.identical.begin(), counts.identical.end(), 0);
        for (std::size_t i = 0; i < people; ++i) {
            const std::size_t row = draw_below(generator, static_cast<std::uint32_t>(people)) * width;
            for (std::size_t c = 0; c < width; ++c) {
                counts.n[c] += n[row + c];
                counts.identical[c] += identical[row + c];
            }
        }
        const auto pick = choose(conditions, counts, criterion);
        ++sigma_count[pick ? conditions[*pick].sigma : 0.0];
        if (!chosen) continue;
        again += pick == chosen ? 1 : 0;
        if (counts.n[*chosen] == 0) continue;
        const double p =
            static_cast<double>(counts.identical[*chosen]) / static_cast<double>(counts.n[*chosen]);
        shares.push_back(p);
        reached += p >= criterion - 1e-12 ? 1 : 0;
    }
    for (const auto& [sigma, count] : sigma_count)
        decision.highest_sigma.push_back(
            {sigma > 0.0 ? std::optional(sigma) : std::nullopt, static_cast<double>(count) / resamples});
    if (!chosen || shares.empty()) return decision;
    decision.probability_reached = static_cast<double>(reached) / static_cast<double>(shares.size());
    decision.probability_chosen = static_cast<double>(again) / resamples;
    std::sort(shares.begin(), shares.end());
    const auto quantile = [&](double share) {
        return shares[static_cast<std::size_t>(std::lround(share * static_cast<double>(shares.size() - 1)))];
    };
    const double tail = expanded_percentile_tail(static_cast<std::int64_t>(people));
    decision.bootstrap = {quantile(tail), quantile(1.0 - tail)};
    NonInferiority test;
    test.margin = margin;
    test.low = std::min(quantile(0.05), proportion(all.identical[*chosen], all.n[*chosen], 0.90).wilson->low);
    test.non_inferior = test.low > criterion - margin;
    decision.non_inferiority = test;
    return decision;
}

std::string decision_text(const Decision& decision) {
    const std::string criterion = general_text(100.0 * decision.criterion, 4) + " %";
    if (!decision.chosen) return "No setting reaches the criterion of " + criterion + " identical.";
    std::string text = "The highest σ with a setting that reaches " + criterion +
                       " identical is σ = " + short_text(decision.chosen->sigma) +
                       " (σ² = " + fixed_text(decision.chosen->sigma * decision.chosen->sigma, 2) +
                       ") with α = " + short_text(decision.chosen->alpha) +
                       ": P_I = " + percent(*decision.identical.p) + " (95 % Wilson interval " +
                       percent(decision.identical.wilson->low) + " to " +
                       percent(decision.identical.wilson->high) + ").";
    if (decision.resamples == 0)
        return text + " With one participant nothing can be said about other people.";
    text += " When the participants are drawn anew with replacement (" + std::to_string(decision.resamples) +
            " times), this setting reaches the criterion in " + percent(decision.probability_reached) +
            " of the draws and is the one chosen in " + percent(decision.probability_chosen) +
            "; the 95 % interval of its P_I over people is " + percent(decision.bootstrap.low) + " to " +
            percent(decision.bootstrap.high) + ".";
    if (decision.non_inferiority) {
        const NonInferiority& test = *decision.non_inferiority;
        text += " Non-inferiority with the margin of " + fixed_text(100.0 * test.margin, 0) +
                " points fixed beforehand: the one-sided 95 % lower bound " + percent(test.low) + " is " +
                (test.non_inferior ? "above " : "not above ") + percent(decision.criterion - test.margin) +
                (test.non_inferior
                     ? ", so P_I is shown to lie no more than the margin below the criterion."
                     : ", so the data do not show that P_I lies within the margin of the criterion.");
    }
    text +=
        " The setting was picked for its high P_I from the same answers, so a fresh study should expect "
        "somewhat less.";
    return text;
}

}  // namespace parafovea
