// The map applied to a picture, against the equations evaluated in long double.
#include "renderer/foveate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/renderer/kernel_map_oracle.h"
#include "tests/renderer/picture_method.h"

namespace parafovea {
namespace {

using Real = oracle::Real;

Real picture_at(const Image& picture, Real x, Real y, int channel) {
    const auto fetch = [&](Real i, Real j) -> Real {
        const int column = std::clamp(static_cast<int>(i), 0, picture.size.width - 1);
        const int row = std::clamp(static_cast<int>(j), 0, picture.size.height - 1);
        return picture.rgba[static_cast<std::size_t>(row * picture.size.width + column) * 4 +
                            static_cast<std::size_t>(channel)];
    };
    x = std::fmin(std::fmax(x, 0.5L), picture.size.width - 0.5L);
    y = std::fmin(std::fmax(y, 0.5L), picture.size.height - 0.5L);
    const Real i = std::floor(x - 0.5L), j = std::floor(y - 0.5L), fx = x - 0.5L - i, fy = y - 0.5L - j;
    return (1 - fy) * ((1 - fx) * fetch(i, j) + fx * fetch(i + 1, j)) +
           fy * ((1 - fx) * fetch(i, j + 1) + fx * fetch(i + 1, j + 1));
}

// Filters off: for each pixel its four texels, for each texel its four picture pixels.
// `radii` holds map.radius() of every column.
std::array<Real, 3> expected_pixel(const Image& picture, const oracle::Map& map,
                                   const std::vector<Real>& radii, int x, int y) {
    const oracle::Position p = map.to_buffer({x + 0.5L, y + 0.5L});
    const Real a = std::floor(p.x - 0.5L), b = std::floor(p.y - 0.5L), fa = p.x - 0.5L - a,
               fb = p.y - 0.5L - b;
    std::array<Real, 3> sum{};
    for (const int da : {0, 1}) {
        for (const int db : {0, 1}) {
            const Real column = std::fmin(std::fmax(a + da, 0.0L), map.w() - 1);
            const Real theta = 2 * std::numbers::pi_v<Real> * (b + db + 0.5L) / map.h();
            const Real r = radii[static_cast<std::size_t>(column)];
            const oracle::Position q{map.gaze.x + r * std::cos(theta), map.gaze.y + r * std::sin(theta)};
            const Real weight = (da ? fa : 1 - fa) * (db ? fb : 1 - fb);
            for (int c = 0; c < 3; ++c)
                sum[static_cast<std::size_t>(c)] += weight * picture_at(picture, q.x, q.y, c);
        }
    }
    return sum;
}

TEST(Foveate, EqualsTheEquationsToWithinOneLevel) {
    Gpu gpu({.validation = true});
    const SizePx size{200, 130};
    const Image picture = noise_picture(size);
    for (const PointPx gaze : {PointPx{100, 65}, PointPx{0, 0}, PointPx{200, 130}, PointPx{-500, 65},
                               PointPx{100, 630}, PointPx{60.5, 20.5}}) {
        std::vector<KernelSetting> settings;
        for (const double alpha : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}) settings.push_back({.alpha = alpha});
        settings.push_back({.alpha = 2, .as_printed = true});
        settings.push_back({.kind = KernelKind::sine});
        settings.push_back({.kind = KernelKind::exponential, .sigma = 2.4});
        settings.push_back({.kind = KernelKind::polynomial, .betas = {0.5, 0.5}});
        for (const KernelSetting& setting : settings) {
            SCOPED_TRACE(std::string(name_of(setting.kind)) + " alpha " + std::to_string(setting.alpha) +
                         " gaze " + std::to_string(gaze.x) + ", " + std::to_string(gaze.y));
            const Image found = foveate(gpu, picture, setting, gaze, {.internal_filter = false});
            const oracle::Map map{size, gaze, setting};
            std::vector<Real> radii;
            for (int a = 0; a < static_cast<int>(map.w()); ++a) radii.push_back(map.radius(a + 0.5L));
            int wrong = 0;
            double worst = 0;
            for (int y = 0; y < size.height; y += 3) {
                for (int x = 0; x < size.width; x += 2) {
                    const std::array<Real, 3> wanted = expected_pixel(picture, map, radii, x, y);
                    for (std::size_t c = 0; c < 3; ++c) {
                        const double value = found.rgba[static_cast<std::size_t>(y * size.width + x) * 4 + c];
                        const double off = std::abs(value - static_cast<double>(wanted[c]));
                        worst = std::fmax(worst, off);
                        wrong += off > 1.0 ? 1 : 0;
                    }
                }
            }
            EXPECT_EQ(wrong, 0) << "worst " << worst;
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

TEST(Foveate, KeepsAPictureOfOneColour) {
    Gpu gpu({.validation = true});
    Image picture{{97, 61}, {}};
    for (int i = 0; i < 97 * 61; ++i) picture.rgba.insert(picture.rgba.end(), {200, 3, 117, 255});
    for (const bool filter : {false, true}) {
        EXPECT_TRUE(foveate(gpu, picture, {}, {30, 20}, {.internal_filter = filter, .post_filter = filter}) ==
                    picture);
    }
}

TEST(Foveate, ChangesWithTheInternalFilterOnlyInThePeriphery) {
    Gpu gpu({.validation = true});
    const SizePx size{320, 180};
    const Image picture = noise_picture(size);
    const PointPx gaze = centre_of(size);
    const Image plain = foveate(gpu, picture, {}, gaze, {.internal_filter = false});
    const Image filtered = foveate(gpu, picture, {}, gaze, {.internal_filter = true});
    const shared::KernelMap map = make_kernel_map(size, gaze, {});
    const double border = shared::radius_of_column(map, 0.5f * map.buffer_size.x - 1.0f);
    int changed_inside = 0, changed_outside = 0;
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const std::size_t i = static_cast<std::size_t>(y * size.width + x) * 4;
            const bool changed = !std::equal(&plain.rgba[i], &plain.rgba[i] + 3, &filtered.rgba[i]);
            const bool inside = std::hypot(x + 0.5 - gaze.x, y + 0.5 - gaze.y) < border;
            (inside ? changed_inside : changed_outside) += changed ? 1 : 0;
        }
    }
    EXPECT_EQ(changed_inside, 0);
    EXPECT_GT(changed_outside, size.width * size.height / 4);
}

TEST(Foveate, WorksOnTheSmallestPictures) {
    Gpu gpu({.validation = true});
    for (const SizePx size : {SizePx{1, 1}, SizePx{2, 1}, SizePx{1, 50}, SizePx{50, 1}}) {
        const Image found = foveate(gpu, noise_picture(size), {}, centre_of(size));
        EXPECT_EQ(found.rgba.size(), static_cast<std::size_t>(size.width * size.height * 4));
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

}  // namespace
}  // namespace parafovea
