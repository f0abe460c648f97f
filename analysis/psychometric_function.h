// A psychometric function: P("different") against the strength of the foveation, its likelihood and its
// priors.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "analysis/proportion.h"

namespace parafovea {

enum class Sigmoid {
    logistic,
    normal,  // cumulative normal
    weibull  // on ln x; x must be above 0
};

// psi(x) = gamma + (1 - lambda - gamma) S(x). S is 1/2 at the threshold and rises from 0.05 to 0.95 over the
// width, both in units of x; for the Weibull in units of ln x. eta in [0, 1): 0 is binomial, more is
// beta-binomial overdispersion. After Schuett, Harmeling, Macke and Wichmann 2016 (psignifit 4).
struct PsychometricParameters {
    double threshold = 0.0;
    double width = 1.0;
    double lambda = 0.0;
    double gamma = 0.0;
    double eta = 0.0;
};

struct PsychometricLevel {
    double x = 0.0;
    std::int64_t n = 0;
    std::int64_t different = 0;
};

enum class Asymptotes {
    free,   // lapse rate lambda and guess rate gamma each fitted ("yes/no")
    equal,  // gamma = lambda
    fixed   // gamma given, such as 1/2 for two alternatives
};

enum class Dispersion {
    fitted,   // eta fitted: answers may vary more than independent ones do, as when people are pooled
    binomial  // eta held at 0: answers are independent given the function
};

struct PsychometricModel {
    Sigmoid sigmoid = Sigmoid::logistic;
    Asymptotes asymptotes = Asymptotes::free;
    double fixed_gamma = 0.0;            // for Asymptotes::fixed
    std::optional<double> fixed_lambda;  // fitted when absent
    std::optional<Interval>
        x_range;  // that the priors rest on; of the data when absent. Give it for adaptive data.
    std::optional<double> x_spacing;  // smallest step of x; of the data when absent
    Dispersion dispersion = Dispersion::fitted;
};

// S at x.
double sigmoid_value(Sigmoid sigmoid, double x, double threshold, double width);
double psychometric_value(const PsychometricModel& model, const PsychometricParameters& parameters, double x);

// x where psi(x) is the wanted share of "different"; absent when it lies outside (gamma, 1 - lambda).
std::optional<double> psychometric_inverse(const PsychometricModel& model,
                                           const PsychometricParameters& parameters, double share);

// The posterior of the parameters given data, up to a constant. Priors as psignifit's: threshold flat over
// the range of x with a cosine fall to half a range beyond; width flat from twice the smallest step to the
// range, falling to one step and to three ranges; lambda, gamma and eta Beta(1, 10).
class PsychometricPosterior {
  public:
    // Levels of one x are joined; empty levels are dropped. At least one trial; x above 0 for the Weibull.
    PsychometricPosterior(std::span<const PsychometricLevel> levels, const PsychometricModel& model);

    // Without the binomial coefficients.
    double log_likelihood(const PsychometricParameters& parameters) const;
    double log_posterior(const PsychometricParameters& parameters) const;  // -infinity outside the support
    // The same, and its slope along each parameter (of the threshold: along its place, ln x for the Weibull).
    double log_posterior(const PsychometricParameters& parameters, PsychometricParameters& slope) const;

    const PsychometricModel& model() const { return model_; }
    const std::vector<PsychometricLevel>& levels() const { return levels_; }
    Interval range() const { return range_; }  // of x (of ln x for the Weibull), widened where all x are one
    double spacing() const { return spacing_; }

  private:
    double log_likelihood(const PsychometricParameters& parameters, PsychometricParameters* slope) const;
    double log_prior(const PsychometricParameters& parameters, PsychometricParameters* slope) const;

    PsychometricModel model_;
    std::vector<PsychometricLevel> levels_;  // in rising order of x
    std::vector<double> places_;             // x, or ln x for the Weibull
    Interval range_;
    double spacing_ = 1.0;
};

}  // namespace parafovea
