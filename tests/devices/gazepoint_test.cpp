// The Open Gaze decoder, and the socket source against a tracker's server of our own on the loopback.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "devices/gazepoint/gazepoint_gaze.h"
#include "tests/devices/fake_gazepoint.h"

namespace parafovea {
namespace {

const std::string kRecord =
    "<REC CNT=\"34\" TIME=\"1.23456\" BPOGX=\"0.75000\" BPOGY=\"0.50000\" BPOGV=\"1\" LPOGX=\"0.70000\" "
    "LPOGY=\"0.40000\" "
    "LPOGV=\"1\" RPOGX=\"0.80000\" RPOGY=\"0.60000\" RPOGV=\"0\" LPUPILD=\"0.00352\" LPUPILV=\"1\" "
    "RPUPILD=\"0.00340\" "
    "RPUPILV=\"0\" />";

TEST(OpenGazeMessage, ARecordGivesItsValuesAndRespectsValidity) {
    const auto record = decode_open_gaze_record(*parse_open_gaze(kRecord));
    ASSERT_TRUE(record);
    EXPECT_EQ(record->count, 34);
    EXPECT_EQ(record->time_s, 1.23456);
    EXPECT_EQ(record->best->x, 0.75);
    EXPECT_EQ(record->left->y, 0.4);
    EXPECT_FALSE(record->right);
    EXPECT_NEAR(*record->left_pupil_mm, 3.52, 1e-9);
    EXPECT_FALSE(record->right_pupil_mm);
}

TEST(OpenGazeMessage, EveryTruncatedLengthIsNoMessage) {
    for (std::size_t length = 0; length < kRecord.size(); ++length)
        EXPECT_FALSE(parse_open_gaze(std::string_view(kRecord).substr(0, length))) << length;
}

TEST(OpenGazeMessage, OtherMessagesAreReadButAreNoRecords) {
    const auto ack = parse_open_gaze("<ACK ID=\"SCREEN_SIZE\" X=\"0\" WIDTH=\"1920\" />");
    ASSERT_TRUE(ack);
    EXPECT_EQ(ack->name, "ACK");
    EXPECT_EQ(ack->text("ID"), "SCREEN_SIZE");
    EXPECT_EQ(ack->number("WIDTH"), 1920);
    EXPECT_FALSE(ack->number("ID"));
    EXPECT_FALSE(ack->number("HEIGHT"));
    EXPECT_FALSE(decode_open_gaze_record(*ack));
    for (const char* nonsense :
         {"", "REC", "<", "<>", "< />", "<REC CNT=1 />", "<REC CNT=\"1\" /> more", "<REC><X/></REC>"})
        EXPECT_FALSE(parse_open_gaze(nonsense)) << nonsense;
}

TEST(OpenGazeMessage, NumbersThatAreNoneAreAbsent) {
    const auto record = decode_open_gaze_record(*parse_open_gaze(
        "<REC CNT=\"1e300\" TIME=\"nan\" BPOGX=\"inf\" BPOGY=\"0\" BPOGV=\"1\" LPOGX=\"\" />"));
    ASSERT_TRUE(record);
    EXPECT_FALSE(record->count);
    EXPECT_FALSE(record->time_s);
    EXPECT_FALSE(record->best);
}

TEST(LineSplitter, LinesComeWholeHoweverTheBytesAreCut) {
    const std::string text = "one\r\ntwo\n\r\nthree\r\npart";
    for (std::size_t cut = 0; cut <= text.size(); ++cut) {
        LineSplitter splitter;
        auto lines = splitter.feed(std::string_view(text).substr(0, cut));
        for (std::string& line : splitter.feed(std::string_view(text).substr(cut))) lines.push_back(line);
        EXPECT_THAT(lines, testing::ElementsAre("one", "two", "", "three"));
    }
}

TEST(LineSplitter, AnEndlessLineIsThrownAwayAndTheNextIsRead) {
    LineSplitter splitter;
    EXPECT_TRUE(splitter.feed(std::string(200000, 'x')).empty());
    EXPECT_THAT(splitter.feed("tail\nnext\n"), testing::ElementsAre("next"));
}

// Drains until there are n samples or 10 s have passed.
std::vector<GazeSample> collect(GazeSource& source, std::size_t n) {
    std::vector<GazeSample> samples;
    for (int i = 0; i < 2000 && samples.size() < n; ++i) {
        source.drain(samples);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return samples;
}

TEST(GazepointGaze, ReadsAStreamWithDirectionsOrderAndTimes) {
    FakeGazepoint tracker;
    SteadyClock clock;
    GazepointSettings settings;
    settings.port = tracker.port();
    settings.screen_width_m = 0.4;
    settings.screen_height_m = 0.4;
    settings.screen_distance_m = 0.1;
    GazepointGaze gaze(clock, settings);
    const auto samples = collect(gaze, 30);
    ASSERT_GE(samples.size(), 30u);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_EQ(samples[i].sequence, static_cast<std::int64_t>(i));
        EXPECT_EQ(samples[i].direction.has_value(), i % 10 != 9);
        EXPECT_EQ(samples[i].status, i % 10 != 9 ? GazeStatus::tracked : GazeStatus::lost);
        EXPECT_LT(samples[i].host_time, samples[i].arrival_time);
        EXPECT_GE(samples[i].device_time.ns, 100'000'000'000);
        EXPECT_LE(samples[i].arrival_time, clock.now());
    }
    EXPECT_NEAR(samples[0].direction->azimuth_deg, 45, 1e-9);
    EXPECT_GT(samples[0].direction->elevation_deg, 0);
}

TEST(GazepointGaze, ABrokenConnectionIsMadeAgain) {
    FakeGazepoint tracker;
    SteadyClock clock;
    GazepointSettings settings;
    settings.port = tracker.port();
    settings.retry_interval = Duration::from_ms(20);
    GazepointGaze gaze(clock, settings);
    ASSERT_GE(collect(gaze, 5).size(), 5u);
    tracker.hang_up();
    for (int i = 0; i < 2000 && tracker.connections() < 2; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(tracker.connections(), 2);
    EXPECT_GE(collect(gaze, 5).size(), 5u);
}

TEST(GazepointGaze, NobodyThereIsSaidSoWithTheAddress) {
    SteadyClock clock;
    GazepointSettings settings;
    settings.port = 1;
    try {
        GazepointGaze gaze(clock, settings);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("127.0.0.1:1"));
    }
}

}  // namespace
}  // namespace parafovea
