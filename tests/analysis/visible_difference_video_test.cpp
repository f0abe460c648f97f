// The visible difference of videos: against the published metric's own answers, and how it must behave.
#include "analysis/visible_difference_video.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "tests/analysis/visible_difference_pictures.h"

namespace parafovea {
namespace {

constexpr int kWidth = 96, kHeight = 80, kFrames = 10;
constexpr GazePx kCentre{48, 40}, kOutside{300, 40};

using Video = std::function<GreyPicture(int)>;

// Moved to the right by whole pixels; what leaves on the right comes back on the left.
GreyPicture shifted(const GreyPicture& in, int by) {
    GreyPicture out = in;
    for (int y = 0; y < in.height; ++y)
        for (int x = 0; x < in.width; ++x)
            out.code[static_cast<std::size_t>(y) * in.width + (x + by) % in.width] = in.at(x, y);
    return out;
}

double jod(const Video& test, const Video& reference, double fov_deg, double fps, GazePx gaze,
           double peak_cd_m2 = 100, int frames = kFrames) {
    VideoVisibleDifference video({kWidth, kHeight, fov_deg, peak_cd_m2, 1000, 0}, fps);
    for (int i = 0; i < frames; ++i) video.add_frame(rgba_from(test(i)), rgba_from(reference(i)), gaze);
    EXPECT_EQ(video.frames(), static_cast<std::size_t>(frames));
    return video.jod();
}

const GreyPicture kFlat = flat_picture(kWidth, kHeight, 188), kTexture = textured_picture(kWidth, kHeight);

GreyPicture flat(int) {
    return kFlat;
}
GreyPicture flicker(int i) {
    return with_noise(kFlat, 2, 5, static_cast<std::uint32_t>(i));
}
GreyPicture slow_flicker(int i) {
    return with_noise(kFlat, 4, 5, static_cast<std::uint32_t>(i / 3));
}
GreyPicture moving(int i) {
    return shifted(kTexture, 2 * i);
}
GreyPicture moving_blurred(int i) {
    return box_blurred(moving(i));
}
GreyPicture still(int) {
    return kTexture;
}
GreyPicture still_noisy(int) {
    return with_noise(kTexture, 2, 6, 5);
}
GreyPicture creeping(int i) {
    return shifted(kTexture, i);
}
GreyPicture creeping_noisy(int i) {
    return with_noise(creeping(i), 1, 6, static_cast<std::uint32_t>(i));
}

// Answers of the authors' FovVideoVDP 1.2.3 (foveated, sRGB, contrast 1000) to the same ten frames of 96x80
// pixels.
TEST(VideoVisibleDifference, AgreesWithTheAuthorsProgramToATenthOfAJod) {
    struct Row {
        const char* what;
        Video test, reference;
        double fov_deg, fps;
        GazePx gaze;
        double jod;
        double peak_cd_m2 = 100;
    };
    const Row rows[] = {
        {"flicker", flicker, flat, 10, 30, kCentre, 7.871},
        {"flicker", flicker, flat, 10, 30, kOutside, 9.287},
        {"slow flicker", slow_flicker, flat, 10, 30, kCentre, 6.593},
        {"moving blur", moving_blurred, moving, 10, 30, kCentre, 8.546},
        {"still noise", still_noisy, still, 10, 30, kCentre, 9.094},
        {"noise on motion", creeping_noisy, creeping, 10, 30, kCentre, 9.389},
        {"flicker", flicker, flat, 40, 60, kCentre, 7.678},
        {"flicker", flicker, flat, 40, 60, kOutside, 8.699},
        {"slow flicker", slow_flicker, flat, 40, 60, kOutside, 8.066},
        {"moving blur", moving_blurred, moving, 40, 60, kCentre, 7.039},
        {"moving blur", moving_blurred, moving, 40, 60, kOutside, 8.536},
        {"noise on motion", creeping_noisy, creeping, 40, 60, kOutside, 9.566},
        {"flicker", flicker, flat, 40, 90, kCentre, 7.539},
        {"slow flicker", slow_flicker, flat, 40, 90, kOutside, 8.049},
        {"moving blur", moving_blurred, moving, 40, 90, kCentre, 6.927},
        {"still noise", still_noisy, still, 40, 90, kOutside, 9.251},
        {"moving blur", moving_blurred, moving, 40, 60, kCentre, 7.295, 20},
        {"flicker", flicker, flat, 40, 60, kCentre, 8.235, 4},
    };
    for (const Row& row : rows)
        EXPECT_NEAR(jod(row.test, row.reference, row.fov_deg, row.fps, row.gaze, row.peak_cd_m2), row.jod,
                    0.1)
            << row.what << ", " << row.fps << " Hz, " << row.fov_deg << " deg, gaze " << row.gaze.x;
}

TEST(VideoVisibleDifference, EqualVideosScoreExactlyTen) {
    EXPECT_EQ(jod(moving, moving, 40, 60, kCentre), 10);
    EXPECT_EQ(jod(flicker, flicker, 40, 60, kCentre), 10);
}

TEST(VideoVisibleDifference, AStillVideoIsJudgedAsAStillPicture) {
    const DisplayModel display{kWidth, kHeight, 20, 100, 1000, 0};
    const double picture =
        compare(decompose(rgba_from(still_noisy(0)), rgba_from(still(0)), display), kCentre).jod;
    // Constant but for the transient filter's truncated tail.
    EXPECT_NEAR(jod(still_noisy, still, 20, 60, kCentre), picture, 0.02);
}

TEST(VideoVisibleDifference, CoarseNoiseIsMoreVisibleWhenItFlickers) {
    const auto held = [](int) { return slow_flicker(0); };
    for (const GazePx gaze : {kCentre, kOutside})
        EXPECT_LT(jod(slow_flicker, flat, 20, 30, gaze), jod(held, flat, 20, 30, gaze));
}

TEST(VideoVisibleDifference, GrowsWithTheAmplitudeOfFlicker) {
    double before = 10;
    for (const int amplitude : {1, 2, 4, 8}) {
        const auto noisy = [&](int i) {
            return with_noise(kTexture, 2, amplitude, static_cast<std::uint32_t>(i));
        };
        const double now = jod(noisy, still, 20, 60, kCentre, 100, 6);
        EXPECT_LT(now, before) << amplitude;
        before = now;
    }
}

TEST(VideoVisibleDifference, ForgetsAFlashAfterAQuarterOfASecond) {
    VideoVisibleDifference video({kWidth, kHeight, 20, 100, 1000, 0}, 30);
    double q = 0;
    for (int i = 0; i < 12; ++i) {
        const bool flash = i == 1;
        q = video.add_frame(rgba_from(flash ? flicker(3) : kFlat), rgba_from(kFlat), kCentre).q;
        if (i == 0) {
            EXPECT_EQ(q, 0);
        }
        if (i >= 2 && i < 8) {
            EXPECT_GT(q, 0) << i;
        }
    }
    EXPECT_EQ(q, 0);
}

TEST(VideoVisibleDifference, TheGazeOfEachFrameCounts) {
    VideoVisibleDifference video({kWidth, kHeight, 60, 100, 1000, 0}, 30);
    const double at_centre = video.add_frame(rgba_from(still_noisy(0)), rgba_from(still(0)), kCentre).q;
    const double away = video.add_frame(rgba_from(still_noisy(0)), rgba_from(still(0)), {2000, 0}).q;
    const double back = video.add_frame(rgba_from(still_noisy(0)), rgba_from(still(0)), kCentre).q;
    EXPECT_LT(away, at_centre);
    EXPECT_NEAR(back, at_centre, 1e-5 * at_centre);
    EXPECT_NEAR(video.q(), (at_centre + away + back) / 3, 1e-9);
}

TEST(VideoVisibleDifference, WithoutAFrameThereIsNoDifference) {
    const VideoVisibleDifference video({kWidth, kHeight, 60, 100, 1000, 0}, 30);
    EXPECT_EQ(video.q(), 0);
    EXPECT_EQ(video.jod(), 10);
}

TEST(TemporalFilters, SustainedSumsToOneAndTransientIsItsDerivative) {
    for (const double fps : {24.0, 70.0, 90.0, 120.0}) {
        const TemporalFilters f = temporal_filters(fps);
        EXPECT_EQ(f.sustained.size(), static_cast<std::size_t>(std::ceil(0.25 * fps)));
        EXPECT_EQ(f.transient.size(), f.sustained.size());
        EXPECT_NEAR(std::accumulate(f.sustained.begin(), f.sustained.end(), 0.0), 1, 1e-12);
        // Steps of the response per second, in the published unit: summed up they give the response back.
        const auto taps = static_cast<double>(f.sustained.size());
        const double step_s = taps / (taps - 1) / fps;
        double risen = f.sustained.front();
        for (std::size_t k = 0; k + 1 < f.sustained.size(); ++k) {
            risen += f.transient[k] * step_s / 0.062170507756932;
            EXPECT_NEAR(risen, f.sustained[k + 1], 1e-12);
        }
        const auto peak = std::max_element(f.sustained.begin(), f.sustained.end()) - f.sustained.begin();
        EXPECT_NEAR(static_cast<double>(peak) / fps, 0.06, 1 / fps);
    }
    EXPECT_THROW(temporal_filters(0), std::runtime_error);
    EXPECT_THROW(temporal_filters(std::nan("")), std::runtime_error);
    EXPECT_EQ(temporal_filters(1).sustained.size(), 1u);
}

}  // namespace
}  // namespace parafovea
