// The simulated pad: delivery by the clock, stated error, unplugging.
#include "devices/simulated/simulated_controller.h"

#include <gmock/gmock.h>

namespace parafovea {
namespace {

constexpr HostTime at_ms(double ms) {
    return HostTime{} + Duration::from_ms(ms);
}

std::vector<ControllerEvent> drained(SimulatedController& pad) {
    std::vector<ControllerEvent> events;
    pad.drain(events);
    return events;
}

TEST(SimulatedController, APressArrivesWhenTheClockHasPassedItAndOnlyOnce) {
    SimulatedClock clock;
    SimulatedController pad(clock, {.poll_interval = {}});
    pad.press(Button::left_shoulder, at_ms(500), Duration::from_ms(80));
    clock.wait_until(at_ms(499));
    EXPECT_TRUE(drained(pad).empty());
    clock.wait_until(at_ms(500));
    const auto press = drained(pad);
    ASSERT_EQ(press.size(), 1u);
    EXPECT_EQ(press[0].kind, ControllerEventKind::press);
    EXPECT_EQ(press[0].button, Button::left_shoulder);
    EXPECT_EQ(press[0].time, at_ms(500));
    EXPECT_TRUE(drained(pad).empty());
    clock.wait_until(at_ms(580));
    const auto release = drained(pad);
    ASSERT_EQ(release.size(), 1u);
    EXPECT_EQ(release[0].kind, ControllerEventKind::release);
}

TEST(SimulatedController, TheReportedTimeIsWithinItsStatedErrorOfTheTrueOne) {
    SimulatedClock clock;
    SimulatedController pad(clock);
    std::vector<HostTime> truth;
    for (int i = 0; i < 200; ++i) {
        truth.push_back(at_ms(100 + 137.731 * i));
        pad.press(Button::a, truth.back(), Duration::from_ms(30));
    }
    clock.wait_until(at_ms(1e6));
    std::size_t presses = 0;
    double error_sum_ms = 0;
    for (const ControllerEvent& event : drained(pad)) {
        if (event.kind != ControllerEventKind::press) continue;
        const Duration late = event.time - truth[presses++];
        EXPECT_GE(late.ns, 0);
        EXPECT_LE(late, event.time_error);
        error_sum_ms += late.ms();
    }
    ASSERT_EQ(presses, truth.size());
    EXPECT_NEAR(error_sum_ms / 200, 2, 0.3);  // half of the 4 ms interval
}

TEST(SimulatedController, EventsOfOverlappingPressesComeInTheOrderOfTime) {
    SimulatedClock clock;
    SimulatedController pad(clock);
    pad.press(Button::right_shoulder, at_ms(300), Duration::from_ms(1000));
    pad.press(Button::left_shoulder, at_ms(200), Duration::from_ms(300));
    clock.wait_until(at_ms(5000));
    const auto events = drained(pad);
    ASSERT_EQ(events.size(), 4u);
    for (std::size_t i = 1; i < events.size(); ++i) EXPECT_LE(events[i - 1].time, events[i].time);
    EXPECT_EQ(events[0].button, Button::left_shoulder);
    EXPECT_EQ(events[1].button, Button::right_shoulder);
    EXPECT_EQ(events[2].kind, ControllerEventKind::release);
    EXPECT_EQ(events[2].button, Button::left_shoulder);
}

TEST(SimulatedController, BothButtonsPressedTogetherAreBothReported) {
    SimulatedClock clock;
    SimulatedController pad(clock);
    pad.press(Button::left_shoulder, at_ms(200));
    pad.press(Button::right_shoulder, at_ms(200));
    clock.wait_until(at_ms(210));
    const auto events = drained(pad);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[0].time, events[1].time);
    EXPECT_NE(events[0].button, events[1].button);
}

TEST(SimulatedController, WhatHappensWhileThePadIsUnpluggedIsNotSeen) {
    SimulatedClock clock;
    SimulatedController pad(clock);
    pad.press(Button::a, at_ms(90), Duration::from_ms(100));  // held when the cable is pulled
    pad.disconnect(at_ms(100));
    pad.press(Button::b, at_ms(300));
    pad.connect(at_ms(1000));
    pad.press(Button::x, at_ms(1100), Duration::from_ms(10));
    clock.wait_until(at_ms(2000));
    std::vector<ControllerEventKind> kinds;
    for (const ControllerEvent& event : drained(pad)) kinds.push_back(event.kind);
    EXPECT_THAT(kinds, testing::ElementsAre(ControllerEventKind::press, ControllerEventKind::disconnected,
                                            ControllerEventKind::connected, ControllerEventKind::press,
                                            ControllerEventKind::release));
}

}  // namespace
}  // namespace parafovea
