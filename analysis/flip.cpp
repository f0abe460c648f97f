// Colour through the contrast sensitivity functions, edges and points, and how they combine.
#include "analysis/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace parafovea {
namespace {

// Parameters of the publication.
constexpr double kColourPower = 0.7, kColourKnee = 0.4, kColourAtKnee = 0.95;
constexpr double kFeatureWidthDeg = 0.082, kFeaturePower = 0.5;

struct Colour {
    double a, b, c;
};

// Linear sRGB to CIE XYZ, and the white that it makes.
constexpr double kXyzFromRgb[3][3] = {{0.412386563, 0.357591490, 0.180450492},
                                      {0.212636821, 0.715182981, 0.072180197},
                                      {0.019330620, 0.119197164, 0.950372587}};
constexpr double kRgbFromXyz[3][3] = {{3.241003275, -1.537398934, -0.498615861},
                                      {-0.969224334, 1.875930071, 0.041554224},
                                      {0.055639423, -0.204011202, 1.057148933}};
constexpr Colour kWhite = {0.950428545, 1.0, 1.088900371};

Colour multiply(const double (&m)[3][3], Colour v) {
    return {m[0][0] * v.a + m[0][1] * v.b + m[0][2] * v.c, m[1][0] * v.a + m[1][1] * v.b + m[1][2] * v.c,
            m[2][0] * v.a + m[2][1] * v.b + m[2][2] * v.c};
}

// Achromatic, red-green, blue-yellow: linear in light, as filters need it.
Colour opponent_from_rgb(Colour rgb) {
    const Colour xyz = multiply(kXyzFromRgb, rgb);
    const double x = xyz.a / kWhite.a, y = xyz.b / kWhite.b, z = xyz.c / kWhite.c;
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Colour rgb_from_opponent(Colour o) {
    const double y = (o.a + 16) / 116, x = y + o.b / 500, z = y - o.c / 200;
    return multiply(kRgbFromXyz, {x * kWhite.a, y * kWhite.b, z * kWhite.c});
}

// CIE L*a*b* with colourfulness that grows with lightness (Hunt effect).
Colour hunt_lab_from_rgb(Colour rgb) {
    const auto f = [](double t) {
        constexpr double d = 6.0 / 29;
        return t > d * d * d ? std::cbrt(t) : t / (3 * d * d) + 4.0 / 29;
    };
    const Colour xyz = multiply(kXyzFromRgb, rgb);
    const double x = f(xyz.a / kWhite.a), y = f(xyz.b / kWhite.b), z = f(xyz.c / kWhite.c);
    const double lightness = 116 * y - 16;
    return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

double colour_distance(Colour p, Colour q) {
    return std::pow(std::fabs(p.a - q.a) + std::hypot(p.b - q.b, p.c - q.c), kColourPower);
}

struct Plane {
    int width = 0, height = 0;
    std::vector<float> values;
};

// Weights at -radius to radius.
using Kernel = std::vector<double>;

// A row's filter after a column's; the picture's edge pixels are repeated outwards.
Plane convolved(const Plane& in, const Kernel& along_x, const Kernel& along_y) {
    const auto pass = [](const Plane& from, const Kernel& kernel, bool horizontal) {
        const int radius = static_cast<int>(kernel.size() / 2);
        Plane to{from.width, from.height, std::vector<float>(from.values.size())};
        for (int y = 0; y < from.height; ++y)
            for (int x = 0; x < from.width; ++x) {
                double sum = 0;
                for (int k = -radius; k <= radius; ++k) {
                    const int sx = horizontal ? std::clamp(x + k, 0, from.width - 1) : x;
                    const int sy = horizontal ? y : std::clamp(y + k, 0, from.height - 1);
                    sum += kernel[static_cast<std::size_t>(k + radius)] *
                           from.values[static_cast<std::size_t>(sy) * from.width + sx];
                }
                to.values[static_cast<std::size_t>(y) * from.width + x] = static_cast<float>(sum);
            }
        return to;
    };
    return pass(pass(in, along_x, true), along_y, false);
}

double sum_of(const Kernel& kernel) {
    return std::accumulate(kernel.begin(), kernel.end(), 0.0);
}

Kernel scaled(Kernel kernel, double factor) {
    for (double& weight : kernel) weight *= factor;
    return kernel;
}

// One term of a contrast sensitivity function in space: a sqrt(pi / b) exp(-pi^2 x^2 / b), x in degrees.
struct SensitivityTerm {
    double a, b;
};
constexpr SensitivityTerm kAchromatic[] = {{1, 0.0047}};
constexpr SensitivityTerm kRedGreen[] = {{1, 0.0053}};
constexpr SensitivityTerm kBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};

template <std::size_t N>
Plane sensitivity_filtered(const Plane& in, const SensitivityTerm (&terms)[N], double pixels_per_degree) {
    constexpr double kPi = std::numbers::pi;
    // Wide enough for the widest term of the three channels.
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * pixels_per_degree));
    std::array<Kernel, N> kernel;
    double total = 0;
    for (std::size_t n = 0; n < N; ++n) {
        for (int k = -radius; k <= radius; ++k) {
            const double x = k / pixels_per_degree;
            kernel[n].push_back(std::exp(-kPi * kPi * x * x / terms[n].b));
        }
        total += terms[n].a * std::sqrt(kPi / terms[n].b) * sum_of(kernel[n]) * sum_of(kernel[n]);
    }
    Plane sum{in.width, in.height, std::vector<float>(in.values.size(), 0.0f)};
    for (std::size_t n = 0; n < N; ++n) {
        const double weight = terms[n].a * std::sqrt(kPi / terms[n].b) / total;
        const Plane part = convolved(in, scaled(kernel[n], weight), kernel[n]);
        for (std::size_t i = 0; i < sum.values.size(); ++i) sum.values[i] += part.values[i];
    }
    return sum;
}

// Gaussian of a feature's width with its first and second derivatives; the positive weights of each sum to 1,
// the negative ones to -1.
struct FeatureKernels {
    Kernel smooth, edge, point;

    explicit FeatureKernels(double pixels_per_degree) {
        const double sigma = 0.5 * kFeatureWidthDeg * pixels_per_degree;
        const int radius = static_cast<int>(std::ceil(3 * sigma));
        for (int k = -radius; k <= radius; ++k) {
            const double g = std::exp(-k * k / (2 * sigma * sigma));
            smooth.push_back(g);
            edge.push_back(-k * g);
            point.push_back((k * k / (sigma * sigma) - 1) * g);
        }
        smooth = scaled(smooth, 1 / sum_of(smooth));
        for (Kernel* kernel : {&edge, &point}) {
            double positive = 0, negative = 0;
            for (const double weight : *kernel) (weight > 0 ? positive : negative) += weight;
            // Pixels much wider than a feature show none.
            if (positive < 1e-30 || negative > -1e-30) *kernel = scaled(*kernel, 0);
            for (double& weight : *kernel) {
                if (weight > 0) weight /= positive;
                if (weight < 0) weight /= -negative;
            }
        }
    }
};

// Strength of edges or points in every direction.
std::vector<float> feature_strength(const Plane& lightness, const Kernel& derivative, const Kernel& smooth) {
    Plane x = convolved(lightness, derivative, smooth);
    const Plane y = convolved(lightness, smooth, derivative);
    for (std::size_t i = 0; i < x.values.size(); ++i) x.values[i] = std::hypot(x.values[i], y.values[i]);
    return std::move(x.values);
}

// What one picture becomes before it is compared.
struct Prepared {
    std::vector<Colour> colour;  // filtered, Hunt-adjusted
    std::vector<float> edges, points;
};

Prepared prepare(RgbaView picture, double pixels_per_degree) {
    std::array<double, 256> linear;
    for (int code = 0; code < 256; ++code) {
        const double v = code / 255.0;
        linear[code] = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
    }
    const std::size_t pixels = static_cast<std::size_t>(picture.width) * picture.height;
    std::array<Plane, 3> opponent;
    for (Plane& plane : opponent) plane = {picture.width, picture.height, std::vector<float>(pixels)};
    Plane lightness{picture.width, picture.height, std::vector<float>(pixels)};
    for (std::size_t i = 0; i < pixels; ++i) {
        const std::uint8_t* const byte = &picture.bytes[4 * i];
        const Colour o = opponent_from_rgb({linear[byte[0]], linear[byte[1]], linear[byte[2]]});
        opponent[0].values[i] = static_cast<float>(o.a);
        opponent[1].values[i] = static_cast<float>(o.b);
        opponent[2].values[i] = static_cast<float>(o.c);
        lightness.values[i] = static_cast<float>((o.a + 16) / 116);
    }

    // Blur colour as the eye does at this distance.
    const Plane achromatic = sensitivity_filtered(opponent[0], kAchromatic, pixels_per_degree);
    const Plane red_green = sensitivity_filtered(opponent[1], kRedGreen, pixels_per_degree);
    const Plane blue_yellow = sensitivity_filtered(opponent[2], kBlueYellow, pixels_per_degree);
    Prepared out;
    out.colour.reserve(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const Colour rgb =
            rgb_from_opponent({achromatic.values[i], red_green.values[i], blue_yellow.values[i]});
        out.colour.push_back(hunt_lab_from_rgb(
            {std::clamp(rgb.a, 0.0, 1.0), std::clamp(rgb.b, 0.0, 1.0), std::clamp(rgb.c, 0.0, 1.0)}));
    }

    // Find edges and points in the sharp picture.
    const FeatureKernels kernels(pixels_per_degree);
    out.edges = feature_strength(lightness, kernels.edge, kernels.smooth);
    out.points = feature_strength(lightness, kernels.point, kernels.smooth);
    return out;
}

}  // namespace

std::vector<float> flip_map(RgbaView test, RgbaView reference, double pixels_per_degree) {
    const std::size_t pixels = static_cast<std::size_t>(std::max(test.width, 0)) * std::max(test.height, 0);
    if (pixels == 0 || test.width != reference.width || test.height != reference.height ||
        test.bytes.size() < 4 * pixels || reference.bytes.size() < 4 * pixels)
        throw std::runtime_error("FLIP: the two pictures must be of one size and not empty");
    if (!(pixels_per_degree > 0) || !std::isfinite(pixels_per_degree))
        throw std::runtime_error("FLIP: pixels per degree must be a number above 0");

    const Prepared t = prepare(test, pixels_per_degree), r = prepare(reference, pixels_per_degree);
    const double most = colour_distance(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1}));
    const double knee = kColourKnee * most;
    std::vector<float> map(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        // Spread the distances below the knee over most of the range.
        const double distance = colour_distance(t.colour[i], r.colour[i]);
        const double colour = distance < knee
                                  ? kColourAtKnee / knee * distance
                                  : kColourAtKnee + (distance - knee) / (most - knee) * (1 - kColourAtKnee);
        const double features = std::max(std::fabs(double{t.edges[i]} - r.edges[i]),
                                         std::fabs(double{t.points[i]} - r.points[i]));
        const double feature = std::pow(features / std::numbers::sqrt2, kFeaturePower);
        map[i] = static_cast<float>(std::clamp(std::pow(colour, 1 - std::min(feature, 1.0)), 0.0, 1.0));
    }
    return map;
}

double flip_mean(const std::vector<float>& map) {
    return map.empty() ? 0 : std::accumulate(map.begin(), map.end(), 0.0) / static_cast<double>(map.size());
}

}  // namespace parafovea
