// Percentiles of a bootstrap over few people, moved outward so that the interval keeps its promise.
#pragma once

#include <cstdint>

namespace parafovea {

// The share of the draws below the lower end of a 95 % interval over n >= 2 people: 0.025 for endlessly many,
// less for few, as Student's t is wider than the normal distribution, times sqrt(n / (n - 1)) (Hesterberg
// 2015, "expanded percentile").
double expanded_percentile_tail(std::int64_t n);

// The same as a factor on the width of a normal interval: 1 for endlessly many, 1.108 for 18.
double student_widening(std::int64_t n);

}  // namespace parafovea
