// How visible the difference between two pictures is to an eye that looks at a given point: a foveated
// multi-band predictor (FovVideoVDP's published formulas, still pictures).
//
// Source: Mantiuk, Denes, Chapiro, Kaplanyan, Rufo, Bachy, Lian and Patney, "FovVideoVDP: A visible
// difference predictor for wide field-of-view video", ACM TOG 40(4), 2021, with the parameters of its
// version 1.2; written from the formulas. Steps: display model, Laplacian pyramid contrast, contrast
// sensitivity that falls with eccentricity through cortical magnification, mutual masking, Minkowski pooling
// over pixels, sum over bands, JOD.
//
// Where this differs from the publication:
// - the foveal contrast sensitivity is the published one at 50 cd/m2, interpolated over spatial frequency; at
// other
//   luminances it is scaled as stelaCSF says (Mantiuk, Ashraf and Chapiro, ACM TOG 41(4), 2022). Against the
//   authors' program: within 0.1 JOD from 2 to 50 cd/m2; brighter, differences are judged more visible (0.3
//   JOD at 200 cd/m2).
// - pixels per degree away from the view's centre are the exact derivative 1 + tan^2, not a finite
// difference.
//
// As in the publication, two kinds of difference are not seen: of colour at equal luminance, and of luminance
// that is uniform over the picture (the low-pass rest under the last band is not judged; a picture of one
// pixel has no contrast at all).
//
// Everything is pure, single-threaded, and the same to the last bit on every IEEE machine.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace parafovea {

// An 8-bit sRGB picture, 4 bytes a pixel (alpha is ignored), rows from top to bottom without padding.
struct RgbaView {
    std::span<const std::uint8_t> bytes;
    int width = 0;
    int height = 0;
};

// The display that shows the pictures, filling it: a flat, square-pixelled picture in front of one eye.
struct DisplayModel {
    int width_px = 1280;
    int height_px = 1440;
    double horizontal_fov_deg = 90;
    double peak_cd_m2 = 100;
    double contrast_ratio = 1000;         // peak over black
    double ambient_reflection_cd_m2 = 0;  // ambient light reflected by the screen, added everywhere

    // Distance from the eye to the picture plane, in pixels.
    double distance_px() const;
    // Pixels per degree at the centre of the picture.
    double pixels_per_degree() const;

    bool operator==(const DisplayModel&) const = default;
};

// Where the eye looks, in pixels of the picture: (0, 0) is its top left corner, y points down; anywhere, on
// the picture or off it. A gaze that is not finite means "unknown": the whole picture is then judged as if it
// fell on the fovea, the strictest answer.
struct GazePx {
    double x = 0;
    double y = 0;
};

// The luminance of one picture in cd/m2 at full size, half, a quarter, ...
struct LuminancePyramid {
    struct Level {
        int width = 0;
        int height = 0;
        std::vector<float> luminance_cd_m2;
    };
    DisplayModel display;
    std::vector<Level> levels;
};

// Which luminance a contrast is relative to. With mean_of_both the judgement is symmetric in the two
// pictures, for an observer who is not told which is the reference.
enum class ContrastBackground { reference, mean_of_both };

// What is seen as steady and what as changing; still pictures have only the sustained channel.
enum class TemporalChannel { sustained, transient };

// The part of the judgement of one pair that does not depend on gaze.
struct ContrastBands {
    struct Band {
        int width = 0;
        int height = 0;
        double frequency_cpd = 0;  // centre frequency at the centre of the picture
        // Per pixel, raised to the powers in which they are pooled: the contrast difference, and the masker.
        std::vector<float> difference;
        std::vector<float> masker;
        std::vector<std::uint16_t> background_code;  // luminance in steps of 1/64 octave
    };
    DisplayModel display;
    TemporalChannel channel = TemporalChannel::sustained;
    bool identical = false;  // no band holds a difference of contrast: every gaze gives 0
    std::vector<Band> bands;
};

// Eccentricity zones: 0 to 5, 5 to 15, 15 to 30 and 30 degrees outwards.
constexpr int kEccentricityZones = 4;
constexpr std::array<double, kEccentricityZones> kEccentricityZoneStartsDeg = {0, 5, 15, 30};

struct VisibleDifference {
    struct Zone {
        double share = 0;  // of the picture's pixels
        double q = 0;      // as if the picture were this zone alone
        double jod = 10;
    };
    double q = 0;     // pooled visible difference, in the metric's own unit, >= 0
    double jod = 10;  // just-objectionable-difference scale: 10 is identical, 1 less is 75 % preference
    std::vector<double> band_q;
    std::array<Zone, kEccentricityZones> zones;
};

// Throws std::runtime_error when the picture is not as large as the display, is empty, or the display makes
// no sense (field of view outside (0, 180), peak or contrast not positive and finite).
LuminancePyramid luminance_pyramid(RgbaView picture, const DisplayModel& display);

// Both pyramids must be of the same display; else throws std::runtime_error.
ContrastBands contrast_bands(const LuminancePyramid& test, const LuminancePyramid& reference,
                             ContrastBackground background = ContrastBackground::reference);

// The two above in one.
ContrastBands decompose(RgbaView test, RgbaView reference, const DisplayModel& display,
                        ContrastBackground background = ContrastBackground::reference);

// Judges the pair at one gaze, for an eye whose contrast sensitivity is `sensitivity` (> 0) times the
// published average at every frequency and eccentricity.
VisibleDifference compare(const ContrastBands& bands, GazePx gaze, double sensitivity = 1);

// JOD of a pooled difference Q >= 0: 10 - a Q^b.
double jod_from_q(double q);

}  // namespace parafovea
