// Every foveation method is asked the same questions: is the fovea that of full resolution, is the gaze
// followed wherever it is, is the picture the same every time, is it cheaper.
#include "renderer/methods/method_list.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "renderer/frame_renderer.h"
#include "renderer/methods/method_settings.h"
#include "renderer/scene_catalog.h"
#include "tests/renderer/picture_method.h"

namespace parafovea {
namespace {

constexpr SizePx kSize{160, 90};

class EveryMethod : public testing::TestWithParam<std::string> {
  protected:
    // Making a device takes longer than most of these tests.
    static void SetUpTestSuite() { gpu_owner_ = std::make_unique<Gpu>(GpuOptions{.validation = true}); }
    static void TearDownTestSuite() { gpu_owner_.reset(); }

    void TearDown() override {
        EXPECT_TRUE(gpu_.validation_messages().empty()) << gpu_.validation_messages().front();
    }

    // The defaults, but for what is told in degrees, which these small screens have few pixels for.
    RenderMethod method() const {
        RenderMethod method{GetParam(), {}, {}};
        if (method.name == "f3d") method.numbers["mar_slope"] = 0.15;
        return method;
    }
    // Full resolution does not, and a picture has no loops to shorten.
    bool foveates() const {
        return GetParam() != "full" && GetParam() != "swafford_occlusion" && GetParam() != "swafford_steps";
    }

    Gpu& gpu_ = *gpu_owner_;

  private:
    static std::unique_ptr<Gpu> gpu_owner_;
};
std::unique_ptr<Gpu> EveryMethod::gpu_owner_;

INSTANTIATE_TEST_SUITE_P(MethodList, EveryMethod, testing::ValuesIn([] {
                             std::vector<std::string> names;
                             for (const MethodName& known : method_names()) names.push_back(known.name);
                             return names;
                         }()),
                         [](const auto& name) { return name.param; });

struct Difference {
    double mean = 0;
    int most = 0;
};

Difference difference(const Image& a, const Image& b, PointPx centre, double from_px, double to_px) {
    Difference found;
    double count = 0;
    for (int y = 0; y < a.size.height; ++y) {
        for (int x = 0; x < a.size.width; ++x) {
            const double r = std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y);
            if (r < from_px || r >= to_px) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t i = static_cast<std::size_t>(y * a.size.width + x) * 4 + c;
                const int d = std::abs(a.rgba[i] - b.rgba[i]);
                found.most = std::max(found.most, d);
                found.mean += d;
                ++count;
            }
        }
    }
    found.mean /= std::max(count, 1.0);
    return found;
}

const std::vector<PointPx>& gazes() {
    static const std::vector<PointPx> all{{80, 45},     {80.5, 45.5}, {0, 0},    {160, 90},
                                          {37.3, 61.8}, {-40, 45},    {190, -20}};
    return all;
}

TEST_P(EveryMethod, LeavesASmoothPictureAsItIs) {
    const Image picture = smooth_picture(kSize);
    PictureMethod full(gpu_, picture, "full");
    const Image reference = full.draw({}, {});
    PictureMethod drawing(gpu_, picture, GetParam());
    for (const PointPx gaze : gazes()) {
        const Image found = drawing.draw(method(), gaze);
        EXPECT_LE(difference(reference, found, gaze, 0, 8).most, 4) << gaze.x << ", " << gaze.y;
        EXPECT_LE(difference(reference, found, gaze, 0, 1e9).most, 24) << gaze.x << ", " << gaze.y;
        EXPECT_LE(difference(reference, found, gaze, 0, 1e9).mean, 4) << gaze.x << ", " << gaze.y;
    }
}

TEST_P(EveryMethod, KeepsDetailAtTheGazeAndFollowsIt) {
    if (!foveates()) GTEST_SKIP() << "full resolution of a picture has no gaze";
    const SizePx size{320, 180};
    const Image picture = noise_picture(size);
    PictureMethod full(gpu_, picture, "full");
    const Image reference = full.draw({}, {});
    PictureMethod drawing(gpu_, picture, GetParam());
    for (const PointPx gaze : {PointPx{60, 90}, PointPx{260, 90}}) {
        const PointPx away{320 - gaze.x, gaze.y};
        const Image found = drawing.draw(method(), gaze);
        const double here = difference(reference, found, gaze, 0, 8).mean;
        const double there = difference(reference, found, away, 0, 30).mean;
        EXPECT_LT(1.4 * here, there) << gaze.x;
        EXPECT_GT(there, 10);
    }
}

TEST_P(EveryMethod, DrawsTheSamePictureEveryTimeWhateverWasDrawnBefore) {
    const Image picture = noise_picture(kSize);
    PictureMethod first(gpu_, picture, GetParam());
    const Image wanted = first.draw(method(), {70, 40});
    EXPECT_TRUE(first.draw(method(), {70, 40}) == wanted);
    PictureMethod second(gpu_, picture, GetParam());
    for (const PointPx gaze : gazes()) second.draw(method(), gaze, {0.3f, -0.4f});
    second.draw(method(), {1e6, -1e6});
    EXPECT_TRUE(second.draw(method(), {70, 40}) == wanted);
}

TEST_P(EveryMethod, CostsLessThanFullResolutionAndLeastWithTheGazeFarAway) {
    const SizePx size{320, 180};
    PictureMethod drawing(gpu_, noise_picture(size), GetParam());
    drawing.draw(method(), centre_of(size));
    const double centred = static_cast<double>(drawing.statistics().shaded_samples);
    EXPECT_GT(centred, 0);
    EXPECT_LE(centred, (foveates() ? 0.6 : 1.0) * size.width * size.height);
    drawing.draw(method(), {-2000, 90});
    EXPECT_LE(static_cast<double>(drawing.statistics().shaded_samples), centred);
    EXPECT_GT(drawing.statistics().shaded_samples, 0U);
}

TEST_P(EveryMethod, TakesAGazeThatIsNoNumberForTheCentre) {
    PictureMethod drawing(gpu_, noise_picture(kSize), GetParam());
    const Image centred = drawing.draw(method(), centre_of(kSize));
    EXPECT_TRUE(drawing.draw(method(), {std::nan(""), 10}) == centred);
    EXPECT_TRUE(drawing.draw(method(), {10, std::numeric_limits<double>::infinity()}) == centred);
}

TEST_P(EveryMethod, DrawsScreensOfEveryShape) {
    for (const SizePx size : {SizePx{1, 1}, SizePx{2, 50}, SizePx{33, 65}}) {
        const Image picture = smooth_picture(size);
        PictureMethod full(gpu_, picture, "full");
        PictureMethod drawing(gpu_, picture, GetParam());
        const Image reference = full.draw({}, {});
        const Image found = drawing.draw(method(), centre_of(size));
        EXPECT_LE(difference(reference, found, {}, 0, 1e9).mean, 48) << size.width << "x" << size.height;
    }
}

TEST_P(EveryMethod, KeepsASmoothPictureInPlaceWhenItsSamplesAreShifted) {
    const Image picture = smooth_picture(kSize);
    PictureMethod drawing(gpu_, picture, GetParam());
    const Image still = drawing.draw(method(), {100, 40});
    for (const Jitter jitter : {Jitter{0.45f, 0}, Jitter{-0.5f, 0.45f}, Jitter{0, -0.5f}}) {
        const Image moved = drawing.draw(method(), {100, 40}, jitter);
        EXPECT_LE(difference(still, moved, {}, 0, 1e9).mean, 2) << jitter.x << ", " << jitter.y;
    }
}

TEST_P(EveryMethod, DrawsTheSamePictureWithAndWithoutCulling) {
    RenderMethod culled = method(), whole = method();
    culled.numbers["culling"] = 1;
    whole.numbers["culling"] = 0;
    try {
        check(culled);
    } catch (const std::runtime_error&) {
        GTEST_SKIP() << "the method has no culling";
    }
    for (const SizePx size : {SizePx{80, 45}, SizePx{41, 60}}) {
        // Drawn in turn, so that what is not shaded holds the remains of other gazes.
        PictureMethod with(gpu_, noise_picture(size), GetParam());
        PictureMethod without(gpu_, noise_picture(size), GetParam());
        const double w = size.width, h = size.height;
        for (const PointPx gaze : {PointPx{w / 2, h / 2}, PointPx{0, 0}, PointPx{0.3 * w + 0.1, 0.8 * h},
                                   PointPx{-50, h / 2}, PointPx{1e6, 1e6}}) {
            for (const Jitter jitter : {Jitter{}, Jitter{-0.5f, 0.4f}}) {
                const Image a = with.draw(culled, gaze, jitter);
                const Image b = without.draw(whole, gaze, jitter);
                EXPECT_TRUE(a == b) << w << "x" << h << " gaze " << gaze.x << ", " << gaze.y << " jitter "
                                    << jitter.x << ": " << difference(a, b, {}, 0, 1e9).most;
                EXPECT_LE(with.statistics().shaded_samples, without.statistics().shaded_samples);
            }
        }
    }
}

TEST_P(EveryMethod, TellsASpacingThatIsFinestAtTheGaze) {
    PictureMethod drawing(gpu_, smooth_picture(kSize), GetParam());
    drawing.draw(method(), {40, 45});
    const SampleSpacing here = drawing.spacing_at({44, 45}), there = drawing.spacing_at({150, 45});
    for (const double spacing : {here.radial_px, here.tangential_px, there.radial_px, there.tangential_px}) {
        EXPECT_GT(spacing, 0);
        EXPECT_LT(spacing, 40);
    }
    EXPECT_LE(here.radial_px * here.tangential_px, 1.6);
    if (foveates()) {
        EXPECT_GT(there.radial_px * there.tangential_px, 1.2 * here.radial_px * here.tangential_px);
    }
}

TEST_P(EveryMethod, TellsTheSpacingThatItsSamplesHave) {
    if (GetParam() == "kfr" || GetParam() == "log_polar")
        GTEST_SKIP() << "their rays lie closer than any pixel reads around the gaze; see the map's own tests";
    // One sample for each spacing's area, added up over the screen, is every sample.
    const SizePx size{320, 180};
    PictureMethod drawing(gpu_, noise_picture(size), GetParam());
    RenderMethod wanted = method();
    if (wanted.name == "mrs") wanted.numbers["detail"] = 0;
    const bool layered =
        wanted.name == "f3d" || wanted.name == "quad_views" || wanted.name == "swafford_resolution";
    if (layered) wanted.numbers["blend"] = 0.01;
    for (const PointPx gaze : {centre_of(size), PointPx{70, 50}, PointPx{319, 3}}) {
        drawing.draw(wanted, gaze);
        double expected = 0;
        for (int y = 0; y < size.height; ++y) {
            for (int x = 0; x < size.width; ++x) {
                const SampleSpacing spacing = drawing.spacing_at({x + 0.5, y + 0.5});
                expected += 1 / (spacing.radial_px * spacing.tangential_px);
            }
        }
        const double found = static_cast<double>(drawing.statistics().shaded_samples);
        // Samples just outside the screen, and below what fades over them, are read, too.
        EXPECT_GT(found, 0.93 * expected) << gaze.x;
        EXPECT_LT(found, 1.3 * expected) << gaze.x;
    }
}

TEST(EffortMethods, SpendLessFarFromTheGazeAndAllAtIt) {
    Gpu gpu({.validation = true});
    const Scene scene = load_scene("primitives");
    FrameRenderer renderer(gpu, scene);
    const SizePx size{160, 90};
    const CameraView view = view_through(scene.cameras[0], size);
    for (const PointPx gaze : {PointPx{60, 60}, PointPx{130, 70}}) {
        const Image full = renderer.render(size, view, {}, gaze).image;
        for (const char* name : {"swafford_occlusion", "swafford_steps"}) {
            SCOPED_TRACE(name);
            const RenderedFrame frame = renderer.render(size, view, {name, {}, {}}, gaze);
            EXPECT_EQ(frame.statistics.shaded_samples, 160U * 90U);
            EXPECT_EQ(difference(full, frame.image, gaze, 0, 0.04 * 160).most, 0);
            EXPECT_GT(difference(full, frame.image, gaze, 60, 1e9).mean, 0.02);
            EXPECT_LT(difference(full, frame.image, gaze, 60, 1e9).mean, 8);
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty()) << gpu.validation_messages().front();
}

TEST(MethodList, SettingsForComparisonsAreValidAndCoverEveryMethod) {
    std::set<std::string> labels, methods;
    for (const NamedSetting& setting : tradeoff_settings()) {
        EXPECT_NO_THROW(check(setting.method)) << setting.label;
        EXPECT_FALSE(setting.source.empty()) << setting.label;
        EXPECT_TRUE(labels.insert(setting.label).second) << setting.label << " twice";
        methods.insert(setting.method.name);
    }
    for (const MethodName& known : method_names()) {
        EXPECT_TRUE(known.name == "full" || methods.contains(known.name)) << known.name;
    }
}

TEST(MethodList, RefusesUnknownMethodsParametersAndValuesInOneLine) {
    const auto message = [](const RenderMethod& method) {
        try {
            check(method);
        } catch (const std::runtime_error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(message({}), "");
    EXPECT_EQ(message({"kfr", {{"sigma", 1.2}, {"alpha", 3}, {"culling", 0}}, {{"kernel", "sine"}}}), "");
    EXPECT_NE(message({"kfz", {}, {}}).find("there are: full, kfr"), std::string::npos);
    EXPECT_NE(message({"kfr", {{"sigmma", 1.2}}, {}}).find("\"sigmma\""), std::string::npos);
    EXPECT_NE(message({"full", {{"sigma", 1.8}}, {}}).find("\"sigma\""), std::string::npos);
    EXPECT_NE(message({"kfr", {{"sigma", -1}}, {}}).find("sigma = -1"), std::string::npos);
    EXPECT_NE(message({"kfr", {{"culling", 0.5}}, {}}).find("0 or 1"), std::string::npos);
    EXPECT_NE(message({"kfr", {}, {{"kernel", "cubic"}}}).find("\"cubic\""), std::string::npos);
    for (const MethodName& known : method_names()) {
        EXPECT_NE(message({known.name, {{"no_such_thing", 1}}, {}}).find("\"no_such_thing\""),
                  std::string::npos)
            << known.name;
    }
    EXPECT_NE(message({"rings", {{"mar_slope", 0}}, {}}).find("mar_slope = 0"), std::string::npos);
    EXPECT_NE(message({"f3d", {{"fov_deg", 180}}, {}}).find("fov_deg = 180"), std::string::npos);
    EXPECT_NE(message({"rmfr", {{"sigma", 0.5}}, {}}).find("sigma = 0.5"), std::string::npos);
    EXPECT_NE(message({"cps", {{"interpolate", 2}}, {}}).find("0 or 1"), std::string::npos);
}

}  // namespace
}  // namespace parafovea
