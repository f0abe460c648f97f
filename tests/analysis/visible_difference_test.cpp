// The visible difference: against the published metric's own answers, an independent oracle, and how it must
// behave.
#include "analysis/visible_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "analysis/visible_difference_power.h"
#include "analysis/visible_difference_sensitivity.h"
#include "tests/analysis/visible_difference_oracle.h"
#include "tests/analysis/visible_difference_pictures.h"

namespace parafovea {
namespace {

DisplayModel display(int width, int height, double horizontal_fov_deg) {
    return {width, height, horizontal_fov_deg, 100, 1000, 0};
}

double jod(const GreyPicture& test, const GreyPicture& reference, const DisplayModel& d, GazePx gaze) {
    return compare(decompose(rgba_from(test), rgba_from(reference), d), gaze).jod;
}

// The pattern at a spot, the reference elsewhere.
GreyPicture spliced(const GreyPicture& pattern, GreyPicture reference, int from_x, int to_x) {
    for (int y = 0; y < reference.height; ++y)
        for (int x = from_x; x < to_x; ++x)
            reference.code[static_cast<std::size_t>(y) * reference.width + x] = pattern.at(x, y);
    return reference;
}

// Answers of the authors' FovVideoVDP 1.2.3 (foveated, sRGB, contrast 1000; 100 cd/m2 where not stated) to
// the same pictures of 200x160 pixels, half as bright as the display's peak.
TEST(VisibleDifference, AgreesWithTheAuthorsProgramToATenthOfAJod) {
    const GreyPicture flat = flat_picture(200, 160, 188), texture = textured_picture(200, 160);
    const GreyPicture fine = with_noise(flat, 1, 8, 3), coarse = with_noise(flat, 8, 6, 4);
    const GreyPicture blurred = box_blurred(texture), noisy = with_noise(texture, 2, 6, 5);
    struct Row {
        const char* what;
        const GreyPicture &test, &reference;
        double fov_deg;
        GazePx gaze;
        double jod;
        double peak_cd_m2 = 100;
    };
    const GazePx centre{100, 80}, corner{0, 0}, outside{400, 80};
    const Row rows[] = {
        {"fine noise", fine, flat, 10, centre, 9.310},
        {"fine noise", fine, flat, 10, corner, 9.456},
        {"fine noise", fine, flat, 10, outside, 9.697},
        {"coarse noise", coarse, flat, 10, centre, 7.167},
        {"coarse noise", coarse, flat, 10, corner, 7.481},
        {"coarse noise", coarse, flat, 10, outside, 8.033},
        {"blur", blurred, texture, 10, centre, 9.575},
        {"blur", blurred, texture, 10, corner, 9.701},
        {"blur", blurred, texture, 10, outside, 9.864},
        {"on texture", noisy, texture, 10, centre, 9.486},
        {"on texture", noisy, texture, 10, outside, 9.721},
        {"fine noise", fine, flat, 40, centre, 8.295},
        {"fine noise", fine, flat, 40, corner, 8.721},
        {"fine noise", fine, flat, 40, outside, 9.201},
        {"coarse noise", coarse, flat, 40, centre, 7.168},
        {"coarse noise", coarse, flat, 40, corner, 7.483},
        {"coarse noise", coarse, flat, 40, outside, 7.867},
        {"blur", blurred, texture, 40, centre, 8.136},
        {"blur", blurred, texture, 40, corner, 8.706},
        {"blur", blurred, texture, 40, outside, 9.410},
        {"fine noise", fine, flat, 40, centre, 8.591, 20},
        {"coarse noise", coarse, flat, 40, centre, 7.313, 20},
        {"blur", blurred, texture, 40, centre, 8.585, 20},
        {"on texture", noisy, texture, 40, outside, 9.572, 20},
        {"fine noise", fine, flat, 40, centre, 9.157, 4},
        {"coarse noise", coarse, flat, 40, outside, 8.880, 4},
        {"blur", blurred, texture, 40, centre, 9.184, 4},
        {"on texture", noisy, texture, 40, centre, 9.434, 4},
        {"on texture", noisy, texture, 40, centre, 9.057},
        {"on texture", noisy, texture, 40, outside, 9.437},
    };
    for (const Row& row : rows)
        EXPECT_NEAR(jod(row.test, row.reference, DisplayModel{200, 160, row.fov_deg, row.peak_cd_m2, 1000, 0},
                        row.gaze),
                    row.jod, 0.1)
            << row.peak_cd_m2 << " cd/m2, " << row.what << ", " << row.fov_deg << " deg, gaze " << row.gaze.x;
}

TEST(VisibleDifference, EqualsTheEquationsInDoublePixelByPixel) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [w, h] : {std::pair{37, 23}, {64, 64}, {1, 40}, {2, 1}, {5, 3}})
        for (const double fov : {3.0, 30.0, 110.0})
            for (const GazePx gaze : {GazePx{w * 0.5, h * 0.5}, {0.5, 0.5}, {-500, 2000}, {nan, 0}}) {
                const GreyPicture reference = textured_picture(w, h);
                // The tables of the fast form are good to 1 % of Q, 0.006 of the JODs below 10.
                const RgbaPicture r = rgba_from(reference), t = rgba_from(with_noise(reference, 2, 30, 9));
                const DisplayModel d = display(w, h, fov);
                const double expected = oracle::pooled_q(t, r, d, gaze);
                EXPECT_NEAR(compare(decompose(t, r, d), gaze).q, expected, 1e-2 * expected)
                    << w << "x" << h << ", " << fov << " deg, gaze " << gaze.x;
            }
}

TEST(VisibleDifference, AKeenerEyeSeesWhatTheEquationsSayItSees) {
    const GreyPicture reference = textured_picture(64, 48);
    const RgbaPicture r = rgba_from(reference), t = rgba_from(with_noise(reference, 2, 12, 9));
    const ContrastBands bands = decompose(t, r, display(64, 48, 20));
    double before = 0;
    for (const double sensitivity : {0.25, 0.7, 1.0, 1.4, 3.0}) {
        const double expected = oracle::pooled_q(t, r, display(64, 48, 20), {20, 30}, sensitivity);
        const double q = compare(bands, {20, 30}, sensitivity).q;
        EXPECT_NEAR(q, expected, 1e-2 * expected) << sensitivity;
        EXPECT_GT(q, before);
        before = q;
    }
}

TEST(VisibleDifference, ColourChannelsWeighAsTheirLuminance) {
    RgbaPicture reference{16, 16, std::vector<std::uint8_t>(16 * 16 * 4, 90)}, test = reference;
    const int channel_of[3] = {0, 1, 2};
    for (const int c : channel_of) {
        RgbaPicture changed = test;
        for (std::size_t i = 0; i < 256; i += 3) changed.bytes[4 * i + c] = 160;
        const DisplayModel d{16, 16, 5, 200, 300, 2};
        const double expected = oracle::pooled_q(changed, reference, d, {8, 8});
        EXPECT_NEAR(compare(decompose(changed, reference, d), {8, 8}).q, expected, 1e-2 * expected) << c;
    }
    for (std::size_t i = 0; i < 256; ++i) test.bytes[4 * i + 3] = 7;
    EXPECT_EQ(compare(decompose(test, reference, display(16, 16, 5)), {8, 8}).q, 0) << "alpha is ignored";
}

TEST(VisibleDifference, EqualPicturesScoreExactlyTen) {
    for (const GreyPicture& p :
         {textured_picture(61, 47), flat_picture(61, 47, 0), flat_picture(61, 47, 255)}) {
        const ContrastBands bands = decompose(rgba_from(p), rgba_from(p), display(61, 47, 80));
        EXPECT_TRUE(bands.identical);
        const VisibleDifference v = compare(bands, {3, 4});
        EXPECT_EQ(v.q, 0);
        EXPECT_EQ(v.jod, 10);
        for (const auto& zone : v.zones) EXPECT_EQ(zone.jod, 10);
    }
}

TEST(VisibleDifference, GrowsWithBlur) {
    const GreyPicture sharp = textured_picture(120, 100);
    double before = 10;
    for (int times = 1; times <= 8; ++times) {
        const double now = jod(box_blurred(sharp, times), sharp, display(120, 100, 20), {60, 50});
        EXPECT_LT(now, before) << times;
        before = now;
    }
}

TEST(VisibleDifference, GrowsWithNoise) {
    const GreyPicture clean = textured_picture(120, 100);
    for (const int block : {1, 4}) {
        double before = 10;
        for (int amplitude = 1; amplitude <= 32; amplitude *= 2) {
            const double now =
                jod(with_noise(clean, block, amplitude, 5), clean, display(120, 100, 20), {60, 50});
            EXPECT_LT(now, before) << block << " " << amplitude;
            before = now;
        }
    }
}

TEST(VisibleDifference, ALocalBlurFadesWithItsDistanceFromTheGaze) {
    const GreyPicture sharp = textured_picture(400, 100), blurred = box_blurred(sharp, 3);
    const ContrastBands bands =
        decompose(rgba_from(spliced(blurred, sharp, 20, 60)), rgba_from(sharp), display(400, 100, 80));
    double before = 0;
    for (int gaze_x = 40; gaze_x <= 400; gaze_x += 20) {
        const double now = compare(bands, {static_cast<double>(gaze_x), 50}).jod;
        EXPECT_GT(now, before) << gaze_x;
        before = now;
    }
}

TEST(VisibleDifference, TextureHidesNoise) {
    const GreyPicture flat = flat_picture(120, 100, 188), texture = textured_picture(120, 100);
    EXPECT_GT(jod(with_noise(texture, 1, 6, 3), texture, display(120, 100, 20), {60, 50}),
              jod(with_noise(flat, 1, 6, 3), flat, display(120, 100, 20), {60, 50}));
}

TEST(VisibleDifference, AnUnknownGazeIsTheStrictestJudge) {
    const GreyPicture clean = textured_picture(120, 100);
    const ContrastBands bands =
        decompose(rgba_from(with_noise(clean, 1, 9, 3)), rgba_from(clean), display(120, 100, 60));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double unknown = compare(bands, {nan, 50}).jod;
    for (const GazePx gaze : {GazePx{60, 50}, {0, 0}, {120, 100}, {1e6, -1e6}})
        EXPECT_LT(unknown, compare(bands, gaze).jod);
    EXPECT_EQ(compare(bands, {50, std::numeric_limits<double>::infinity()}).jod, unknown);
}

TEST(VisibleDifference, IsSymmetricWhenContrastIsRelativeToTheMeanOfBoth) {
    const RgbaPicture a = rgba_from(textured_picture(75, 51));
    const RgbaPicture b = rgba_from(box_blurred(textured_picture(75, 51), 2));
    const DisplayModel d = display(75, 51, 30);
    const auto q = [&](const RgbaPicture& t, const RgbaPicture& r) {
        return compare(decompose(t, r, d, ContrastBackground::mean_of_both), {30, 20}).q;
    };
    EXPECT_NEAR(q(a, b), q(b, a), 1e-4 * q(a, b));
    EXPECT_NEAR(q(a, b), compare(decompose(a, b, d), {30, 20}).q, 0.1 * q(a, b));
}

TEST(VisibleDifference, ZonesCoverThePictureAndHoldTheDifferenceWhereItIs) {
    const GreyPicture sharp = textured_picture(400, 100), blurred = box_blurred(sharp, 3);
    const ContrastBands bands =
        decompose(rgba_from(spliced(blurred, sharp, 0, 40)), rgba_from(sharp), display(400, 100, 80));
    const VisibleDifference v = compare(bands, {360, 50});
    double share = 0;
    for (const auto& zone : v.zones) share += zone.share;
    EXPECT_NEAR(share, 1, 1e-12);
    EXPECT_EQ(v.zones[0].jod, 10);  // the first 5 degrees around the gaze are untouched
    EXPECT_LT(v.zones[3].jod, v.jod);
    double bands_sum = 0;
    for (const double q : v.band_q) bands_sum += q;
    EXPECT_DOUBLE_EQ(bands_sum, v.q);
}

TEST(VisibleDifference, ExtremesGiveFiniteAnswers) {
    for (const auto& [w, h] : {std::pair{1, 1}, {2, 2}, {1, 9}, {33, 17}})
        for (const double fov : {0.01, 90.0, 179.9})
            for (const double peak : {1e-3, 1e5}) {
                const RgbaPicture black = rgba_from(flat_picture(w, h, 0));
                RgbaPicture checks = rgba_from(flat_picture(w, h, 255));
                for (std::size_t i = 0; i < checks.bytes.size(); i += 8)
                    checks.bytes[i] = checks.bytes[i + 1] = 0;
                const DisplayModel d{w, h, fov, peak, 1e6, 0};
                for (const GazePx gaze : {GazePx{0, 0}, {1e6, 1e6}, {-1e300, 1e300}}) {
                    const VisibleDifference v = compare(decompose(checks, black, d), gaze);
                    EXPECT_TRUE(std::isfinite(v.q) && v.q >= 0) << w << "x" << h << " " << fov << " " << peak;
                    EXPECT_LE(v.jod, 10);
                }
            }
    const RgbaPicture dark = rgba_from(flat_picture(1, 1, 0)), light = rgba_from(flat_picture(1, 1, 255));
    EXPECT_EQ(compare(decompose(light, dark, display(1, 1, 90)), {0, 0}).jod, 10)
        << "one pixel has no contrast";
}

TEST(VisibleDifference, UnreasonableInputIsRefused) {
    const RgbaPicture p = rgba_from(flat_picture(8, 8, 100));
    EXPECT_THROW(decompose(p, p, display(9, 8, 60)), std::runtime_error);
    EXPECT_THROW(decompose(p, p, display(8, 8, 180)), std::runtime_error);
    EXPECT_THROW(decompose(p, p, DisplayModel{8, 8, 60, 0, 1000, 0}), std::runtime_error);
    EXPECT_THROW(decompose(p, p, DisplayModel{8, 8, 60, 100, std::nan(""), 0}), std::runtime_error);
    EXPECT_THROW(luminance_pyramid({{p.bytes.data(), 8}, 8, 8}, display(8, 8, 60)), std::runtime_error);
    EXPECT_THROW(
        contrast_bands(luminance_pyramid(p, display(8, 8, 60)), luminance_pyramid(p, display(8, 8, 50))),
        std::runtime_error);
}

TEST(VisibleDifference, TheJodScaleIsThePublishedPower) {
    EXPECT_EQ(jod_from_q(0), 10);
    const double b = std::pow(10, -0.2280);
    for (const double q : {1.0, 100.0, 5000.0})
        EXPECT_NEAR(jod_from_q(q), 10 - std::pow(std::pow(0.0161713, 1 / b) * q, b), 1e-6);
}

TEST(VisibleDifference, SensitivityPassesThroughThePublishedValues) {
    const double published[] = {46, 93, 119, 97, 52, 19, 4.5, 0.8};
    for (int i = 0; i < 8; ++i) EXPECT_NEAR(foveal_sensitivity(std::ldexp(0.25, i)), published[i], 1e-9);
    for (double f = 1; f < 300; f *= 1.1) EXPECT_LT(foveal_sensitivity(f * 1.1), foveal_sensitivity(f));
}

TEST(VisibleDifference, SensitivityRisesWithLuminanceMostForFineDetail) {
    for (const double f : {0.5, 2.0, 8.0, 32.0})
        for (double l = 0.1; l < 100; l *= 2)
            EXPECT_GE(foveal_sensitivity(f, 2 * l), foveal_sensitivity(f, l));
    EXPECT_LT(foveal_sensitivity(16, 1) / foveal_sensitivity(16, 50),
              foveal_sensitivity(1, 1) / foveal_sensitivity(1, 50));
    // Between the laws of de Vries and Rose (square root) and Weber (none).
    EXPECT_GT(foveal_sensitivity(1, 1) / foveal_sensitivity(1, 50), std::sqrt(1.0 / 50));
}

TEST(FastPower, KeepsItsStatedErrorBounds) {
    for (double x = 1e-9; x < 1e9; x *= 1.0173) {
        const auto f = static_cast<float>(x);
        EXPECT_NEAR(fast_log2(f), std::log2(double{f}), 2e-7 + 6e-8 * std::fabs(std::log2(x)));
        for (const float p : {1.52134f, 2.43685f, 3.651216f}) {
            const double exact = std::pow(double{f}, double{p});
            if (exact < 1e-30 || exact > 1e30 || f <= 1e-9f) continue;
            EXPECT_NEAR(fast_power(f, p), exact, 1e-5 * exact) << x << " to the " << p;
        }
    }
    for (double x = -126; x < 127; x += 0.0137) {
        const double exact = std::exp2(static_cast<double>(static_cast<float>(x)));
        EXPECT_NEAR(fast_exp2(static_cast<float>(x)), exact, 5e-7 * exact) << x;
    }
    EXPECT_EQ(fast_power(0, 2.4f), 0);
    EXPECT_EQ(fast_exp2(-1000), fast_exp2(-126));
}

}  // namespace
}  // namespace parafovea
