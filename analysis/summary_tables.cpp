// Tables beside the main ones: sensitivity, pairs of alphas, response times, results with and without
// exclusions.
#include "analysis/summary_tables.h"

#include <algorithm>
#include <cmath>

#include "analysis/csv_text.h"
#include "analysis/number_text.h"

namespace parafovea {

std::vector<SensitivityRow> sensitivity_rows(const Tally& tally,
                                             const std::vector<ConditionRow>& conditions) {
    std::int64_t same = 0, alarms = 0;
    for (const ClusterCount& count : tally.validation_by_participant()) {
        same += count.n;
        alarms += count.n - count.successes;
    }
    std::vector<SensitivityRow> rows;
    for (const ConditionRow& condition : conditions) {
        const auto rates = corrected_rates(condition.identical.n - condition.identical.successes,
                                           condition.identical.n, alarms, same);
        if (!rates) continue;
        rows.push_back({{condition.sigma, condition.alpha},
                        *rates,
                        yes_no_d_prime(*rates),
                        independent_observation_d_prime(*rates),
                        differencing_d_prime(*rates),
                        criterion(*rates)});
    }
    return rows;
}

std::string sensitivity_csv(const std::vector<SensitivityRow>& rows) {
    std::string csv =
        "sigma,alpha,hit_rate,false_alarm_rate,d_prime_yes_no,d_prime_independent,d_prime_differencing,"
        "criterion\n";
    for (const SensitivityRow& row : rows) {
        csv += short_text(row.condition.sigma) + "," + short_text(row.condition.alpha);
        for (double value : {row.rates.hit, row.rates.false_alarm, row.d_yes_no, row.d_independent,
                             row.d_differencing, row.criterion})
            csv += "," + general_text(value, 6);
        csv += "\n";
    }
    return csv;
}

std::vector<ParticipantSensitivity> participant_sensitivity(const Tally& tally) {
    std::vector<ClusterCount> foveated(tally.participants().size());
    for (double sigma : tally.sigmas())
        for (double alpha : tally.alphas()) {
            const auto counts = tally.by_participant({sigma, alpha});
            for (std::size_t i = 0; i < counts.size(); ++i) {
                foveated[i].n += counts[i].n;
                foveated[i].successes += counts[i].successes;
            }
        }
    const auto validation = tally.validation_by_participant();
    std::vector<ParticipantSensitivity> rows;
    for (std::size_t i = 0; i < foveated.size(); ++i) {
        const auto rates = corrected_rates(foveated[i].n - foveated[i].successes, foveated[i].n,
                                           validation[i].n - validation[i].successes, validation[i].n);
        if (!rates) continue;
        rows.push_back({tally.participants()[i], foveated[i].n, validation[i].n, *rates,
                        yes_no_d_prime(*rates), independent_observation_d_prime(*rates),
                        differencing_d_prime(*rates), criterion(*rates)});
    }
    return rows;
}

std::string participant_sensitivity_csv(const std::vector<ParticipantSensitivity>& rows) {
    std::string csv =
        "participant,different_trials,same_trials,hit_rate,false_alarm_rate,d_prime_yes_no,d_prime_"
        "independent,"
        "d_prime_differencing,criterion\n";
    for (const ParticipantSensitivity& row : rows) {
        csv += csv_field(row.participant) + "," + std::to_string(row.different_trials) + "," +
               std::to_string(row.same_trials);
        for (double value : {row.rates.hit, row.rates.false_alarm, row.d_yes_no, row.d_independent,
                             row.d_differencing, row.criterion})
            csv += "," + general_text(value, 6);
        csv += "\n";
    }
    return csv;
}

std::vector<SigmaEffects> sigma_effects(const Tally& tally) {
    std::vector<SigmaEffects> effects;
    for (double sigma : tally.sigmas()) {
        const BlockTable blocks = tally.blocks(sigma, BlockKind::participant_session);
        if (blocks.alphas.size() < 2) continue;
        effects.push_back({sigma, blocks.alphas, effect_size(blocks.table), pairwise_mcnemar(blocks.table)});
    }
    return effects;
}

std::string pairwise_csv(const std::vector<SigmaEffects>& effects) {
    std::string csv =
        "sigma,alpha_first,alpha_second,both_identical,first_only,second_only,neither,p_exact,p_mid,p_exact_"
        "holm,p_mid_holm,"
        "difference,difference_low,difference_high\n";
    for (const SigmaEffects& sigma : effects) {
        for (const PairwiseRow& row : sigma.pairs) {
            csv += short_text(sigma.sigma) + "," + short_text(sigma.alphas[row.first]) + "," +
                   short_text(sigma.alphas[row.second]);
            for (std::int64_t count :
                 {row.counts.both, row.counts.first_only, row.counts.second_only, row.counts.neither})
                csv += "," + std::to_string(count);
            for (double p : {row.test.p_exact, row.test.p_mid, row.holm_exact, row.holm_mid})
                csv += "," + general_text(p, 7);
            if (row.difference)
                csv += "," + general_text(row.difference->difference, 6) + "," +
                       general_text(row.difference->interval.low, 6) + "," +
                       general_text(row.difference->interval.high, 6);
            else
                csv += ",,,";
            csv += "\n";
        }
    }
    return csv;
}

std::vector<ResponseTimeRow> response_time_rows(const Tally& tally,
                                                const std::vector<ConditionRow>& conditions) {
    std::vector<ResponseTimeRow> rows;
    for (const ConditionRow& condition : conditions) {
        std::vector<float> times = tally.records({condition.sigma, condition.alpha}).response_times_s;
        if (times.empty()) continue;
        const auto quantile = [&](double share) {  // linear between neighbours, as R's type 7
            const double place = share * static_cast<double>(times.size() - 1);
            const auto below = static_cast<std::size_t>(place);
            std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(below), times.end());
            const double low = times[below];
            if (below + 1 >= times.size()) return low;
            const double high =
                *std::min_element(times.begin() + static_cast<std::ptrdiff_t>(below) + 1, times.end());
            return low + (place - static_cast<double>(below)) * (high - low);
        };
        ResponseTimeRow row{
            {condition.sigma, condition.alpha}, static_cast<std::int64_t>(times.size()), 0.0, 0.0, 0.0, 0.0};
        for (float time : times) row.mean_s += static_cast<double>(time) / static_cast<double>(times.size());
        row.median_s = quantile(0.5);
        row.lower_quartile_s = quantile(0.25);
        row.upper_quartile_s = quantile(0.75);
        rows.push_back(row);
    }
    return rows;
}

std::string response_time_csv(const std::vector<ResponseTimeRow>& rows) {
    std::string csv = "sigma,alpha,n,mean_s,median_s,lower_quartile_s,upper_quartile_s\n";
    for (const ResponseTimeRow& row : rows) {
        csv += short_text(row.condition.sigma) + "," + short_text(row.condition.alpha) + "," +
               std::to_string(row.n);
        for (double value : {row.mean_s, row.median_s, row.lower_quartile_s, row.upper_quartile_s})
            csv += "," + general_text(value, 6);
        csv += "\n";
    }
    return csv;
}

std::string exclusion_csv(const std::vector<ConditionRow>& applied,
                          const std::vector<ConditionRow>& ignored) {
    std::string csv =
        "sigma,alpha,n_with_exclusions,p_identical_with_exclusions,n_all_answers,p_identical_all_answers\n";
    for (const ConditionRow& all : ignored) {
        const auto same = std::find_if(applied.begin(), applied.end(), [&](const ConditionRow& row) {
            return row.sigma == all.sigma && row.alpha == all.alpha;
        });
        csv += short_text(all.sigma) + "," + short_text(all.alpha) + ",";
        csv += same == applied.end() ? "0,"
                                     : std::to_string(same->identical.n) + "," + csv_text(same->identical.p);
        csv += "," + std::to_string(all.identical.n) + "," + csv_text(all.identical.p) + "\n";
    }
    return csv;
}

}  // namespace parafovea
