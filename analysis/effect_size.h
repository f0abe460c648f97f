// How large a difference Cochran's Q has found.
#pragma once

#include <optional>

#include "analysis/cochran_q.h"

namespace parafovea {

struct EffectSize {
    // Q / (n (k - 1)) with n counting every row, uniform ones too (Serlin, Carr and Marascuilo 1982); equals
    // Kendall's W corrected for ties. Absent when Q is undefined.
    std::optional<double> eta2_q;
    // Chance-corrected agreement R = 1 - delta / E(delta) (Berry, Johnston and Mielke 2007). Can be negative.
    // Absent with fewer than two rows, or when every arrangement has the same delta of 0.
    std::optional<double> berry_r;
};

EffectSize effect_size(const BinaryTable& table);

}  // namespace parafovea
