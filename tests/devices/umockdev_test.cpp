// hidapi and libusb sources against fake hardware, plugged, pulled and plugged in again. Runs under
// umockdev-wrapper.
#include <gmock/gmock.h>
#include <linux/input.h>

#include <chrono>
#include <cstring>
#include <functional>
#include <thread>

#include "devices/hid/hid_gaze.h"
#include "devices/xbox/bluetooth_pad.h"
#include "devices/xbox/evdev_controller.h"
#include "devices/xbox/usb_pad.h"
#include "tests/devices/eye_tracker_descriptor.h"
#include "tests/devices/fake_hardware.h"

namespace parafovea {
namespace {

using testing::ElementsAre;
using testing::Pair;

// Waits for something that must happen, for at most 10 s.
bool eventually(const std::function<bool()>& happened) {
    for (int i = 0; i < 2000; ++i) {
        if (happened()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return false;
}

class FakeHardware : public testing::Test {
  protected:
    void SetUp() override {
        testbed_.reset(umockdev_testbed_new());
        if (!umockdev_in_mock_environment()) GTEST_SKIP() << "not under umockdev-wrapper";
    }

    Testbed testbed_;
    SteadyClock clock_;
};

class FakeTracker : public FakeHardware {
  protected:
    void SetUp() override {
        FakeHardware::SetUp();
        if (IsSkipped()) return;
        tracker_ =
            std::make_unique<FakeHidDevice>(testbed_.get(), 3, 0xdeed, 0xfeed, eye_tracker_descriptor());
        tracker_->features = {bytes_from_hex("12 ac 10 c5 a0 78 56 34 12 15 20 a0 df 07 00 d0 6c 04 00"),
                              bytes_from_hex("13 01 78 00")};
        tracker_->plug();
    }
    void TearDown() override { tracker_.reset(); }

    // n reports at 120 Hz from the given device time on.
    void stream(int n, std::uint64_t from_us) {
        auto next = std::chrono::steady_clock::now();
        for (int i = 0; i < n; ++i) {
            auto report = golden_gaze_report();
            const std::uint64_t us = from_us + static_cast<std::uint64_t>(i) * 8333;
            std::memcpy(&report[1], &us, 8);
            tracker_->send(report);
            next += std::chrono::microseconds(8333);
            std::this_thread::sleep_until(next);
        }
    }

    std::unique_ptr<FakeHidDevice> tracker_;
};

TEST_F(FakeTracker, IsFoundAskedForDataAndReadAt120Hz) {
    ASSERT_EQ(list_hid_eye_trackers().size(), 1u);
    EXPECT_TRUE(list_hid_eye_trackers()[0].readable);
    {
        HidGaze gaze(clock_);
        EXPECT_THAT(gaze.description(), testing::HasSubstr("120 Hz, screen 0.516 x 0.29 m"));
        stream(60, 1'000'000);
        std::vector<GazeSample> samples;
        ASSERT_TRUE(eventually([&] { return gaze.drain(samples), samples.size() >= 60; }));
        ASSERT_EQ(samples.size(), 60u);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            EXPECT_EQ(samples[i].sequence, static_cast<std::int64_t>(i));
            EXPECT_EQ(samples[i].device_time.ns, 1'000'000'000 + static_cast<std::int64_t>(i) * 8'333'000);
            ASSERT_TRUE(samples[i].direction);
            EXPECT_NEAR(samples[i].direction->azimuth_deg, 0,
                        1e-9);  // the golden report looks at the screen's centre
            EXPECT_LT(samples[i].host_time, samples[i].arrival_time);
        }
        EXPECT_NEAR((samples[59].host_time - samples[10].host_time).ms(), 49 * 8.333, 5);
        EXPECT_THAT(tracker_->set_reports(), ElementsAre(ElementsAre(0x14, 0x03)));
    }
    EXPECT_THAT(tracker_->set_reports(), ElementsAre(ElementsAre(0x14, 0x03), ElementsAre(0x14, 0x00)));
}

TEST_F(FakeTracker, UnpluggedAndPluggedInAgainGoesOn) {
    HidGaze gaze(clock_, {.search_interval = Duration::from_ms(20)});
    stream(10, 1'000'000);
    std::vector<GazeSample> samples;
    ASSERT_TRUE(eventually([&] { return gaze.drain(samples), samples.size() == 10; }));
    tracker_->unplug();
    ASSERT_TRUE(eventually([&] { return !gaze.connected(); }));
    gaze.drain(samples);
    EXPECT_EQ(samples.size(), 10u);
    tracker_->plug();
    ASSERT_TRUE(eventually([&] { return gaze.connected(); }));
    stream(10, 5'000);  // its clock has begun again
    ASSERT_TRUE(eventually([&] { return gaze.drain(samples), samples.size() == 20; }));
    for (std::size_t i = 1; i < 20; ++i) EXPECT_EQ(samples[i].sequence, samples[i - 1].sequence + 1);
    EXPECT_LE(samples[19].host_time, samples[19].arrival_time);
    EXPECT_GT(samples[19].host_time, samples[9].arrival_time);
}

TEST_F(FakeHardware, WithoutDevicesEverySourceSaysSo) {
    EXPECT_THROW(HidGaze{clock_}, std::runtime_error);
    EXPECT_THROW(BluetoothPad{clock_}, std::runtime_error);
    EXPECT_THROW(EvdevController{clock_}, std::runtime_error);
    EXPECT_THROW(UsbPad{clock_}, std::runtime_error);
}

std::vector<std::pair<ControllerEventKind, Button>> kinds(const std::vector<ControllerEvent>& events) {
    std::vector<std::pair<ControllerEventKind, Button>> result;
    for (const ControllerEvent& event : events) result.emplace_back(event.kind, event.button);
    return result;
}

Bytes xbox360_report(std::uint8_t low, std::uint8_t high) {
    Bytes report(20);
    report[1] = 0x14;
    report[2] = low;
    report[3] = high;
    return report;
}

TEST_F(FakeHardware, AnXbox360PadIsReadAndTheKernelsDriverHandedBack) {
    FakeUsbPad fake(testbed_.get(), 0x045e, 0x028e, 0x5D, 0x01);
    fake.plug();
    ASSERT_EQ(list_usb_pads().size(), 1u);
    {
        UsbPad pad(clock_);
        EXPECT_EQ(fake.detached(), 1);
        EXPECT_EQ(fake.handed_back(), 0);
        const HostTime before = clock_.now();
        fake.send(xbox360_report(0, 0x01));
        fake.send(xbox360_report(0, 0x03));
        fake.send(xbox360_report(0, 0x00));
        std::vector<ControllerEvent> events;
        ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() >= 4; }));
        EXPECT_THAT(kinds(events), ElementsAre(Pair(ControllerEventKind::press, Button::left_shoulder),
                                               Pair(ControllerEventKind::press, Button::right_shoulder),
                                               Pair(ControllerEventKind::release, Button::left_shoulder),
                                               Pair(ControllerEventKind::release, Button::right_shoulder)));
        for (const ControllerEvent& event : events) {
            EXPECT_GE(event.time, before);
            EXPECT_LE(event.time, clock_.now());
            EXPECT_EQ(event.time_error, Duration::from_ms(4));
        }
    }
    EXPECT_EQ(fake.handed_back(), 1);
}

TEST_F(FakeHardware, AnXbox360PadPulledMidTrialAndPluggedInAgainIsReportedAndReadOn) {
    FakeUsbPad fake(testbed_.get(), 0x045e, 0x028e, 0x5D, 0x01);
    fake.plug();
    UsbPad pad(clock_, Duration::from_ms(20));
    fake.send(xbox360_report(0, 0x10));
    std::vector<ControllerEvent> events;
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 1; }));
    fake.unplug();
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 2; }));
    EXPECT_FALSE(pad.connected());
    fake.plug();
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 3; }));
    fake.send(xbox360_report(0, 0x20));
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 4; }));
    EXPECT_THAT(kinds(events), ElementsAre(Pair(ControllerEventKind::press, Button::a),
                                           Pair(ControllerEventKind::disconnected, testing::_),
                                           Pair(ControllerEventKind::connected, testing::_),
                                           Pair(ControllerEventKind::press, Button::b)));
}

TEST_F(FakeHardware, AGipPadIsStartedAcknowledgedAndRead) {
    FakeUsbPad fake(testbed_.get(), 0x045e, 0x02ea, 0x47, 0xD0);
    fake.plug();
    UsbPad pad(clock_);
    ASSERT_TRUE(eventually([&] { return fake.received().size() >= 3; }));
    EXPECT_EQ(fake.received()[0], bytes_from_hex("05 20 01 01 00"));
    fake.send(bytes_from_hex("07 30 05 02 01 5b"));
    ASSERT_TRUE(eventually([&] { return fake.received().size() >= 4; }));
    EXPECT_EQ(fake.received()[3], bytes_from_hex("01 20 05 09 00 07 20 02 00 00 00 00 00"));
    // The first report only tells where the buttons are; the second presses A and LB.
    fake.send(bytes_from_hex("20 00 01 0e 00 00 00 00 00 00 00 00 00 00 00 00 00 00"));
    fake.send(bytes_from_hex("20 00 02 0e 10 10 00 02 ff 03 e8 03 30 f8 ff 7f 00 80"));
    std::vector<ControllerEvent> events;
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() >= 2; }));
    EXPECT_THAT(kinds(events), ElementsAre(Pair(ControllerEventKind::press, Button::a),
                                           Pair(ControllerEventKind::press, Button::left_shoulder)));
}

TEST_F(FakeHardware, APadOfTheKernelsDriverIsReadWithItsOwnStampsPulledAndReadOn) {
    FakeInputDevice fake(testbed_.get());
    fake.held = {BTN_A};  // down from before: nobody's answer
    fake.plug();
    ASSERT_EQ(list_evdev_pads().size(), 1u);
    EXPECT_EQ(list_evdev_pads()[0].product, 0x028e);
    EvdevController pad(clock_, Duration::from_ms(20));
    EXPECT_EQ(fake.clock_asked(), CLOCK_MONOTONIC);
    EXPECT_THAT(pad.description(), testing::HasSubstr("Fake X-Box 360 pad"));
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    fake.send(EV_KEY, BTN_TL, 1, 77'123'456'000);
    fake.send(EV_KEY, BTN_TL, 0, 77'223'456'000);
    fake.send(EV_ABS, ABS_HAT0X, 1, 77'300'000'000);
    std::vector<ControllerEvent> events;
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 3; }));
    EXPECT_EQ(events[0].time.ns, 77'123'456'000);
    EXPECT_EQ(events[0].time_error, Duration::from_ms(4));
    fake.unplug();
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 4; }));
    fake.held.clear();
    fake.plug();
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 5; }));
    fake.send(EV_KEY, BTN_TR, 1, 88'000'000'000);
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 6; }));
    EXPECT_THAT(kinds(events), ElementsAre(Pair(ControllerEventKind::press, Button::left_shoulder),
                                           Pair(ControllerEventKind::release, Button::left_shoulder),
                                           Pair(ControllerEventKind::press, Button::right),
                                           Pair(ControllerEventKind::disconnected, testing::_),
                                           Pair(ControllerEventKind::connected, testing::_),
                                           Pair(ControllerEventKind::press, Button::right_shoulder)));
}

TEST_F(FakeHardware, ABluetoothPadIsReadPulledAndReadOn) {
    FakeHidDevice fake(testbed_.get(), 5, 0x045e, 0x0b13,
                       bytes_from_hex("05 01 09 05 A1 01 85 01 75 08 95 10 15 00 26 FF 00 09 30 81 02 C0"));
    fake.plug();
    BluetoothPad pad(clock_, Duration::from_ms(20));
    const auto report = [](std::uint8_t buttons) {
        auto bytes = bytes_from_hex("01 00 80 00 80 00 80 00 80 00 00 00 00 00 00 00 00");
        bytes[14] = buttons;
        return bytes;
    };
    fake.send(report(0x40));
    std::vector<ControllerEvent> events;
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 1; }));
    fake.send(report(0x00));
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 2; }));
    fake.unplug();
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 3; }));
    fake.plug();
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 4; }));
    fake.send(report(0x80));
    ASSERT_TRUE(eventually([&] { return pad.drain(events), events.size() == 5; }));
    EXPECT_THAT(kinds(events), ElementsAre(Pair(ControllerEventKind::press, Button::left_shoulder),
                                           Pair(ControllerEventKind::release, Button::left_shoulder),
                                           Pair(ControllerEventKind::disconnected, testing::_),
                                           Pair(ControllerEventKind::connected, testing::_),
                                           Pair(ControllerEventKind::press, Button::right_shoulder)));
}

}  // namespace
}  // namespace parafovea
