// Rings that sample by detail: a quarter where there is nothing to see, everything where there is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/shared/sample_grid.h"
#include "tests/renderer/picture_method.h"

namespace parafovea {
namespace {

RenderMethod rings(bool adaptive, double detail = 0.025) {
    return {"rings",
            {{"mar_slope", 4}, {"mar_start", 0.05}, {"adaptive", adaptive ? 1.0 : 0.0}, {"detail", detail}},
            {}};
}

std::uint64_t samples(Gpu& gpu, const Image& picture, const RenderMethod& method, PointPx gaze) {
    PictureMethod drawing(gpu, picture, "rings");
    drawing.draw(method, gaze);
    return drawing.statistics().shaded_samples;
}

TEST(RingsByDetail, TakeAQuarterOfAnEvenPictureAndAllOfNoise) {
    Gpu gpu({.validation = true});
    const SizePx size{320, 180};
    Image even{size, {}};
    even.rgba.assign(320 * 180 * 4, 90);
    RenderMethod every = rings(false);
    const PointPx gaze{120, 70};
    const auto all = static_cast<double>(samples(gpu, even, rings(false), gaze));
    const auto of_even = static_cast<double>(samples(gpu, even, rings(true), gaze));
    const auto of_noise = static_cast<double>(samples(gpu, noise_picture(size), rings(true, 0.001), gaze));
    EXPECT_LT(of_even, 0.55 * all);  // the disc and what is close around it are whole
    EXPECT_GT(of_even, 0.25 * all);
    EXPECT_GT(of_noise, 0.97 * all);
    EXPECT_LT(of_noise, 1.15 * all);
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(RingsByDetail, TakeMoreSamplesTheLowerTheThreshold) {
    Gpu gpu({.validation = true});
    const SizePx size{160, 90};
    std::uint64_t before = 0;
    for (const double detail : {0.3, 0.1, 0.03, 0.003}) {
        const std::uint64_t found = samples(gpu, noise_picture(size), rings(true, detail), {80, 45});
        EXPECT_GE(found, before) << detail;
        before = found;
    }
}

TEST(RingsByDetail, DrawTheSamePictureWithAndWithoutCulling) {
    Gpu gpu({.validation = true});
    for (const SizePx size : {SizePx{80, 45}, SizePx{41, 60}}) {
        // Of waves: half of it has detail.
        Image picture = smooth_picture(size);
        const Image noise = noise_picture(size);
        std::copy_n(noise.rgba.begin(), noise.rgba.size() / 2, picture.rgba.begin());
        PictureMethod with(gpu, picture, "rings"), without(gpu, picture, "rings");
        const double w = size.width, h = size.height;
        for (const PointPx gaze : {PointPx{w / 2, h / 2}, PointPx{0, 0}, PointPx{0.3 * w + 0.1, 0.8 * h},
                                   PointPx{-50, h / 2}, PointPx{1e6, 1e6}}) {
            for (const Jitter jitter : {Jitter{}, Jitter{-0.5f, 0.4f}}) {
                RenderMethod culled = rings(true), whole = rings(true);
                whole.numbers["culling"] = 0;
                EXPECT_TRUE(with.draw(culled, gaze, jitter) == without.draw(whole, gaze, jitter))
                    << w << "x" << h << " gaze " << gaze.x << ", " << gaze.y << " jitter " << jitter.x;
                EXPECT_LE(with.statistics().shaded_samples, without.statistics().shaded_samples);
            }
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(RingsByDetail, KeepASmoothPictureAsItIsAndInPlace) {
    Gpu gpu({.validation = true});
    const SizePx size{160, 90};
    const Image picture = smooth_picture(size);
    PictureMethod full(gpu, picture, "full"), drawing(gpu, picture, "rings");
    const Image reference = full.draw({}, {});
    for (const PointPx gaze : {PointPx{80, 45}, PointPx{0, 0}, PointPx{37.3, 61.8}, PointPx{190, -20}}) {
        for (const Jitter jitter : {Jitter{}, Jitter{0.45f, -0.5f}}) {
            const Image found = drawing.draw(rings(true), gaze, jitter);
            double sum = 0;
            for (std::size_t i = 0; i < found.rgba.size(); ++i)
                sum += std::abs(found.rgba[i] - reference.rgba[i]);
            EXPECT_LT(sum / static_cast<double>(found.rgba.size()), 3) << gaze.x;
        }
    }
}

TEST(RingsByDetail, CoarseTexelsLieWhereTheirSamplesDo) {
    // The column that a coarse texel's own direction leads to is that texel.
    for (const float count : {4.0f, 10.0f, 250.0f, 4096.0f}) {
        for (int column = 1; column <= static_cast<int>(count) / 2; ++column) {
            const shared::vec2 texel = shared::texel_of_coarse(static_cast<float>(column), 3);
            EXPECT_EQ(texel.y, 6.5f);
            EXPECT_EQ(static_cast<int>(texel.x) % 2, 1);
            EXPECT_NEAR(shared::coarse_column((texel.x - 1) / count, count), static_cast<float>(column),
                        1e-3);
        }
    }
}

}  // namespace
}  // namespace parafovea
