// The FOVE source against a fake client library.
#include <gmock/gmock.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "devices/fove/fove_gaze.h"
#include "tests/message_of.h"

namespace parafovea {
namespace {

const FoveGazeSettings kFake{.library = PARAFOVEA_FAKE_FOVE};

std::string error_of(const FoveGazeSettings& settings) {
    return message_of([&] {
        SteadyClock clock;
        FoveGaze gaze(clock, settings);
    });
}

TEST(FoveGaze, DeliversEveryFrameWithItsStatusAndCountsDroppedOnes) {
    SteadyClock clock;
    FoveGaze gaze(clock, kFake);
    std::vector<GazeSample> samples;
    for (int i = 0; i < 2000 && samples.size() < 60; ++i) {
        gaze.drain(samples);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ASSERT_GE(samples.size(), 60u);
    int blinks = 0, low = 0, lost = 0, dropped = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const GazeSample& s = samples[i];
        const auto phase = s.sequence % 40;
        if (i > 0) dropped += static_cast<int>(s.sequence - samples[i - 1].sequence) - 1;
        blinks += s.status == GazeStatus::blink;
        low += s.status == GazeStatus::low_accuracy;
        lost += s.status == GazeStatus::lost;
        EXPECT_EQ(s.status == GazeStatus::blink, phase >= 20 && phase < 25);
        EXPECT_EQ(s.status == GazeStatus::lost, phase == 15);
        EXPECT_EQ(s.status == GazeStatus::low_accuracy, phase == 10);
        EXPECT_EQ(s.direction.has_value(),
                  s.status == GazeStatus::tracked || s.status == GazeStatus::low_accuracy);
        EXPECT_NEAR(s.direction.value_or(DirectionDeg{30, 0}).azimuth_deg, 30, 1e-4);
        EXPECT_NEAR(*s.left->pupil_mm, 4.0, 1e-4);
        EXPECT_NEAR(*s.right->pupil_mm, 4.2, 1e-4);
        EXPECT_LT(s.host_time, s.arrival_time);
        EXPECT_GE(s.host_time_error, kFake.latency_error);
    }
    EXPECT_GT(blinks, 0);
    EXPECT_GT(low, 0);
    EXPECT_GT(lost, 0);
    EXPECT_GT(dropped, 0);
    EXPECT_TRUE(gaze.connected());
    EXPECT_THAT(gaze.description(), testing::HasSubstr("client 1.4.0, service 1.4.2, firmware 30"));
}

TEST(FoveGaze, StartsTheHeadsetsOwnCalibration) {
    SteadyClock clock;
    FoveGaze gaze(clock, kFake);
    EXPECT_EQ(gaze.calibration(), FoveCalibration::not_started);
    gaze.start_calibration();
    for (int i = 0; i < 2000 && gaze.calibration() != FoveCalibration::succeeded; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(gaze.calibration(), FoveCalibration::succeeded);
}

TEST(FoveGaze, AnAbsentLibraryIsNotInstalled) {
    EXPECT_THAT(error_of({.library = "libNoSuchFove.so"}), testing::HasSubstr("not installed"));
    EXPECT_FALSE(fove_library_installed("libNoSuchFove.so"));
    EXPECT_TRUE(fove_library_installed(kFake.library));
}

TEST(FoveGaze, AnUnknownMajorVersionIsRefused) {
    setenv("FAKE_FOVE_MAJOR", "2", 1);
    EXPECT_THAT(error_of(kFake), testing::HasSubstr("version 2.4"));
    unsetenv("FAKE_FOVE_MAJOR");
}

TEST(FoveGaze, AServiceThatDoesNotRunIsSaidSo) {
    setenv("FAKE_FOVE_SERVICE", "off", 1);
    EXPECT_THAT(error_of(kFake), testing::HasSubstr("start the FOVE service"));
    unsetenv("FAKE_FOVE_SERVICE");
}

TEST(FoveGaze, ALibraryWithoutTheCallsIsRefused) {
    EXPECT_THAT(error_of({.library = "libm.so.6"}), testing::HasSubstr("has no fove_createHeadset"));
}

}  // namespace
}  // namespace parafovea
