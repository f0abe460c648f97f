// Judges contrast bands at one gaze: sensitivity by eccentricity, masking, pooling.
#include "analysis/visible_difference.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "analysis/visible_difference_parameters.h"
#include "analysis/visible_difference_power.h"

namespace parafovea {
namespace {

// Sensitivity against frequency, octave by octave from 2^-2 cpd, at 50 cd/m2, sustained.
constexpr std::array<double, 8> kSensitivityByOctave = {46, 93, 119, 97, 52, 19, 4.5, 0.8};
constexpr double kFirstOctave = -2;

// Slopes of the monotone cubic of Fritsch and Butland (1984) through the octaves' log2 sensitivities.
struct SensitivityCurve {
    std::array<double, 8> value, slope;

    SensitivityCurve() {
        for (std::size_t i = 0; i < value.size(); ++i) value[i] = std::log2(kSensitivityByOctave[i]);
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

// How sensitivity changes with luminance, relative to 50 cd/m2: the sustained achromatic channel of stelaCSF
// (Mantiuk, Ashraf and Chapiro, ACM TOG 41(4), 2022), a truncated log-parabola of peak height and peak
// frequency.
struct LuminanceFactor {
    double log10_height, log10_peak_cpd;

    explicit LuminanceFactor(double luminance_cd_m2)
        : log10_height(std::log10(44.4763 * std::pow(1 + 0.713964 / luminance_cd_m2, -0.277857) *
                                  // (1 + a / L)^-b in the limit of small a and large b
                                  -std::expm1(-7.54866e-07 * 8.50217e+09 / luminance_cd_m2))),
          log10_peak_cpd(std::log10(1.55909 * std::pow(1 + 103.604 / luminance_cd_m2, -0.251815))) {}

    // log10 of the parabola; flat below its peak.
    double log10_at(double log10_frequency) const {
        const double beyond = std::max(log10_frequency - log10_peak_cpd, 0.0);
        return log10_height - beyond * beyond / std::exp2(0.177674);
    }
};

// log2 of the sensitivity, with the metric's gain: a row for each of the background's luminance codes, in it
// steps of 1/8 octave from 2^-16 to 2^14 cpd, read by linear interpolation. Error of the sensitivity below
// 0.5 %.
struct SensitivityTable {
    static constexpr float kFirst = -16, kLast = 14, kStepsPerOctave = 8;
    static constexpr int kEntries = static_cast<int>((kLast - kFirst) * kStepsPerOctave) + 2;
    std::vector<float> values;

    explicit SensitivityTable(const SensitivityCurve& curve)
        : values(static_cast<std::size_t>(kLuminanceCodes) * kEntries) {
        const double gain = kSensitivityGainDb / 20 * std::log2(10.0);
        const LuminanceFactor standard(kStandardLuminance);
        for (int entry = 0; entry < kEntries; ++entry) {
            const double log2_frequency = kFirst + entry / kStepsPerOctave;
            const double log10_frequency = log2_frequency * std::log10(2.0);
            const double log2_standard = curve.log2_at(log2_frequency) + gain;
            for (int code = 0; code < kLuminanceCodes; ++code)
                values[static_cast<std::size_t>(code) * kEntries + entry] = static_cast<float>(
                    log2_standard + std::log2(10.0) * (luminance_factor(code).log10_at(log10_frequency) -
                                                       standard.log10_at(log10_frequency)));
        }
    }

  private:
    static const LuminanceFactor& luminance_factor(int code) {
        static const std::vector<LuminanceFactor> factors = [] {
            std::vector<LuminanceFactor> all;
            for (int c = 0; c < kLuminanceCodes; ++c) all.emplace_back(luminance_of_code(c));
            return all;
        }();
        return factors[code];
    }
};

// Position in the table's rows, for every pixel of one row, and eccentricity.
PARAFOVEA_VECTORISED
void locate_row(const float* azimuth_deg, const float* tangent2, float gaze_azimuth_deg, float elevation_off2,
                float row_tangent2, float log2_frequency, float foveal, int width, float* eccentricity_deg,
                std::int32_t* entry, float* fraction) {
    constexpr float kPerDegree = 1.0f / static_cast<float>(kMagnificationE2Deg);
    constexpr float kPower = static_cast<float>(kMagnificationPower);
    constexpr float kTop = SensitivityTable::kEntries - 2;
    for (int x = 0; x < width; ++x) {
        const float dx = azimuth_deg[x] - gaze_azimuth_deg;
        const float e = std::sqrt(dx * dx + elevation_off2) * foveal;
        // Frequency grows with the picture's obliqueness and, in the cortex, with eccentricity.
        const float f = log2_frequency + fast_log2(1.0f + (tangent2[x] + row_tangent2)) +
                        kPower * fast_log2(1.0f + e * kPerDegree);
        float at = (f - SensitivityTable::kFirst) * SensitivityTable::kStepsPerOctave;
        at = at > 0 ? at : 0;
        at = at < kTop ? at : kTop;
        const auto whole = static_cast<std::int32_t>(at);
        eccentricity_deg[x] = e;
        entry[x] = whole;
        fraction[x] = at - static_cast<float>(whole);
    }
}

void read_row(const float* table, const std::uint16_t* luminance_code, const std::int32_t* entry,
              const float* fraction, int width, float* log2_sensitivity) {
    for (int x = 0; x < width; ++x) {
        const float* const at = table + luminance_code[x] * SensitivityTable::kEntries + entry[x];
        log2_sensitivity[x] = at[0] + fraction[x] * (at[1] - at[0]);
    }
}

// Masked differences of one row, to the pooling power.
PARAFOVEA_VECTORISED
void mask_row(const float* difference, const float* masker, const float* log2_sensitivity,
              float log2_keenness, int width, float most, float* out) {
    for (int x = 0; x < width; ++x) {
        const float s = log2_sensitivity[x] + log2_keenness;
        const float masking = 1.0f + fast_exp2(kMaskingPower * s) * masker[x];
        const float masked = difference[x] * fast_exp2(kDifferencePower * kPoolingPower * s -
                                                       kPoolingPower * fast_log2(masking));
        out[x] = masked < most ? masked : most;
    }
}

int zone_of(float eccentricity_deg) {
    int zone = 0;
    for (int z = 1; z < kEccentricityZones; ++z)
        zone += eccentricity_deg >= static_cast<float>(kEccentricityZoneStartsDeg[z]) ? 1 : 0;
    return zone;
}

const SensitivityCurve& sensitivity_curve() {
    static const SensitivityCurve curve;
    return curve;
}

}  // namespace

double band_frequency_cpd(const DisplayModel& display, int band) {
    const double nyquist = display.pixels_per_degree() / 2;
    return band == 0 ? nyquist : 0.3228 * nyquist * std::exp2(1 - band);
}

int band_count(const DisplayModel& display) {
    int count = 0;
    bool coarse_enough = false;
    for (int w = display.width_px, h = display.height_px; (w > 1 || h > 1) && !coarse_enough; ++count) {
        coarse_enough = band_frequency_cpd(display, count) < kLeastFrequencyCpd;
        w = (w + 1) / 2;
        h = (h + 1) / 2;
    }
    return count;
}

double foveal_sensitivity(double frequency_cpd, double luminance_cd_m2) {
    const double log10_frequency = std::log10(frequency_cpd);
    return std::exp2(sensitivity_curve().log2_at(std::log2(frequency_cpd))) *
           std::pow(10, LuminanceFactor(luminance_cd_m2).log10_at(log10_frequency) -
                            LuminanceFactor(kStandardLuminance).log10_at(log10_frequency));
}

double jod_from_q(double q) {
    return 10 - kJodGain * std::pow(q, kJodPower);
}

VisibleDifference compare(const ContrastBands& bands, GazePx gaze, double sensitivity) {
    assert(sensitivity > 0);
    static const SensitivityTable table(sensitivity_curve());
    const float most = std::pow(kMostDifference, kPoolingPower);
    const auto log2_keenness = static_cast<float>(std::log2(sensitivity));

    const DisplayModel& display = bands.display;
    const double distance = display.distance_px();
    const double centre_x = 0.5 * display.width_px, centre_y = 0.5 * display.height_px;
    const auto angle_deg = [&](double offset_px) {
        return std::atan(offset_px / distance) * 180 / std::numbers::pi;
    };
    const bool gaze_known = std::isfinite(gaze.x) && std::isfinite(gaze.y);
    const double gaze_azimuth = gaze_known ? angle_deg(gaze.x - centre_x) : 0;
    const double gaze_elevation = gaze_known ? angle_deg(gaze.y - centre_y) : 0;

    VisibleDifference result;
    std::array<double, kEccentricityZones> zone_q{};
    double pixels_of_finest = 0;
    for (std::size_t b = 0; b < bands.bands.size(); ++b) {
        const ContrastBands::Band& band = bands.bands[b];
        const int width = band.width;
        const double spacing = std::exp2(static_cast<double>(b));

        // Tabulate the columns: pixel i of a band lies on pixel i 2^b of the picture.
        std::vector<float> azimuth(width), tangent2(width), eccentricity(width), fraction(width), s(width),
            masked(width);
        std::vector<std::int32_t> entry(width);
        for (int x = 0; x < width; ++x) {
            const double offset = x * spacing + 0.5 - centre_x;
            azimuth[x] = static_cast<float>(angle_deg(offset));
            tangent2[x] = static_cast<float>(offset / distance * (offset / distance));
        }

        // Sum the masked differences row by row, by zone.
        std::array<double, kEccentricityZones> sum{}, count{};
        for (int y = 0; y < band.height; ++y) {
            const double offset = y * spacing + 0.5 - centre_y;
            const double elevation_off = angle_deg(offset) - gaze_elevation;
            locate_row(azimuth.data(), tangent2.data(), static_cast<float>(gaze_azimuth),
                       static_cast<float>(elevation_off * elevation_off),
                       static_cast<float>(offset / distance * (offset / distance)),
                       static_cast<float>(std::log2(band.frequency_cpd)), gaze_known ? 1.0f : 0.0f, width,
                       eccentricity.data(), entry.data(), fraction.data());
            const std::size_t at = static_cast<std::size_t>(y) * width;
            read_row(table.values.data(), &band.background_code[at], entry.data(), fraction.data(), width,
                     s.data());
            mask_row(&band.difference[at], &band.masker[at], s.data(), log2_keenness, width, most,
                     masked.data());
            for (int x = 0; x < width; ++x) {
                const int zone = zone_of(eccentricity[x]);
                sum[zone] += masked[x];
                count[zone] += 1;
            }
        }

        // Pool.
        double total = 0, pixels = 0;
        for (int z = 0; z < kEccentricityZones; ++z) {
            if (count[z] > 0) zone_q[z] += std::pow(sum[z] / count[z], 1 / double{kPoolingPower});
            total += sum[z];
            pixels += count[z];
        }
        result.band_q.push_back(std::pow(total / pixels, 1 / double{kPoolingPower}));
        result.q += result.band_q.back();
        if (b == 0) {
            pixels_of_finest = pixels;
            for (int z = 0; z < kEccentricityZones; ++z) result.zones[z].share = count[z] / pixels_of_finest;
        }
    }
    for (int z = 0; z < kEccentricityZones; ++z) {
        result.zones[z].q = zone_q[z];
        result.zones[z].jod = jod_from_q(zone_q[z]);
    }
    result.jod = jod_from_q(result.q);
    return result;
}

}  // namespace parafovea
