// Xbox pad decoders: golden vectors, every truncated length, unknown reports; the Linux input event decoder.
#include <gmock/gmock.h>

#include "devices/random.h"
#include "devices/xbox/evdev_decoder.h"
#include "devices/xbox/xbox_report.h"
#include "tests/devices/eye_tracker_descriptor.h"

namespace parafovea {
namespace {

using testing::ElementsAre;

std::vector<Button> pressed(const PadState& state) {
    std::vector<Button> buttons;
    for (int i = 0; i <= static_cast<int>(Button::right); ++i)
        if (state.pressed(static_cast<Button>(i))) buttons.push_back(static_cast<Button>(i));
    return buttons;
}

const auto kGolden360 = bytes_from_hex("00 14 11 10 40 ff e8 03 30 f8 ff 7f 00 80 00 00 00 00 00 00");
const auto kGoldenGip = bytes_from_hex("20 00 01 0e 10 10 00 02 ff 03 e8 03 30 f8 ff 7f 00 80");
const auto kGoldenBluetooth = bytes_from_hex("01 00 80 00 80 ff ff 00 00 00 02 ff 03 03 41 08 01");
const auto kGoldenOldBluetooth = bytes_from_hex("01 00 80 00 80 ff ff 00 00 00 02 ff 03 03 11 01");

TEST(Xbox360Report, TheGoldenReportDecodes) {
    const auto state = decode_xbox360(kGolden360);
    ASSERT_TRUE(state);
    EXPECT_THAT(pressed(*state), ElementsAre(Button::a, Button::menu, Button::up));
    EXPECT_THAT(state->sticks, ElementsAre(1000, -2000, 32767, -32768));
    EXPECT_THAT(state->triggers, ElementsAre(64, 255));
}

TEST(Xbox360Report, EveryTruncatedLengthAndOtherReportIsNothing) {
    for (std::size_t length = 0; length < kGolden360.size(); ++length)
        EXPECT_FALSE(decode_xbox360(std::span(kGolden360).first(length)));
    for (const std::uint8_t type : {0x01, 0x03, 0x08, 0xFF}) {
        auto other = kGolden360;
        other[0] = type;
        EXPECT_FALSE(decode_xbox360(other));
    }
}

TEST(Xbox360Report, EachButtonHasItsOwnBit) {
    std::vector<std::vector<Button>> seen;
    for (int bit = 0; bit < 16; ++bit) {
        std::vector<std::uint8_t> report(20);
        report[1] = 0x14;
        report[static_cast<std::size_t>(2 + bit / 8)] = static_cast<std::uint8_t>(1 << bit % 8);
        seen.push_back(pressed(*decode_xbox360(report)));
        EXPECT_LE(seen.back().size(), 1u);
    }
    // XINPUT's order: up, down, left, right, start, back, two sticks, shoulders, guide, unused, A, B, X, Y.
    EXPECT_THAT(
        seen,
        ElementsAre(ElementsAre(Button::up), ElementsAre(Button::down), ElementsAre(Button::left),
                    ElementsAre(Button::right), ElementsAre(Button::menu), ElementsAre(Button::view),
                    ElementsAre(), ElementsAre(), ElementsAre(Button::left_shoulder),
                    ElementsAre(Button::right_shoulder), ElementsAre(), ElementsAre(), ElementsAre(Button::a),
                    ElementsAre(Button::b), ElementsAre(Button::x), ElementsAre(Button::y)));
}

TEST(Gip, TheGoldenInputDecodes) {
    GipConnection gip;
    const auto received = gip.receive(kGoldenGip);
    ASSERT_EQ(received.states.size(), 1u);
    EXPECT_THAT(pressed(received.states[0]), ElementsAre(Button::a, Button::left_shoulder));
    EXPECT_THAT(received.states[0].sticks, ElementsAre(1000, -2000, 32767, -32768));
    EXPECT_THAT(received.states[0].triggers, ElementsAre(512, 1023));
    EXPECT_TRUE(received.replies.empty());
}

TEST(Gip, TheGuideButtonIsAcknowledgedWhenItAsks) {
    GipConnection gip;
    const auto received = gip.receive(bytes_from_hex("07 30 05 02 01 5b"));
    EXPECT_TRUE(received.states.empty());
    EXPECT_THAT(received.replies, ElementsAre(bytes_from_hex("01 20 05 09 00 07 20 02 00 00 00 00 00")));
}

TEST(Gip, AnAnnouncedPadIsStarted) {
    GipConnection gip;
    const auto first = gip.start();
    ASSERT_GE(first.size(), 1u);
    EXPECT_EQ(first[0], bytes_from_hex("05 20 01 01 00"));
    std::vector<std::uint8_t> announce = bytes_from_hex("02 20 01 1c");
    announce.resize(4 + 0x1c);
    const auto received = gip.receive(announce);
    EXPECT_TRUE(received.announced);
    ASSERT_EQ(received.replies.size(), first.size());
    EXPECT_EQ(received.replies[0], bytes_from_hex("05 20 04 01 00"));  // the sequence goes on
}

TEST(Gip, SeveralPacketsInOneTransferAreAllRead) {
    GipConnection gip;
    auto transfer = bytes_from_hex("07 30 05 02 01 5b");
    transfer.insert(transfer.end(), kGoldenGip.begin(), kGoldenGip.end());
    transfer.insert(transfer.end(), kGoldenGip.begin(), kGoldenGip.end());
    const auto received = gip.receive(transfer);
    EXPECT_EQ(received.states.size(), 2u);
    EXPECT_EQ(received.replies.size(), 1u);
}

TEST(Gip, ALengthPaddedToTwoBytesIsRead) {
    // 0x0e written as 8e 00.
    auto padded = bytes_from_hex("20 00 01 8e 00");
    padded.insert(padded.end(), kGoldenGip.begin() + 4, kGoldenGip.end());
    EXPECT_EQ(GipConnection().receive(padded).states.size(), 1u);
}

TEST(Gip, EveryTruncatedLengthIsNothing) {
    for (std::size_t length = 0; length < kGoldenGip.size(); ++length)
        EXPECT_TRUE(GipConnection().receive(std::span(kGoldenGip).first(length)).states.empty()) << length;
}

TEST(Gip, PacketsOfAccessoriesAndUnknownCommandsArePassedOver) {
    auto accessory = kGoldenGip;
    accessory[1] = 0x01;
    EXPECT_TRUE(GipConnection().receive(accessory).states.empty());
    for (int command = 0; command < 256; ++command) {
        auto other = kGoldenGip;
        other[0] = static_cast<std::uint8_t>(command);
        EXPECT_EQ(GipConnection().receive(other).states.size(), command == 0x20 ? 1u : 0u);
    }
}

TEST(Gip, SequenceNumbersAreNeverZero) {
    GipConnection gip;
    for (int i = 0; i < 300; ++i)
        for (const auto& message : gip.start()) EXPECT_NE(message[2], 0);
}

TEST(Gip, NoiseNeverCrashes) {
    Random random(3);
    GipConnection gip;
    for (int i = 0; i < 20000; ++i) {
        std::vector<std::uint8_t> noise(random.below(65));
        for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.next());
        gip.receive(noise);
    }
}

TEST(BluetoothReport, TheGoldenReportsOfBothLengthsDecode) {
    const auto state = decode_xbox_bluetooth(kGoldenBluetooth);
    ASSERT_TRUE(state);
    EXPECT_THAT(pressed(*state), ElementsAre(Button::a, Button::left_shoulder, Button::menu, Button::right));
    EXPECT_THAT(state->sticks,
                ElementsAre(0, -1, 32767, 32767));  // up is positive: the lowest value is all the way up
    EXPECT_THAT(state->triggers, ElementsAre(512, 1023));
    const auto old = decode_xbox_bluetooth(kGoldenOldBluetooth);
    ASSERT_TRUE(old);
    EXPECT_THAT(pressed(*old), ElementsAre(Button::a, Button::left_shoulder, Button::right));
}

TEST(BluetoothReport, OtherLengthsAndIdsAreNothing) {
    for (std::size_t length = 0; length < 40; ++length) {
        std::vector<std::uint8_t> report = kGoldenBluetooth;
        report.resize(length);
        EXPECT_EQ(decode_xbox_bluetooth(report).has_value(), length == 16 || length == 17);
    }
    auto other = kGoldenBluetooth;
    other[0] = 0x04;
    EXPECT_FALSE(decode_xbox_bluetooth(other));
}

TEST(BluetoothReport, TheOneSHasItsViewButtonInTheLastByte) {
    EXPECT_FALSE(decode_xbox_bluetooth(kGoldenBluetooth, 0x0b13)->pressed(Button::view));
    EXPECT_TRUE(decode_xbox_bluetooth(kGoldenBluetooth, 0x02fd)->pressed(Button::view));
}

TEST(BluetoothReport, TheHatPointsClockwise) {
    const std::vector<std::vector<Button>> expected = {{},
                                                       {Button::up},
                                                       {Button::up, Button::right},
                                                       {Button::right},
                                                       {Button::down, Button::right},
                                                       {Button::down},
                                                       {Button::down, Button::left},
                                                       {Button::left},
                                                       {Button::up, Button::left},
                                                       {}};
    for (std::size_t hat = 0; hat < expected.size(); ++hat) {
        auto report = kGoldenBluetooth;
        report[13] = static_cast<std::uint8_t>(hat);
        report[14] = report[15] = 0;
        EXPECT_EQ(pressed(*decode_xbox_bluetooth(report)), expected[hat]) << hat;
    }
}

TEST(PadState, ChangesBecomeEventsAndNothingElse) {
    PadState before, after;
    before.set(Button::a, true);
    before.set(Button::b, true);
    after.set(Button::b, true);
    after.set(Button::left_shoulder, true);
    after.sticks[0] = 999;
    std::vector<ControllerEvent> events;
    append_changes(before, after, {5}, {2}, events);
    ASSERT_EQ(events.size(), 2u);
    EXPECT_EQ(events[0].kind, ControllerEventKind::release);
    EXPECT_EQ(events[0].button, Button::a);
    EXPECT_EQ(events[1].kind, ControllerEventKind::press);
    EXPECT_EQ(events[1].button, Button::left_shoulder);
    EXPECT_EQ(events[1].time, HostTime{5});
    EXPECT_EQ(events[1].time_error, Duration{2});
}

input_event input(std::uint16_t type, std::uint16_t code, int value, double ms = 0) {
    input_event event{};
    event.input_event_sec = static_cast<std::int64_t>(ms / 1000);
    event.input_event_usec = static_cast<std::int64_t>(ms * 1000) % 1000000;
    event.type = type;
    event.code = code;
    event.value = value;
    return event;
}

TEST(Evdev, KeysAndHatBecomeButtonsWithTheKernelsTime) {
    EvdevDecoder decoder(Duration::from_ms(4));
    std::vector<ControllerEvent> events;
    EXPECT_TRUE(decoder.decode(input(EV_KEY, BTN_TL, 1, 1234.567), events));
    EXPECT_TRUE(decoder.decode(input(EV_KEY, BTN_TL, 2, 1300), events));  // the kernel's key repeat
    EXPECT_TRUE(decoder.decode(input(EV_ABS, ABS_HAT0X, -1, 1400), events));
    EXPECT_TRUE(decoder.decode(input(EV_ABS, ABS_HAT0X, 1, 1500), events));
    EXPECT_TRUE(decoder.decode(input(EV_ABS, ABS_X, 30000, 1550), events));
    EXPECT_TRUE(decoder.decode(input(EV_SYN, SYN_REPORT, 0, 1550), events));
    EXPECT_TRUE(decoder.decode(input(EV_KEY, BTN_TL, 0, 1600), events));
    ASSERT_EQ(events.size(), 5u);
    EXPECT_EQ(events[0].button, Button::left_shoulder);
    EXPECT_EQ(events[0].time.ns, 1'234'567'000);
    EXPECT_EQ(events[0].time_error, Duration::from_ms(4));
    EXPECT_EQ(events[1].button, Button::left);
    EXPECT_EQ(events[2].kind, ControllerEventKind::release);  // straight from left to right: left goes up
    EXPECT_EQ(events[3].button, Button::right);
    EXPECT_EQ(events[4].kind, ControllerEventKind::release);
}

TEST(Evdev, AfterDroppedEventsTheStateIsAskedForAgain) {
    EvdevDecoder decoder({});
    std::vector<ControllerEvent> events;
    decoder.decode(input(EV_KEY, BTN_A, 1), events);
    EXPECT_TRUE(decoder.decode(input(EV_SYN, SYN_DROPPED, 0), events));
    EXPECT_TRUE(
        decoder.decode(input(EV_KEY, BTN_B, 1), events));  // part of a broken packet: not to be trusted
    EXPECT_FALSE(decoder.decode(input(EV_SYN, SYN_REPORT, 0), events));
    EXPECT_EQ(events.size(), 1u);
    PadState now;
    now.set(Button::x, true);
    decoder.resynchronise(now, {7}, events);
    ASSERT_EQ(events.size(), 3u);  // A up, X down
    EXPECT_TRUE(decoder.decode(input(EV_KEY, BTN_X, 0), events));
    EXPECT_EQ(events.size(), 4u);
}

TEST(Evdev, KeysThatAreNoStudyButtonsMakeNoEvents) {
    EvdevDecoder decoder({});
    std::vector<ControllerEvent> events;
    for (const int code : {BTN_MODE, BTN_THUMBL, BTN_THUMBR, KEY_A, KEY_RECORD})
        decoder.decode(input(EV_KEY, static_cast<std::uint16_t>(code), 1), events);
    EXPECT_TRUE(events.empty());
}

}  // namespace
}  // namespace parafovea
