// The stage on the simulated headset: what arrives at the eyes, and when.
#include "app/openxr_stage.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>

#include "renderer/scene_catalog.h"
#include "tests/devices/openxr_headset.h"

namespace parafovea {
namespace {

// The simulated headset's frustums and place of the eyes, as its README states them.
constexpr double kOuterDeg = 52, kInnerDeg = 48, kHalfEyeDistance_m = 0.0315, kGazeDistance_m = 2;

double tangent(double deg) {
    return std::tan(rad_from_deg(deg));
}

struct CapturedPicture {
    SizePx size;
    std::vector<std::uint8_t> rgb;

    std::array<int, 3> at(int x, int y) const {
        const std::size_t i = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                                   static_cast<std::size_t>(x));
        return {rgb[i], rgb[i + 1], rgb[i + 2]};
    }

    // Of what is bright, weighted.
    PointPx centroid() const {
        double sum = 0, x_sum = 0, y_sum = 0;
        for (int y = 0; y < size.height; ++y)
            for (int x = 0; x < size.width; ++x) {
                const double w = at(x, y)[0];
                sum += w;
                x_sum += w * (x + 0.5);
                y_sum += w * (y + 0.5);
            }
        return {x_sum / sum, y_sum / sum};
    }
};

CapturedPicture read_capture(const std::filesystem::path& path) {
    const std::string text = text_of(path);
    CapturedPicture picture;
    int deepest = 0, header = 0;
    EXPECT_EQ(std::sscanf(text.c_str(), "P6\n%d %d\n%d\n%n", &picture.size.width, &picture.size.height,
                          &deepest, &header),
              3)
        << path;
    picture.rgb.assign(text.begin() + header, text.end());
    return picture;
}

// Runs the stage under both validation layers, which must stay silent.
class StageUnderTest {
  public:
    explicit StageUnderTest(const std::string& settings, OpenXrStageOptions options = {}) {
        layers_.use("pacing=simulated;shrink=8;capture=" + folder_.path().string() + ";" + settings);
        options.validation = true;
        options.gaze_distance_m = kGazeDistance_m;
        stage_.emplace(clock_, options);
    }
    ~StageUnderTest() {
        EXPECT_THAT(stage_->gpu().validation_messages(), testing::IsEmpty());
        stage_.reset();
        layers_.expect_silence();
    }

    OpenXrStage& operator*() { return *stage_; }
    OpenXrStage* operator->() { return &*stage_; }

    // Shows a picture for three frames and returns what the eyes saw in the second.
    std::array<CapturedPicture, 2> capture(const Picture& picture) {
        stage_->show(picture);
        layers_.happen("capture");
        // The turn of the next picture was already waited for: the event is for the one after it.
        for (int i = 0; i < 3; ++i) stage_->show(picture);
        std::array<CapturedPicture, 2> seen;
        for (const auto& file : std::filesystem::directory_iterator(folder_.path())) {
            const std::string name = file.path().filename().string();
            if (name.ends_with("_view_0.ppm")) seen[0] = read_capture(file.path());
            if (name.ends_with("_view_1.ppm")) seen[1] = read_capture(file.path());
        }
        return seen;
    }

  private:
    TemporaryFolder folder_;
    ValidationLayers layers_;
    SimulatedClock clock_;
    std::optional<OpenXrStage> stage_;
};

TEST(OpenXrStage, TellsTheHeadsetsRateAndView) {
    StageUnderTest stage("");
    EXPECT_NEAR(stage->refresh_hz(), 70, 1e-4);
    EXPECT_EQ(stage->view().size, (SizePx{160, 180}));
    EXPECT_NEAR(stage->view().horizontal_fov_deg,
                2 * deg_from_rad(std::atan((tangent(kOuterDeg) + tangent(kInnerDeg)) / 2)), 1e-4);
}

TEST(OpenXrStage, BothEyesSeeTheCrossAtOnePlaceInSpace) {
    StageUnderTest stage("");
    Picture cross;
    cross.kind = PictureKind::fixation;
    const auto [left, right] = stage.capture(cross);
    ASSERT_EQ(left.size, (SizePx{160, 180}));
    const double width = tangent(kOuterDeg) + tangent(kInnerDeg);
    const double nearer = kHalfEyeDistance_m / kGazeDistance_m;
    EXPECT_NEAR(left.centroid().x, 160 * (tangent(kOuterDeg) + nearer) / width, 0.05);
    EXPECT_NEAR(right.centroid().x, 160 * (tangent(kInnerDeg) - nearer) / width, 0.05);
    EXPECT_NEAR(left.centroid().y, 90, 0.05);
    EXPECT_NEAR(right.centroid().y, 90, 0.05);
}

TEST(OpenXrStage, ATargetStandsInTheDirectionThatGazeIsMeasuredIn) {
    StageUnderTest stage("");
    const DirectionDeg direction{12, 8};
    Picture target;
    target.kind = PictureKind::target;
    target.fovea = stage->view().point_from_direction(direction);
    const auto [left, right] = stage.capture(target);
    const double width = tangent(kOuterDeg) + tangent(kInnerDeg);
    const double ahead = tangent(12), above = tangent(8) / std::cos(rad_from_deg(12));
    const double nearer = kHalfEyeDistance_m / kGazeDistance_m;
    EXPECT_NEAR(left.centroid().x, 160 * (tangent(kOuterDeg) + ahead + nearer) / width, 0.15);
    EXPECT_NEAR(right.centroid().x, 160 * (tangent(kInnerDeg) + ahead - nearer) / width, 0.15);
    EXPECT_NEAR(left.centroid().y, 90 - 160 / width * above, 0.15);
}

// What each eye sees is exactly what the renderer draws for its frustum, place and gaze point.
TEST(OpenXrStage, EachEyeSeesTheSceneFromItsOwnPlaceFoveatedAtItsOwnGaze) {
    StageUnderTest stage("");
    Picture stimulus;
    stimulus.kind = PictureKind::stimulus;
    stimulus.scene = "primitives";
    stimulus.method.method = "kfr";
    stimulus.method.numbers = {{"sigma", 2}, {"alpha", 4}};
    stimulus.fovea = stage->view().point_from_direction({-10, 5});
    const std::array<CapturedPicture, 2> seen = stage.capture(stimulus);

    Gpu gpu;
    const Scene scene = load_scene("primitives");
    FrameRenderer renderer(gpu, scene);
    for (int eye = 0; eye < 2; ++eye) {
        const double side = eye == 0 ? -1 : 1;
        const double left = tangent(eye == 0 ? kOuterDeg : kInnerDeg);
        const double width = tangent(kOuterDeg) + tangent(kInnerDeg);
        const double height = width * 180 / 160;
        CameraView view;
        view.world_from_eye = scene.cameras.front().world_from_camera *
                              glm::translate(glm::mat4(1), glm::vec3(side * kHalfEyeDistance_m, 0, 0));
        view.tan_left = static_cast<float>(left);
        view.tan_right = static_cast<float>(width - left);
        view.tan_up = view.tan_down = static_cast<float>(height / 2);
        view.near_m = scene.cameras.front().near_m;
        const double ahead = tangent(-10) - side * kHalfEyeDistance_m / kGazeDistance_m;
        const PointPx gaze{160 * (left + ahead) / width,
                           90 - 180 * (tangent(5) / std::cos(rad_from_deg(10))) / height};
        const RenderedFrame expected =
            renderer.render({160, 180}, view, {"kfr", {{"sigma", 2}, {"alpha", 4}}, {}}, gaze);
        int different = 0;
        for (int y = 0; y < 180; ++y)
            for (int x = 0; x < 160; ++x) {
                const std::size_t i = 4 * static_cast<std::size_t>(y * 160 + x);
                const auto colour = seen[static_cast<std::size_t>(eye)].at(x, y);
                for (std::size_t c = 0; c < 3; ++c)
                    different += std::abs(colour[c] - expected.image.rgba[i + c]) > 2;
            }
        // Frustums here come from tangents, in the headset from float angles: an edge may fall to the other
        // side.
        EXPECT_LT(different, 3 * 160 * 180 / 100) << "eye " << eye;
    }
    EXPECT_NE(seen[0].rgb, seen[1].rgb);
}

TEST(OpenXrStage, TheHashCoversBothEyesAndRepeats) {
    OpenXrStageOptions options;
    options.hash_pictures = true;
    StageUnderTest stage("", options);
    Picture stimulus;
    stimulus.kind = PictureKind::stimulus;
    stimulus.scene = "primitives";
    stimulus.method.method = "full";
    stimulus.fovea = {80, 90};
    const ShownFrame first = stage->show(stimulus), again = stage->show(stimulus);
    stimulus.method.method = "kfr";
    stimulus.method.numbers = {{"sigma", 3}};
    const ShownFrame other = stage->show(stimulus);
    ASSERT_TRUE(first.image_hash);
    EXPECT_EQ(first.image_hash, again.image_hash);
    EXPECT_NE(first.image_hash, other.image_hash);
    Picture page;
    EXPECT_FALSE(stage->show(page).image_hash);
}

TEST(OpenXrStage, ThePatchIsWhiteDuringAnIntervalAndBlackOtherwise) {
    StageUnderTest stage("");
    Picture picture;
    picture.kind = PictureKind::fixation;
    picture.patch = true;
    const auto [left, right] = stage.capture(picture);
    for (const CapturedPicture& eye : {left, right}) {
        EXPECT_EQ(eye.at(0, 179), (std::array{255, 255, 255}));
        EXPECT_EQ(eye.at(0, 150), (std::array{0, 0, 0}));
    }
}

TEST(OpenXrStage, EveryFrameFollowsTheOneBeforeByOneRefresh) {
    StageUnderTest stage("");
    Picture page;
    HostTime last = stage->show(page).display_time;
    for (int i = 1; i < 70; ++i) {
        const ShownFrame shown = stage->show(page);
        EXPECT_EQ(shown.index, i);
        EXPECT_EQ(shown.missed_vsyncs, 0);
        EXPECT_EQ(shown.fault, "");
        EXPECT_EQ(shown.time_source, TimeSource::predicted);
        EXPECT_NEAR((shown.display_time - last).ms(), 1000.0 / 70, 1e-5);
        last = shown.display_time;
    }
}

struct FaultCase {
    const char* script;
    std::vector<std::string> faults;  // of the frames that have one, in order
    int missed;                       // at least
};

// Named by its script in messages and by ctest.
void PrintTo(const FaultCase& fault, std::ostream* out) {
    *out << fault.script;
}

class OpenXrStageFault : public testing::TestWithParam<FaultCase> {};

// Each happens once among forty frames: it is told, every frame is shown, time goes on.
TEST_P(OpenXrStageFault, IsToldAndTheShowGoesOn) {
    StageUnderTest stage(GetParam().script);
    Picture page;
    page.kind = PictureKind::fixation;
    std::vector<std::string> faults;
    int missed = 0;
    HostTime last;
    for (int i = 0; i < 40; ++i) {
        const ShownFrame shown = stage->show(page);
        EXPECT_EQ(shown.index, i);
        EXPECT_GT(shown.display_time, last);
        last = shown.display_time;
        missed += shown.missed_vsyncs;
        if (!shown.fault.empty()) faults.push_back(shown.fault);
    }
    EXPECT_EQ(faults, GetParam().faults);
    EXPECT_GE(missed, GetParam().missed);
}

INSTANTIATE_TEST_SUITE_P(Each, OpenXrStageFault,
                         testing::Values(FaultCase{"negative_time@20", {"display_time_not_positive"}, 0},
                                         FaultCase{"backwards_time@20", {"display_time_backwards"}, 0},
                                         FaultCase{"late@20:3", {}, 3},
                                         FaultCase{"session_lost@20", {"session_lost"}, 1},
                                         FaultCase{"stopping@20", {"not_focused", "headset_off"}, 1},
                                         FaultCase{"hidden@20:5", {"not_focused", "not_visible"}, 1},
                                         FaultCase{"recentred@20", {"recentred"}, 0}),
                         [](const testing::TestParamInfo<FaultCase>& test) {
                             const std::string script = test.param.script;
                             return script.substr(0, script.find('@'));
                         });

TEST(OpenXrStage, QuittingInTheHeadsetEndsTheSessionInOneLine) {
    StageUnderTest stage("exiting@20");
    Picture page;
    try {
        for (int i = 0; i < 40; ++i) stage->show(page);
        FAIL() << "the user has quit";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("ended in the headset; start again with --resume"));
    }
}

}  // namespace
}  // namespace parafovea
