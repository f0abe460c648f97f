// P_I of every condition: the numbers behind Figures 9 and 10.
#include "analysis/condition_table.h"

#include "analysis/number_text.h"

namespace parafovea {

std::vector<ConditionRow> condition_rows(const Tally& tally) {
    std::vector<ConditionRow> rows;
    for (double sigma : tally.sigmas()) {
        for (double alpha : tally.alphas()) {
            if (!tally.has({sigma, alpha})) continue;
            const auto clusters = tally.by_participant({sigma, alpha});
            std::int64_t n = 0, identical = 0;
            for (const ClusterCount& cluster : clusters) {
                n += cluster.n;
                identical += cluster.successes;
            }
            rows.push_back({sigma, alpha, proportion(identical, n), clustered_standard_error(clusters)});
        }
    }
    return rows;
}

std::string condition_csv(const std::vector<ConditionRow>& rows) {
    std::string csv =
        "sigma,sigma2,alpha,n,identical,p_identical,se,se_clustered,wilson_low,wilson_high,"
        "clopper_pearson_low,clopper_pearson_high\n";
    const auto ends = [](const std::optional<Interval>& interval) {
        return interval ? general_text(interval->low, 9) + "," + general_text(interval->high, 9)
                        : std::string(",");
    };
    for (const ConditionRow& row : rows) {
        csv += short_text(row.sigma) + "," + general_text(row.sigma * row.sigma, 9) + "," +
               short_text(row.alpha) + "," + std::to_string(row.identical.n) + "," +
               std::to_string(row.identical.successes) + "," + csv_text(row.identical.p) + "," +
               csv_text(row.identical.standard_error) + "," + csv_text(row.clustered_se) + "," +
               ends(row.identical.wilson) + "," + ends(row.identical.clopper_pearson) + "\n";
    }
    return csv;
}

}  // namespace parafovea
