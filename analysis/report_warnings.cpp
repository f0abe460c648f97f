// What a reader must be warned of, found by looking at the data as a careful reviewer would.
#include "analysis/report_warnings.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

#include "analysis/number_text.h"

namespace parafovea {
namespace {

constexpr double kTestLevel = 0.01;   // of checks that run on every study
constexpr double kDifference = 0.01;  // shares that differ by less cannot matter

std::string percent(double share) {
    return fixed_text(100.0 * share, 1) + " %";
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (std::size_t i = 0; i < words.size() && i < 8; ++i) text += (i ? ", " : "") + words[i];
    if (words.size() > 8) text += " and " + std::to_string(words.size() - 8) + " more";
    return text;
}

void dependence(std::vector<ReportWarning>& found, const std::vector<ConditionRow>& conditions,
                const CochranTable& cochran) {
    std::int64_t rows = 0, people = cochran.participants;
    for (const CochranRow& row : cochran.rows) rows = std::max(rows, row.q.rows);
    if (rows <= people || people == 0) return;
    // The design effect: how much larger the variance is with participants as units, over all conditions.
    double clustered = 0.0, plain = 0.0;
    for (const ConditionRow& row : conditions) {
        if (!row.clustered_se || !row.identical.standard_error) continue;
        clustered += *row.clustered_se * *row.clustered_se;
        plain += *row.identical.standard_error * *row.identical.standard_error;
    }
    std::string text =
        "Participants contribute several blocks (" + std::to_string(rows) + " blocks from " +
        std::to_string(people) +
        " participants). Q treats them as independent and rejects too often when people differ in which "
        "condition they notice; rely on the p value within participants.";
    if (plain > 0.0)
        text += " Variance with participants as units is " + fixed_text(clustered / plain, 2) +
                " times that over trials.";
    found.push_back({"Rows that are not independent", text});
}

void ceiling(std::vector<ReportWarning>& found, const std::vector<ConditionRow>& conditions,
             const CochranTable& cochran) {
    std::vector<std::string> sigmas;
    for (const CochranRow& row : cochran.rows) {
        bool all_high = true, all_low = true;
        for (const ConditionRow& condition : conditions) {
            if (condition.sigma != row.sigma || !condition.identical.p) continue;
            all_high = all_high && *condition.identical.p >= 0.95;
            all_low = all_low && *condition.identical.p <= 0.05;
        }
        if (all_high || all_low)
            sigmas.push_back("σ " + short_text(row.sigma) + (all_high ? " (ceiling)" : " (floor)"));
    }
    if (!sigmas.empty())
        found.push_back({"Ceiling or floor",
                         "Nearly all answers are the same for every α at " + joined(sigmas) +
                             ". Q has little power there; no significant difference does not mean that the "
                             "settings are indistinguishable. Read the intervals."});
}

void informative(std::vector<ReportWarning>& found, const CochranTable& cochran) {
    std::vector<std::string> few, none;
    for (const CochranRow& row : cochran.rows) {
        if (!row.q.q)
            none.push_back("σ " + short_text(row.sigma));
        else if (row.q.informative_rows < 4 || row.q.informative_rows * row.q.columns < 24)
            few.push_back("σ " + short_text(row.sigma) + " (" + std::to_string(row.q.informative_rows) + ")");
    }
    if (!few.empty())
        found.push_back({"Too few informative blocks",
                         "Blocks that tell the conditions apart are too few for the chi-square "
                         "distribution at " +
                             joined(few) +
                             "; use the exact p there (rule of Tate and Brown 1970: at "
                             "least 4, and 24 cells)."});
    if (!none.empty())
        found.push_back(
            {"No informative block", "At " + joined(none) + " every block is uniform, so Q is undefined."});
}

void attention(std::vector<ReportWarning>& found, const Tally& tally,
               const std::vector<ValidationRow>& validation) {
    std::vector<std::string> failed, guessing;
    for (const ValidationRow& row : validation) {
        const std::string score =
            row.participant + " (" + std::to_string(row.right) + " of " + std::to_string(row.trials) + ")";
        if (row.p_attentive < kTestLevel)
            failed.push_back(score);
        else if (row.p_guesser > 0.05 && row.trials >= 5)
            guessing.push_back(score);
    }
    if (!failed.empty())
        found.push_back({"Validation failures",
                         "Someone who recognises identical pictures 95 % of the time would score as low as " +
                             joined(failed) + " with a probability under " + percent(kTestLevel) +
                             ". These participants were inattentive or lean to “different”."});
    if (!guessing.empty())
        found.push_back(
            {"Validation cannot exclude guessing",
             "A guesser reaches the score of " + joined(guessing) + " with a probability above 5 %."});
    std::vector<std::string> always;
    std::vector<ClusterCount> sums(tally.participants().size());
    for (double sigma : tally.sigmas())
        for (double alpha : tally.alphas()) {
            const auto counts = tally.by_participant({sigma, alpha});
            for (std::size_t i = 0; i < counts.size(); ++i) {
                sums[i].n += counts[i].n;
                sums[i].successes += counts[i].successes;
            }
        }
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (sums[i].n >= 8 && (sums[i].successes == 0 || sums[i].successes == sums[i].n))
            always.push_back(tally.participants()[i] +
                             (sums[i].successes == 0 ? " (different)" : " (identical)"));
    if (!always.empty())
        found.push_back(
            {"One answer throughout",
             joined(always) +
                 " gave one and the same answer to every foveated trial. Identical "
                 "validation pairs cannot tell this from attention; obviously different pairs could."});
}

void uneven(std::vector<ReportWarning>& found, const Tally& tally,
            const std::vector<ConditionRow>& conditions, RunningMoments ConditionRecords::*member,
            const std::string& subject, const std::string& what) {
    std::vector<RunningMoments> groups;
    const RunningMoments* least = nullptr;
    const RunningMoments* most = nullptr;
    std::string least_name, most_name;
    for (const ConditionRow& row : conditions) {
        const RunningMoments& moments = tally.records({row.sigma, row.alpha}).*member;
        if (moments.n() == 0) continue;
        groups.push_back(moments);
        const std::string name = "σ " + short_text(row.sigma) + ", α " + short_text(row.alpha);
        if (!least || moments.mean() < least->mean()) least = &moments, least_name = name;
        if (!most || moments.mean() > most->mean()) most = &moments, most_name = name;
    }
    if (!least || most->mean() - least->mean() < kDifference) return;
    const auto p = equal_means_p(groups);
    if (!p || *p >= kTestLevel) return;
    found.push_back({subject, what + " differ between conditions: from " + percent(least->mean()) + " (" +
                                  least_name + ") to " + percent(most->mean()) + " (" + most_name + "), p " +
                                  (*p < 0.001 ? "< 0.001" : "= " + p_text(p)) +
                                  ". Participants may have judged this instead of the foveation."});
}

void interval_bias(std::vector<ReportWarning>& found, const Tally& tally,
                   const std::vector<ConditionRow>& conditions) {
    double first_n = 0, first = 0, second_n = 0, second = 0;
    for (const ConditionRow& row : conditions) {
        const ConditionRecords& records = tally.records({row.sigma, row.alpha});
        first_n += static_cast<double>(records.foveated_first.n);
        first += static_cast<double>(records.foveated_first.successes);
        second_n += static_cast<double>(records.foveated_second.n);
        second += static_cast<double>(records.foveated_second.successes);
    }
    if (first_n == 0.0 || second_n == 0.0) return;
    const double pooled = (first + second) / (first_n + second_n);
    const double variance = pooled * (1.0 - pooled) * (1.0 / first_n + 1.0 / second_n);
    if (variance <= 0.0) return;
    const double difference = first / first_n - second / second_n;
    const double p = chi_square_tail(difference * difference / variance, 1).p;
    if (p >= kTestLevel) return;
    found.push_back({"Interval bias",
                     "“Identical” is answered in " + percent(first / first_n) +
                         " of the trials with the foveated picture first and in " +
                         percent(second / second_n) + " with it second (p " +
                         (p < 0.001 ? "< 0.001" : "= " + p_text(p)) +
                         "). With a balanced order this widens the spread but does not favour a condition."});
}

void sample_size(std::vector<ReportWarning>& found, const Tally& tally, const StudyDescription& study) {
    const auto people = static_cast<std::int64_t>(tally.participants().size());
    if (study.planned_participants == 0)
        found.push_back({"Sample size not fixed beforehand",
                         "The data name no planned number of participants ([design] participants in the "
                         "protocol). If the study was "
                         "stopped after looking at results, the p values are too small."});
    else if (people < study.planned_participants)
        found.push_back(
            {"Fewer participants than planned",
             std::to_string(people) + " of " + std::to_string(study.planned_participants) +
                 " planned participants are analysed. If the study ended here because of its results, the p "
                 "values are too small; if it goes on, do not decide on these."});
    else if (people > study.planned_participants)
        found.push_back(
            {"Optional stopping",
             std::to_string(people) + " participants are analysed and " +
                 std::to_string(study.planned_participants) +
                 " were planned. If participants were added after looking at results, the p values are too "
                 "small."});
}

void exclusions(std::vector<ReportWarning>& found, const Tally& tally, const StudyDescription& study,
                const std::vector<ConditionRow>& conditions) {
    if (tally.excluded() == 0) return;
    if (study.exclusion_rules_hash.empty())
        found.push_back({"Exclusions without stored rules",
                         std::to_string(tally.excluded()) +
                             " trials were excluded, but no rules were stored before the first session."});
    double excluded = 0, kept = 0, statistic = 0;
    for (const ConditionRow& row : conditions) {
        excluded += static_cast<double>(tally.records({row.sigma, row.alpha}).excluded);
        kept += static_cast<double>(row.identical.n);
    }
    if (excluded < 10 || conditions.size() < 2) return;
    const double share = excluded / (excluded + kept);
    double least = 1.0, most = 0.0;
    for (const ConditionRow& row : conditions) {
        const double out = static_cast<double>(tally.records({row.sigma, row.alpha}).excluded);
        const double n = out + static_cast<double>(row.identical.n);
        if (n == 0.0) continue;
        statistic += (out - n * share) * (out - n * share) / (n * share * (1.0 - share));
        least = std::min(least, out / n);
        most = std::max(most, out / n);
    }
    if (share < 1.0 && chi_square_tail(statistic, static_cast<int>(conditions.size()) - 1).p < kTestLevel)
        found.push_back(
            {"Exclusions differ by condition",
             "Between " + percent(least) + " and " + percent(most) +
                 " of a condition's trials were excluded; compare the results with and without."});
}

}  // namespace

std::optional<double> equal_means_p(const std::vector<RunningMoments>& groups) {
    double n = 0.0, sum = 0.0, within = 0.0, used = 0.0;
    for (const RunningMoments& group : groups) {
        if (group.n() == 0) continue;
        n += static_cast<double>(group.n());
        sum += static_cast<double>(group.n()) * group.mean();
        within += group.sum_of_squares();
        used += 1.0;
    }
    if (used < 2.0 || n <= used) return std::nullopt;
    double between = 0.0;
    for (const RunningMoments& group : groups)
        between += static_cast<double>(group.n()) * (group.mean() - sum / n) * (group.mean() - sum / n);
    if (between <= 0.0) return 1.0;
    if (within <= 0.0) return 0.0;  // each group constant, and not all the same
    const double f = between / (used - 1.0) / (within / (n - used));
    return boost::math::cdf(
        boost::math::complement(boost::math::fisher_f_distribution<double>(used - 1.0, n - used), f));
}

std::vector<ReportWarning> find_warnings(const Tally& tally, const StudyDescription& study,
                                         const std::vector<ConditionRow>& conditions,
                                         const CochranTable& cochran,
                                         const std::vector<ValidationRow>& validation) {
    std::vector<ReportWarning> found;
    dependence(found, conditions, cochran);
    ceiling(found, conditions, cochran);
    informative(found, cochran);
    attention(found, tally, validation);
    uneven(found, tally, conditions, &ConditionRecords::dropped_frames, "Dropped frames differ by condition",
           "Missed refreshes");
    uneven(found, tally, conditions, &ConditionRecords::gaze_loss, "Gaze loss differs by condition",
           "Lost gaze samples");
    interval_bias(found, tally, conditions);
    sample_size(found, tally, study);
    exclusions(found, tally, study, conditions);
    std::int64_t incomplete = 0;
    for (const CochranRow& row : cochran.rows) incomplete += row.incomplete_blocks;
    if (incomplete > 0)
        found.push_back(
            {"Missing answers", std::to_string(incomplete) +
                                    " blocks lack an answer in some condition and are left out of Q whole."});
    if (tally.sites().size() > 1) {
        std::vector<std::string> names;
        for (const auto& [site, trials] : tally.sites())
            names.push_back(site + " (" + std::to_string(trials) + " trials)");
        found.push_back({"Several sites", "The data come from " + joined(names) +
                                              ". Differences between sites are not modelled."});
    }
    return found;
}

}  // namespace parafovea
