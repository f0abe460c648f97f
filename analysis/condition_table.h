// P_I of every condition: the numbers behind Figures 9 and 10.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "analysis/tally.h"

namespace parafovea {

struct ConditionRow {
    double sigma = 0.0;
    double alpha = 0.0;
    Proportion identical;
    std::optional<double> clustered_se;  // participants as clusters
};

// In rising order of sigma, then alpha.
std::vector<ConditionRow> condition_rows(const Tally& tally);

// CSV with the columns sigma, sigma2, alpha, n, identical, p_identical, se, se_clustered, wilson_low,
// wilson_high, clopper_pearson_low, clopper_pearson_high; what is not defined is empty.
std::string condition_csv(const std::vector<ConditionRow>& rows);

}  // namespace parafovea
