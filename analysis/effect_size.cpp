// How large a difference Cochran's Q has found.
#include "analysis/effect_size.h"

namespace parafovea {

EffectSize effect_size(const BinaryTable& table) {
    CochranQOptions options;
    options.exact = false;
    const CochranQ q = cochran_q(table, options);
    EffectSize result;
    if (q.q && q.df > 0) result.eta2_q = *q.q / (static_cast<double>(q.rows) * q.df);
    if (q.rows < 2) return result;

    // delta: mean distance of two rows' answers within a condition; its mean over all arrangements of the
    // rows.
    const double n = static_cast<double>(q.rows), k = static_cast<double>(q.columns);
    double delta = 0.0;
    for (std::int64_t total : q.column_totals)
        delta += static_cast<double>(total) * (n - static_cast<double>(total));
    delta /= k * n * (n - 1.0) / 2.0;
    double sum = 0.0, within = 0.0;
    for (std::size_t i = 0; i < table.rows(); ++i) {
        double ones = 0.0;
        for (std::uint8_t value : table.row(i)) ones += value != 0 ? 1.0 : 0.0;
        sum += ones / k;
        within += ones / k * (1.0 - ones / k);
    }
    const double expected = 2.0 * (sum * (n - sum) - within) / (n * (n - 1.0));
    if (expected > 1e-12) result.berry_r = 1.0 - delta / expected;
    return result;
}

}  // namespace parafovea
