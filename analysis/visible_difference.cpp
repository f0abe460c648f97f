// Judges contrast bands at one gaze: sensitivity by eccentricity, masking, pooling.
#include "analysis/visible_difference.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "analysis/visible_difference_parameters.h"
#include "analysis/visible_difference_power.h"
#include "analysis/visible_difference_sensitivity.h"

namespace parafovea {
namespace {

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
              float log2_keenness, float masking_power, int width, float most, float* out) {
    for (int x = 0; x < width; ++x) {
        const float s = log2_sensitivity[x] + log2_keenness;
        const float masking = 1.0f + fast_exp2(masking_power * s) * masker[x];
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

double jod_from_q(double q) {
    return 10 - kJodGain * std::pow(q, kJodPower);
}

VisibleDifference compare(const ContrastBands& bands, GazePx gaze, double sensitivity) {
    assert(sensitivity > 0);
    const SensitivityTable& table = sensitivity_table(bands.channel);
    const float masking_power =
        bands.channel == TemporalChannel::sustained ? kSustainedMaskingPower : kTransientMaskingPower;
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
            mask_row(&band.difference[at], &band.masker[at], s.data(), log2_keenness, masking_power, width,
                     most, masked.data());
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
