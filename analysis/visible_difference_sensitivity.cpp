// The published sensitivities and how they are tabulated.
#include "analysis/visible_difference_sensitivity.h"

#include <algorithm>
#include <array>

#include "analysis/visible_difference_parameters.h"

namespace parafovea {
namespace {

constexpr double kStandardLuminance = 50;  // cd/m2

// Sensitivity against frequency at the standard luminance, octave by octave from 2^-2 cpd: to steady
// contrast, and to contrast that changes at 5 Hz. Read off the authors' program: its answers to small
// contrasts are inverted exactly by the published formulas.
constexpr double kFirstOctave = -2;
constexpr std::array<double, 8> kSustainedByOctave = {46, 93, 119, 97, 52, 19, 4.5, 0.8};
constexpr std::array<double, 8> kTransientByOctave = {700, 662, 422, 175, 55, 15, 3.4, 0.65};

// The monotone cubic of Fritsch and Butland (1984) through the octaves' log2 sensitivities.
struct SensitivityCurve {
    std::array<double, 8> value, slope;

    explicit SensitivityCurve(const std::array<double, 8>& by_octave) {
        for (std::size_t i = 0; i < value.size(); ++i) value[i] = std::log2(by_octave[i]);
        const auto step = [&](std::size_t i) { return value[i + 1] - value[i]; };
        slope.front() = step(0);
        slope.back() = step(value.size() - 2);
        for (std::size_t i = 1; i + 1 < value.size(); ++i) {
            const double before = step(i - 1), after = step(i);
            slope[i] = before * after > 0 ? 2 * before * after / (before + after) : 0;
        }
    }

    // Beyond the ends the curve goes on straight, in log against log.
    double log2_at(double log2_frequency) const {
        const double at = log2_frequency - kFirstOctave;
        const double last = static_cast<double>(value.size() - 1);
        if (at <= 0) return value.front() + slope.front() * at;
        if (at >= last) return value.back() + slope.back() * (at - last);
        const auto i = static_cast<std::size_t>(at);
        const double t = at - static_cast<double>(i);
        return (1 + 2 * t) * (1 - t) * (1 - t) * value[i] + t * (1 - t) * (1 - t) * slope[i] +
               t * t * (3 - 2 * t) * value[i + 1] + t * t * (t - 1) * slope[i + 1];
    }
};

// How sensitivity changes with luminance: the sustained achromatic channel of stelaCSF (Mantiuk, Ashraf and
// Chapiro, ACM TOG 41(4), 2022), a truncated log-parabola of peak height and peak frequency; taken for the
// transient one, too.
struct LuminanceFactor {
    double log10_height, log10_peak_cpd;

    explicit LuminanceFactor(double luminance_cd_m2)
        : log10_height(std::log10(44.4763 * std::pow(1 + 0.713964 / luminance_cd_m2, -0.277857) *
                                  // (1 + a / L)^-b in the limit of small a and large b
                                  -std::expm1(-7.54866e-07 * 8.50217e+09 / luminance_cd_m2))),
          log10_peak_cpd(std::log10(1.55909 * std::pow(1 + 103.604 / luminance_cd_m2, -0.251815))) {}

    double log10_at(double log10_frequency) const {
        const double beyond = std::max(log10_frequency - log10_peak_cpd, 0.0);
        return log10_height - beyond * beyond / std::exp2(0.177674);
    }
};

SensitivityTable make_table(TemporalChannel channel) {
    const SensitivityCurve curve(channel == TemporalChannel::sustained ? kSustainedByOctave
                                                                       : kTransientByOctave);
    std::vector<LuminanceFactor> factors;
    for (int code = 0; code < kLuminanceCodes; ++code) factors.emplace_back(luminance_of_code(code));
    const LuminanceFactor standard(kStandardLuminance);
    const double gain = kSensitivityGainDb / 20 * std::log2(10.0);

    SensitivityTable table;
    table.values.resize(static_cast<std::size_t>(kLuminanceCodes) * SensitivityTable::kEntries);
    for (int entry = 0; entry < SensitivityTable::kEntries; ++entry) {
        const double log2_frequency = SensitivityTable::kFirst + entry / SensitivityTable::kStepsPerOctave;
        const double log10_frequency = log2_frequency * std::log10(2.0);
        const double log2_standard = curve.log2_at(log2_frequency) + gain;
        for (int code = 0; code < kLuminanceCodes; ++code)
            table.values[static_cast<std::size_t>(code) * SensitivityTable::kEntries + entry] =
                static_cast<float>(log2_standard +
                                   std::log2(10.0) * (factors[code].log10_at(log10_frequency) -
                                                      standard.log10_at(log10_frequency)));
    }
    return table;
}

}  // namespace

double foveal_sensitivity(double frequency_cpd, double luminance_cd_m2, TemporalChannel channel) {
    const SensitivityCurve curve(channel == TemporalChannel::sustained ? kSustainedByOctave
                                                                       : kTransientByOctave);
    const double log10_frequency = std::log10(frequency_cpd);
    return std::exp2(curve.log2_at(std::log2(frequency_cpd))) *
           std::pow(10, LuminanceFactor(luminance_cd_m2).log10_at(log10_frequency) -
                            LuminanceFactor(kStandardLuminance).log10_at(log10_frequency));
}

const SensitivityTable& sensitivity_table(TemporalChannel channel) {
    static const SensitivityTable sustained = make_table(TemporalChannel::sustained);
    static const SensitivityTable transient = make_table(TemporalChannel::transient);
    return channel == TemporalChannel::sustained ? sustained : transient;
}

}  // namespace parafovea
