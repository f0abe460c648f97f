// Validation trials: did a participant attend, and what would a guesser or an attentive person have scored?
#include "analysis/validation.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cassert>

#include "analysis/csv_text.h"
#include "analysis/number_text.h"

namespace parafovea {

double probability_of_passing(std::int64_t needed, std::int64_t trials, double p_right) {
    assert(trials >= 0 && p_right >= 0.0 && p_right <= 1.0);
    if (needed <= 0) return 1.0;
    if (needed > trials) return 0.0;
    const boost::math::binomial_distribution<double> right(static_cast<double>(trials), p_right);
    return boost::math::cdf(boost::math::complement(right, static_cast<double>(needed - 1)));
}

std::vector<ValidationRow> validation_rows(const Tally& tally) {
    std::vector<ValidationRow> rows;
    const auto counts = tally.validation_by_participant();
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (counts[i].n == 0) continue;
        ValidationRow row;
        row.participant = tally.participants()[i];
        row.trials = counts[i].n;
        row.right = counts[i].successes;
        row.p_guesser = probability_of_passing(row.right, row.trials, 0.5);
        row.p_attentive = 1.0 - probability_of_passing(row.right + 1, row.trials, 0.95);
        rows.push_back(row);
    }
    return rows;
}

std::string validation_csv(const std::vector<ValidationRow>& rows) {
    std::string csv = "participant,trials,right,pass_rate,p_guesser,p_attentive\n";
    for (const ValidationRow& row : rows)
        csv += csv_field(row.participant) + "," + std::to_string(row.trials) + "," +
               std::to_string(row.right) + "," +
               general_text(static_cast<double>(row.right) / static_cast<double>(row.trials), 9) + "," +
               general_text(row.p_guesser, 6) + "," + general_text(row.p_attentive, 6) + "\n";
    return csv;
}

}  // namespace parafovea
