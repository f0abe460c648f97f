// The published parameters of the visible-difference predictor, and the frequencies of its bands.
#pragma once

#include "analysis/visible_difference.h"

// Compiles a function for AVX2 as well and picks at load time. Only for functions without reductions over
// floats: their results are then the same to the last bit.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__SANITIZE_ADDRESS__)
#define PARAFOVEA_VECTORISED __attribute__((target_clones("avx2", "default")))
#else
#define PARAFOVEA_VECTORISED
#endif

namespace parafovea {

// FovVideoVDP 1.2.
constexpr float kDifferencePower = 2.4f;            // of the contrast difference
constexpr float kSustainedMaskingPower = 2.43685f;  // of the masker
constexpr float kTransientMaskingPower = 4.946f;
constexpr float kMaskingGain = 0.106209f;         // 10^-0.973838
constexpr float kPoolingPower = 1.52134f;         // over the pixels of a band
constexpr double kSensitivityGainDb = 16.2596;    // of the contrast sensitivity function, 20 dB a decade
constexpr double kMagnificationE2Deg = 3.67;      // eccentricity where cortical magnification halves ...
constexpr double kMagnificationPower = 0.604562;  // ... to this power
constexpr double kJodGain = 0.0161713;            // JOD = 10 - gain Q^power
constexpr double kJodPower = 0.59156163;          // 10^-0.2280
constexpr float kMostContrast = 1000.0f;
constexpr float kMostDifference = 1e4f;
constexpr float kLeastBackground = 0.1f;    // cd/m2
constexpr double kLeastFrequencyCpd = 0.5;  // the last band is the first below this

// Centre frequency of a band at the centre of the picture, in cycles per degree.
double band_frequency_cpd(const DisplayModel& display, int band);

// How many bands there are for this display: down to the first below kLeastFrequencyCpd, as far as the size
// allows. A picture of one pixel has none.
int band_count(const DisplayModel& display);

}  // namespace parafovea
