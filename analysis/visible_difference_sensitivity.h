// Contrast sensitivity over spatial frequency and luminance, at the fovea, for both temporal channels.
#pragma once

#include <cmath>
#include <vector>

#include "analysis/visible_difference.h"

namespace parafovea {

// Luminance of the background is kept as a code of 1/64 octave from 2^-4 to 2^12 cd/m2.
constexpr int kLuminanceCodes = 1024;
constexpr float kLuminanceCodesPerOctave = 64, kLog2OfFirstLuminance = -4;

inline double luminance_of_code(int code) {
    return std::exp2(kLog2OfFirstLuminance + code / double{kLuminanceCodesPerOctave});
}

// Sensitivity (1 / threshold contrast) at zero eccentricity, before the metric's overall gain.
double foveal_sensitivity(double frequency_cpd, double luminance_cd_m2 = 50,
                          TemporalChannel channel = TemporalChannel::sustained);

// log2 of the sensitivity, with the metric's gain: a row for each luminance code, in it steps of 1/8 octave
// from 2^-16 to 2^14 cpd, to be read by linear interpolation. Error of the sensitivity below 0.5 %.
struct SensitivityTable {
    static constexpr float kFirst = -16, kLast = 14, kStepsPerOctave = 8;
    static constexpr int kEntries = static_cast<int>((kLast - kFirst) * kStepsPerOctave) + 2;
    std::vector<float> values;
};

// Made at the first call.
const SensitivityTable& sensitivity_table(TemporalChannel channel);

}  // namespace parafovea
