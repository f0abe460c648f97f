// Percentiles of a bootstrap over few people, moved outward so that the interval keeps its promise.
#include "analysis/expanded_percentile.h"

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cassert>
#include <cmath>

namespace parafovea {

double student_widening(std::int64_t n) {
    assert(n >= 2);
    const double people = static_cast<double>(n);
    const double t = boost::math::quantile(boost::math::students_t_distribution<double>(people - 1.0), 0.025);
    return t * std::sqrt(people / (people - 1.0)) /
           boost::math::quantile(boost::math::normal_distribution<double>(), 0.025);
}

double expanded_percentile_tail(std::int64_t n) {
    const boost::math::normal_distribution<double> normal;
    return boost::math::cdf(normal, student_widening(n) * boost::math::quantile(normal, 0.025));
}

}  // namespace parafovea
