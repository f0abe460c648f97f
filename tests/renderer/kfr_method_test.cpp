// Kernel foveated rendering: culling changes no pixel, counts are exact, the fovea is kept, the gaze is
// followed.
#include "renderer/methods/kfr_method.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/renderer/kernel_map_oracle.h"
#include "tests/renderer/picture_method.h"

namespace parafovea {
namespace {

RenderMethod kfr(std::map<std::string, double> numbers = {}, std::map<std::string, std::string> words = {}) {
    return {"kfr", std::move(numbers), std::move(words)};
}

// Texels in the bilinear footprint of a pixel, found from the equations, by marking from every pixel.
std::set<std::pair<int, int>> texels_read(const oracle::Map& truth) {
    const int w = static_cast<int>(truth.w()), h = static_cast<int>(truth.h());
    std::set<std::pair<int, int>> read;
    for (int y = 0; y < truth.screen.height; ++y) {
        for (int x = 0; x < truth.screen.width; ++x) {
            const oracle::Position p = truth.to_buffer({x + 0.5L, y + 0.5L});
            const int a = static_cast<int>(std::floor(p.x - 0.5L)),
                      b = static_cast<int>(std::floor(p.y - 0.5L));
            for (const int i : {a, a + 1}) {
                for (const int j : {b, b + 1}) read.insert({std::clamp(i, 0, w - 1), (j + h) % h});
            }
        }
    }
    return read;
}

struct Case {
    PointPx gaze;
    std::map<std::string, double> numbers;
    std::map<std::string, std::string> words;
    Jitter jitter;
};

std::vector<Case> culling_cases(SizePx size) {
    const double w = size.width, h = size.height;
    std::vector<Case> cases;
    for (const PointPx gaze :
         {PointPx{w / 2, h / 2}, PointPx{w / 2 + 0.5, h / 2 + 0.5}, PointPx{0, 0}, PointPx{w, h},
          PointPx{0.3 * w + 0.1, 0.8 * h}, PointPx{-500, h / 2}, PointPx{w + 30, -20}, PointPx{1e6, 1e6}}) {
        cases.push_back({gaze, {}, {}, {}});
    }
    for (const double alpha : {0.5, 1.0, 16.0}) cases.push_back({{w / 2, h / 2}, {{"alpha", alpha}}, {}, {}});
    for (const double sigma : {0.7, 2.4, 20.0}) cases.push_back({{w / 3, h / 3}, {{"sigma", sigma}}, {}, {}});
    cases.push_back({{w / 2, h / 2}, {{"as_printed", 1}}, {}, {}});
    cases.push_back({{10, 10}, {{"as_printed", 1}, {"alpha", 2}}, {}, {}});
    cases.push_back({{w / 2, h / 2}, {}, {{"kernel", "sine"}}, {}});
    cases.push_back({{w / 2, h / 3}, {{"inset", 0.1}}, {}, {}});
    cases.push_back({{0, h}, {{"inset", 0.3}, {"width_scale", 0.3}, {"height_scale", 1.3}}, {}, {}});
    cases.push_back({{w / 2, h / 2}, {}, {{"kernel", "linear_mar"}}, {}});
    cases.push_back({{w, h / 2}, {{"mar_start", 0.2}, {"mar_slope", 5}}, {{"kernel", "linear_mar"}}, {}});
    cases.push_back({{w / 2, h / 2}, {}, {{"kernel", "exponential"}}, {}});
    cases.push_back({{w / 2, h / 2}, {{"beta_1", 0.25}, {"beta_3", 0.75}}, {{"kernel", "polynomial"}}, {}});
    // The same gaze four times: a mask for other samples is of no use.
    for (const Jitter jitter : {Jitter{-0.5f, 0.25f}, Jitter{0.49f, -0.5f}, Jitter{0, 0.3f}, Jitter{}})
        cases.push_back({{w / 2, h / 2}, {}, {}, jitter});
    cases.push_back({{w / 4, h / 5}, {{"inset", 0.1}}, {}, {0.4f, -0.3f}});
    cases.push_back({{w, h / 3}, {{"alpha", 1}}, {{"kernel", "linear_mar"}}, {-0.2f, 0.4f}});
    return cases;
}

TEST(KfrMethod, PictureIsBitByBitTheSameWithAndWithoutCulling) {
    Gpu gpu({.validation = true});
    for (const SizePx size : {SizePx{320, 180}, SizePx{91, 140}, SizePx{1, 1}, SizePx{3, 200}}) {
        for (const double filter : {0.0, 1.0}) {
            // Drawn in turn, so that what is not shaded holds the remains of other gazes.
            PictureMethod culled(gpu, noise_picture(size), "kfr");
            PictureMethod whole(gpu, noise_picture(size), "kfr");
            std::vector<Case> cases = culling_cases(size);
            for (Case& c : cases) {
                c.numbers["internal_filter"] = filter;
                c.numbers["culling"] = 1;
                const Image with = culled.draw(kfr(c.numbers, c.words), c.gaze, c.jitter);
                c.numbers["culling"] = 0;
                const Image without = whole.draw(kfr(c.numbers, c.words), c.gaze, c.jitter);
                EXPECT_TRUE(with == without)
                    << size.width << "x" << size.height << " gaze " << c.gaze.x << ", " << c.gaze.y
                    << " filter " << filter << " case " << &c - &cases.front();
                EXPECT_LE(culled.statistics().shaded_samples, whole.statistics().shaded_samples);
            }
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(KfrMethod, ComputeShadersDrawBitByBitWhatFragmentsDraw) {
    Gpu gpu({.validation = true});
    const SizePx size{320, 180};
    PictureMethod fragments(gpu, noise_picture(size), "kfr");
    PictureMethod compute(gpu, noise_picture(size), [&](ShadingSource source) {
        source.in_compute = true;
        return make_method(gpu, "kfr", source);
    });
    for (Case c : culling_cases(size)) {
        for (const double culling : {0.0, 1.0}) {
            c.numbers["culling"] = culling;
            const RenderMethod setting = kfr(c.numbers, c.words);
            EXPECT_TRUE(compute.draw(setting, c.gaze, c.jitter) == fragments.draw(setting, c.gaze, c.jitter))
                << "gaze " << c.gaze.x << ", " << c.gaze.y << " culling " << culling;
            EXPECT_EQ(compute.statistics().shaded_samples, fragments.statistics().shaded_samples);
        }
    }
    const std::vector<FeatureNote> built = compute.statistics().built;
    EXPECT_TRUE(std::ranges::find(built, "Pass I in compute shaders", &FeatureNote::name) != built.end());
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(KfrMethod, ShadesEveryTexelThatIsReadAndHardlyAnyOther) {
    Gpu gpu({.validation = true});
    const SizePx size{320, 180};
    PictureMethod method(gpu, smooth_picture(size), "kfr");
    for (const PointPx gaze : {PointPx{160, 90}, PointPx{0, 0}, PointPx{250.25, 37.5}, PointPx{-50, 200}}) {
        for (const double alpha : {1.0, 4.0, 6.0}) {
            method.draw(kfr({{"alpha", alpha}, {"internal_filter", 0}}), gaze);
            const double read = static_cast<double>(texels_read({size, gaze, {.alpha = alpha}}).size());
            EXPECT_GE(static_cast<double>(method.statistics().shaded_samples), read);
            EXPECT_LE(static_cast<double>(method.statistics().shaded_samples), 1.01 * read + 8);
        }
    }
}

TEST(KfrMethod, ShadesAtMost26PercentAtThePapersSetting) {
    Gpu gpu;
    for (const SizePx size : {SizePx{1280, 720}, SizePx{800, 800}}) {
        PictureMethod method(gpu, smooth_picture(size), "kfr");
        const double pixels = static_cast<double>(size.width) * size.height;
        method.draw(kfr(), centre_of(size));
        EXPECT_LE(static_cast<double>(method.statistics().shaded_samples), 0.26 * pixels);
        method.draw(kfr({{"culling", 0}}), centre_of(size));
        EXPECT_NEAR(static_cast<double>(method.statistics().shaded_samples), 0.309 * pixels, 0.001 * pixels);
    }
}

TEST(KfrMethod, CornerGazeShadesAQuarterOfWhatACentredOneDoes) {
    Gpu gpu;
    const SizePx size{640, 360};
    PictureMethod method(gpu, smooth_picture(size), "kfr");
    method.draw(kfr(), centre_of(size));
    const std::uint64_t centred = method.statistics().shaded_samples;
    method.draw(kfr(), {0, 0});
    EXPECT_LT(method.statistics().shaded_samples, 0.35 * static_cast<double>(centred));
}

TEST(KfrMethod, SameInputGivesTheSameBitsWhateverWasDrawnBefore) {
    Gpu gpu({.validation = true});
    const SizePx size{320, 180};
    const Image picture = noise_picture(size);
    PictureMethod first(gpu, picture, "kfr");
    const Image wanted = first.draw(kfr(), {100, 90});
    PictureMethod second(gpu, picture, "kfr");
    second.draw(kfr({{"sigma", 2.4}, {"alpha", 1}, {"post_filter", 1}}), {0, 0});
    second.draw(kfr(), {200, 20});
    EXPECT_TRUE(second.draw(kfr(), {100, 90}) == wanted);
    EXPECT_TRUE(second.draw(kfr(), {100, 90}) == wanted);
    EXPECT_TRUE(gpu.validation_messages().empty());
}

int red(const Image& image, int x, int y) {
    return image.rgba[static_cast<std::size_t>(y * image.size.width + x) * 4];
}

double largest_difference(const Image& a, const Image& b, PointPx centre, double from_px, double to_px) {
    int largest = 0;
    for (int y = 0; y < a.size.height; ++y) {
        for (int x = 0; x < a.size.width; ++x) {
            const double r = std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y);
            if (r < from_px || r >= to_px) continue;
            for (int c = 0; c < 3; ++c) {
                const std::size_t i =
                    static_cast<std::size_t>(y * a.size.width + x) * 4 + static_cast<std::size_t>(c);
                largest = std::max(largest, std::abs(a.rgba[i] - b.rgba[i]));
            }
        }
    }
    return largest;
}

TEST(KfrMethod, SmoothPictureStaysWhatItIsEverywhereSeamIncluded) {
    Gpu gpu({.validation = true});
    const SizePx size{640, 360};
    const Image picture = smooth_picture(size);
    PictureMethod full(gpu, picture, "full");
    PictureMethod foveated(gpu, picture, "kfr");
    const Image reference = full.draw({}, {});
    for (const PointPx gaze : {centre_of(size), PointPx{100.5, 300.5}, PointPx{639, 1}}) {
        for (const double alpha : {1.0, 4.0}) {
            const Image found = foveated.draw(kfr({{"alpha", alpha}}), gaze);
            EXPECT_LE(largest_difference(reference, found, gaze, 0, 60), 4) << alpha;
            EXPECT_LE(largest_difference(reference, found, gaze, 0, 1e9), 16) << alpha;
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

TEST(KfrMethod, ResamplingTakesTheJitterBack) {
    Gpu gpu({.validation = true});
    const SizePx size{640, 360};
    // A ramp: a sample that is put back in the wrong place by a texel (5 px and more) shows at once.
    Image ramp{size, {}};
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const auto level = static_cast<std::uint8_t>(64 + x / 5);
            ramp.rgba.insert(ramp.rgba.end(), {level, static_cast<std::uint8_t>(64 + y / 3), level, 255});
        }
    }
    PictureMethod foveated(gpu, ramp, "kfr");
    const PointPx gaze{300, 170};
    for (const double inset : {0.0, 0.08}) {
        const RenderMethod method = kfr({{"sigma", 4}, {"internal_filter", 0}, {"inset", inset}});
        const Image still = foveated.draw(method, gaze);
        for (const Jitter jitter :
             {Jitter{0.45f, 0}, Jitter{-0.45f, 0}, Jitter{0, 0.45f}, Jitter{0, -0.45f}}) {
            const Image moved = foveated.draw(method, gaze, jitter);
            EXPECT_FALSE(moved == still);
            EXPECT_LE(largest_difference(still, moved, gaze, 20, 160), 2) << jitter.x << ", " << jitter.y;
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

TEST(FullMethod, JitterShiftsEverySampleByThatManyPixels) {
    Gpu gpu({.validation = true});
    const SizePx size{32, 16};
    // Between black and white columns, display-linear values are bilinear: 64 of 255 is a quarter of the way.
    Image columns{size, {}};
    for (int i = 0; i < size.width * size.height; ++i) {
        const std::uint8_t level = i % 2 == 0 ? 0 : 255;
        columns.rgba.insert(columns.rgba.end(), {level, level, level, 255});
    }
    PictureMethod full(gpu, columns, "full");
    const auto srgb_of = [](double linear) {
        return linear <= 0.0031308 ? 255 * 12.92 * linear : 255 * (1.055 * std::pow(linear, 1 / 2.4) - 0.055);
    };
    for (const float shift : {-0.5f, -0.25f, 0.0f, 0.25f, 0.4f}) {
        const Image drawn = full.draw({}, {}, {shift, 0.3f});
        EXPECT_NEAR(red(drawn, 6, 8), srgb_of(std::abs(shift)), 1) << shift;
        EXPECT_NEAR(red(drawn, 7, 8), srgb_of(1 - std::abs(shift)), 1) << shift;
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

TEST(KfrMethod, DetailIsLostAwayFromTheGazeAndFollowsIt) {
    Gpu gpu;
    const SizePx size{640, 360};
    const Image picture = noise_picture(size);
    PictureMethod full(gpu, picture, "full");
    PictureMethod foveated(gpu, picture, "kfr");
    const Image reference = full.draw({}, {});
    const auto error_at = [&](const Image& image, PointPx place) {
        double sum = 0;
        int count = 0;
        for (int y = static_cast<int>(place.y) - 15; y < place.y + 15; ++y) {
            for (int x = static_cast<int>(place.x) - 15; x < place.x + 15; ++x, ++count) {
                const std::size_t i = static_cast<std::size_t>(y * size.width + x) * 4;
                sum += std::abs(image.rgba[i] - reference.rgba[i]);
            }
        }
        return sum / count;
    };
    for (const PointPx gaze : {PointPx{100, 180}, PointPx{540, 180}}) {
        const PointPx away{640 - gaze.x, gaze.y};
        const Image found = foveated.draw(kfr(), gaze);
        EXPECT_LT(1.5 * error_at(found, gaze), error_at(found, away));
    }
}

TEST(KfrMethod, InsetIsFullResolutionWhereverItLies) {
    Gpu gpu({.validation = true});
    const SizePx size{320, 180};
    const Image picture = noise_picture(size);
    PictureMethod full(gpu, picture, "full");
    PictureMethod foveated(gpu, picture, "kfr");
    const Image reference = full.draw({}, {});
    for (const PointPx gaze : {centre_of(size), PointPx{5, 170}, PointPx{319.5, 0.5}, PointPx{-20, 90}}) {
        for (const char* kernel : {"power", "linear_mar"}) {
            const Image found = foveated.draw(kfr({{"inset", 32.0 / 180}}, {{"kernel", kernel}}), gaze);
            EXPECT_LE(largest_difference(reference, found, gaze, 0, 32 - 8), 0);
            EXPECT_GT(largest_difference(reference, found, gaze, 40, 1e9), 20);
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

TEST(KfrMethod, InsetSavesTheTexelsBelowIt) {
    Gpu gpu;
    const SizePx size{1280, 720};
    PictureMethod method(gpu, smooth_picture(size), "kfr");
    method.draw(kfr(), centre_of(size));
    const std::uint64_t without = method.statistics().shaded_samples;
    method.draw(kfr({{"inset", 0.12}}), centre_of(size));
    EXPECT_LT(method.statistics().shaded_samples, without);
}

TEST(KfrMethod, SettingsThatTakeTurnsKeepTheirPictures) {
    Gpu gpu({.validation = true});
    const SizePx size{200, 120};
    PictureMethod method(gpu, noise_picture(size), "kfr");
    std::vector<RenderMethod> settings;
    for (int i = 0; i < 12; ++i) settings.push_back(kfr({{"sigma", 1.2 + 0.1 * i}, {"alpha", 1.0 + i % 4}}));
    std::vector<Image> first;
    for (const RenderMethod& setting : settings) first.push_back(method.draw(setting, {60, 60}));
    for (std::size_t i = 0; i < settings.size(); ++i) {
        EXPECT_TRUE(method.draw(settings[i], {60, 60}) == first[i]) << i;
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

TEST(KfrMethod, GazeThatIsNoNumberIsTheCentre) {
    Gpu gpu({.validation = true});
    const SizePx size{320, 180};
    PictureMethod method(gpu, noise_picture(size), "kfr");
    EXPECT_TRUE(method.draw(kfr(), {std::nan(""), std::nan("")}) == method.draw(kfr(), centre_of(size)));
}

TEST(KfrMethod, PostFilterSmoothsThePeripheryOnlyAndNothingWhenOff) {
    Gpu gpu({.validation = true});
    const SizePx size{640, 360};
    PictureMethod method(gpu, noise_picture(size), "kfr");
    const PointPx gaze = centre_of(size);
    const Image plain = method.draw(kfr({{"post_filter", 0}}), gaze);
    const Image smoothed = method.draw(kfr({{"post_filter", 1}}), gaze);
    EXPECT_TRUE(plain == method.draw(kfr(), gaze));
    const double radius = std::hypot(320, 180);
    EXPECT_LE(largest_difference(plain, smoothed, gaze, 0, 0.099 * radius), 1);  // half-float storage between
    EXPECT_GT(largest_difference(plain, smoothed, gaze, 0.11 * radius, 0.2 * radius), 10);
    EXPECT_TRUE(gpu.validation_messages().empty());
}

}  // namespace
}  // namespace parafovea
