// From pictures to contrast: luminance, Gaussian and Laplacian pyramids, and what of a pair's contrast does
// not depend on gaze.
#include "analysis/visible_difference_pyramid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "analysis/visible_difference_parameters.h"
#include "analysis/visible_difference_power.h"
#include "analysis/visible_difference_sensitivity.h"

namespace parafovea {
namespace {

using Level = LuminancePyramid::Level;

// The five-tap kernel .05 .25 .4 .25 .05 of Burt and Adelson (1983), a = 0.4.
constexpr float kOuter = 0.05f, kInner = 0.25f, kCentre = 0.4f;

double linear_from_srgb(int code) {
    const double v = code / 255.0;
    return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

const float* row_of(const Level& level, int y) {
    const int clamped = std::clamp(y, 0, level.height - 1);
    return level.luminance_cd_m2.data() + static_cast<std::size_t>(clamped) * level.width;
}

PARAFOVEA_VECTORISED
void reduce_rows(const float* a, const float* b, const float* c, const float* d, const float* e, int width,
                 float* out) {
    for (int x = 0; x < width; ++x) out[x] = kOuter * (a[x] + e[x]) + kInner * (b[x] + d[x]) + kCentre * c[x];
}

// Half the size (rounded up), smoothed; the picture's edge pixels are repeated outwards.
Level reduce(const Level& in) {
    Level out{(in.width + 1) / 2, (in.height + 1) / 2, {}};
    out.luminance_cd_m2.resize(static_cast<std::size_t>(out.width) * out.height);
    // Two pixels of margin on both sides save the inner loop its clamping.
    std::vector<float> smoothed(in.width + 4);
    float* const row = smoothed.data() + 2;
    for (int y = 0; y < out.height; ++y) {
        reduce_rows(row_of(in, 2 * y - 2), row_of(in, 2 * y - 1), row_of(in, 2 * y), row_of(in, 2 * y + 1),
                    row_of(in, 2 * y + 2), in.width, row);
        row[-2] = row[-1] = row[0];
        row[in.width] = row[in.width + 1] = row[in.width - 1];
        float* const to = out.luminance_cd_m2.data() + static_cast<std::size_t>(y) * out.width;
        for (int x = 0; x < out.width; ++x) {
            const float* const c = row + 2 * x;
            to[x] = kOuter * (c[-2] + c[2]) + kInner * (c[-1] + c[1]) + kCentre * c[0];
        }
    }
    return out;
}

PARAFOVEA_VECTORISED
void expand_even_rows(const float* a, const float* b, const float* c, int width, float* out) {
    for (int x = 0; x < width; ++x) out[x] = 2 * (kOuter * (a[x] + c[x]) + kCentre * b[x]);
}

PARAFOVEA_VECTORISED
void expand_odd_rows(const float* a, const float* b, int width, float* out) {
    for (int x = 0; x < width; ++x) out[x] = 2 * kInner * (a[x] + b[x]);
}

// Row y of the level, blown up to twice its size. `narrow` has the level's width and two pixels of margin
// before, two behind.
void expand_row(const Level& in, int y, int out_width, std::vector<float>& narrow, float* out) {
    float* const row = narrow.data() + 2;
    if (y % 2 == 0)
        expand_even_rows(row_of(in, y / 2 - 1), row_of(in, y / 2), row_of(in, y / 2 + 1), in.width, row);
    else
        expand_odd_rows(row_of(in, y / 2), row_of(in, y / 2 + 1), in.width, row);
    row[-1] = row[0];
    row[in.width] = row[in.width - 1];
    const int pairs = out_width / 2;
    for (int x = 0; x < pairs; ++x) {
        out[2 * x] = 2 * (kOuter * (row[x - 1] + row[x + 1]) + kCentre * row[x]);
        out[2 * x + 1] = 2 * kInner * (row[x] + row[x + 1]);
    }
    if (out_width % 2 == 1)
        out[2 * pairs] = 2 * (kOuter * (row[pairs - 1] + row[pairs + 1]) + kCentre * row[pairs]);
}

// One row of the two band-pass pictures to powers of contrast.
PARAFOVEA_VECTORISED
void contrast_row(const float* test, const float* reference, const float* test_low,
                  const float* reference_low, const float* background, float gain, float masking_power,
                  int width, float* __restrict difference, float* __restrict masker,
                  std::uint16_t* __restrict background_code) {
    for (int x = 0; x < width; ++x) {
        const float luminance = background[x] > kLeastBackground ? background[x] : kLeastBackground;
        const float code = 0.5f + kLuminanceCodesPerOctave * (fast_log2(luminance) - kLog2OfFirstLuminance);
        const float scale = gain / luminance;
        float t = (test[x] - test_low[x]) * scale, r = (reference[x] - reference_low[x]) * scale;
        t = t > kMostContrast ? kMostContrast : (t < -kMostContrast ? -kMostContrast : t);
        r = r > kMostContrast ? kMostContrast : (r < -kMostContrast ? -kMostContrast : r);
        background_code[x] = static_cast<std::uint16_t>(
            static_cast<int>(code < kLuminanceCodes - 1 ? code : kLuminanceCodes - 1));
        const float apart = std::fabs(t - r);
        const float at = std::fabs(t), ar = std::fabs(r);
        difference[x] = fast_power(apart, kDifferencePower * kPoolingPower);
        masker[x] = fast_power((at < ar ? at : ar) * kMaskingGain, masking_power);
    }
}

PARAFOVEA_VECTORISED
void mean_row(const float* a, const float* b, int width, float* mean) {
    for (int x = 0; x < width; ++x) mean[x] = 0.5f * (a[x] + b[x]);
}

}  // namespace

void check_picture(RgbaView picture, const DisplayModel& d) {
    if (!(d.horizontal_fov_deg > 0 && d.horizontal_fov_deg < 180) || !(d.peak_cd_m2 > 0) ||
        !std::isfinite(d.peak_cd_m2) || !(d.contrast_ratio > 1) || !(d.ambient_reflection_cd_m2 >= 0) ||
        !std::isfinite(d.ambient_reflection_cd_m2))
        throw std::runtime_error(
            "visible difference: the display needs a field of view in (0, 180) degrees, a positive peak "
            "luminance and a contrast ratio above 1");
    const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
    if (picture.width != d.width_px || picture.height != d.height_px)
        throw std::runtime_error("visible difference: the picture is " + size(picture.width, picture.height) +
                                 " but the display is " + size(d.width_px, d.height_px));
    if (picture.width < 1 || picture.height < 1 ||
        picture.bytes.size() < std::size_t{4} * picture.width * picture.height)
        throw std::runtime_error("visible difference: the picture is empty or shorter than its size says");
}

double DisplayModel::distance_px() const {
    return 0.5 * width_px / std::tan(horizontal_fov_deg * std::numbers::pi / 360);
}

double DisplayModel::pixels_per_degree() const {
    return distance_px() * std::tan(std::numbers::pi / 180);
}

Level luminance_plane(RgbaView picture, const DisplayModel& display) {
    check_picture(picture, display);

    // Tabulate each channel's share of luminance.
    const double black = display.peak_cd_m2 / display.contrast_ratio;
    std::array<float, 256> red, green, blue;
    for (int code = 0; code < 256; ++code) {
        const double lit = (display.peak_cd_m2 - black) * linear_from_srgb(code);
        red[code] = static_cast<float>(0.2126 * lit);
        green[code] = static_cast<float>(0.7152 * lit);
        blue[code] = static_cast<float>(0.0722 * lit);
    }
    const auto floor_cd_m2 = static_cast<float>(black + display.ambient_reflection_cd_m2);

    Level full{picture.width, picture.height, {}};
    full.luminance_cd_m2.resize(static_cast<std::size_t>(picture.width) * picture.height);
    const std::uint8_t* byte = picture.bytes.data();
    for (float& luminance : full.luminance_cd_m2) {
        luminance = floor_cd_m2 + (red[byte[0]] + green[byte[1]] + blue[byte[2]]);
        byte += 4;
    }
    return full;
}

LuminancePyramid pyramid_over(Level full, const DisplayModel& display) {
    LuminancePyramid pyramid{display, {}};
    pyramid.levels.push_back(std::move(full));
    const int bands = band_count(display);
    for (int b = 0; b < bands; ++b) pyramid.levels.push_back(reduce(pyramid.levels.back()));
    return pyramid;
}

LuminancePyramid luminance_pyramid(RgbaView picture, const DisplayModel& display) {
    return pyramid_over(luminance_plane(picture, display), display);
}

ContrastBands contrast_bands(const LuminancePyramid& test, const LuminancePyramid& reference,
                             ContrastBackground background) {
    return relative_contrast(test, reference, test, reference, background, TemporalChannel::sustained);
}

ContrastBands relative_contrast(const LuminancePyramid& test, const LuminancePyramid& reference,
                                const LuminancePyramid& steady_test, const LuminancePyramid& steady_reference,
                                ContrastBackground background, TemporalChannel channel) {
    for (const LuminancePyramid* p : {&test, &reference, &steady_test, &steady_reference})
        if (p->display != reference.display || p->levels.size() != reference.levels.size() ||
            p->levels.empty())
            throw std::runtime_error("visible difference: the two pictures are not of the same display");

    const bool still = &test == &steady_test && &reference == &steady_reference;
    const bool mean = background == ContrastBackground::mean_of_both;
    const float masking_power =
        channel == TemporalChannel::sustained ? kSustainedMaskingPower : kTransientMaskingPower;
    ContrastBands bands{reference.display, channel, true, {}};
    for (std::size_t b = 0; b + 1 < test.levels.size(); ++b) {
        const Level &t = test.levels[b], &r = reference.levels[b];
        const int width = t.width;
        const std::size_t pixels = t.luminance_cd_m2.size();
        ContrastBands::Band band{width,
                                 t.height,
                                 band_frequency_cpd(reference.display, static_cast<int>(b)),
                                 std::vector<float>(pixels),
                                 std::vector<float>(pixels),
                                 std::vector<std::uint16_t>(pixels)};
        // Band-pass: the picture less its own blurred self, relative to the blurred background.
        std::vector<float> narrow(test.levels[b + 1].width + 4), test_low(width), reference_low(width),
            steady_low(width), other_low(width);
        for (int y = 0; y < t.height; ++y) {
            expand_row(test.levels[b + 1], y, width, narrow, test_low.data());
            expand_row(reference.levels[b + 1], y, width, narrow, reference_low.data());
            const float* under = reference_low.data();
            if (!still) {
                expand_row(steady_reference.levels[b + 1], y, width, narrow, steady_low.data());
                under = steady_low.data();
            }
            if (mean) {
                const float* other = test_low.data();
                if (!still) {
                    expand_row(steady_test.levels[b + 1], y, width, narrow, other_low.data());
                    other = other_low.data();
                }
                mean_row(under, other, width, steady_low.data());
                under = steady_low.data();
            }
            const std::size_t at = static_cast<std::size_t>(y) * width;
            // The finest band's kernel passes its frequency whole, the others' only half.
            contrast_row(row_of(t, y), row_of(r, y), test_low.data(), reference_low.data(), under,
                         b == 0 ? 1.0f : 2.0f, masking_power, width, &band.difference[at], &band.masker[at],
                         &band.background_code[at]);
        }
        if (std::any_of(band.difference.begin(), band.difference.end(), [](float d) { return d > 0; }))
            bands.identical = false;
        bands.bands.push_back(std::move(band));
    }
    return bands;
}

ContrastBands decompose(RgbaView test, RgbaView reference, const DisplayModel& display,
                        ContrastBackground background) {
    return contrast_bands(luminance_pyramid(test, display), luminance_pyramid(reference, display),
                          background);
}

}  // namespace parafovea
