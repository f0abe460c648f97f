// The descriptor parser with every oddity seen in the wild, and the eye-tracker reports against golden
// vectors.
#include <gmock/gmock.h>

#include <cstring>

#include "devices/hid/eye_tracker_report.h"
#include "devices/random.h"
#include "tests/devices/eye_tracker_descriptor.h"

namespace parafovea {
namespace {

EyeTrackerLayout reference_layout() {
    return EyeTrackerLayout(parse_report_descriptor(eye_tracker_descriptor()));
}

const HidField& field_of(const HidReportDescriptor& d, std::uint16_t usage) {
    for (const HidField& field : d.fields)
        if (field.usage == hid_usage(kEyeTrackerPage, usage)) return field;
    throw std::runtime_error("no such field");
}

TEST(ReportDescriptor, TheReferenceDeviceHasItsReportsInTheirSizes) {
    const auto bytes = eye_tracker_descriptor();
    EXPECT_EQ(bytes.size(), 366u);
    const HidReportDescriptor d = parse_report_descriptor(bytes);
    EXPECT_TRUE(d.has_report_ids);
    EXPECT_EQ(d.report(HidReportKind::input, 0x10)->body_bytes(), 64u);
    EXPECT_EQ(d.report(HidReportKind::feature, 0x11)->body_bytes(), 21u);
    EXPECT_EQ(d.report(HidReportKind::feature, 0x12)->body_bytes(), 18u);
    EXPECT_EQ(d.report(HidReportKind::feature, 0x13)->body_bytes(), 3u);
    EXPECT_EQ(d.report(HidReportKind::input, 0x13)->body_bytes(), 3u);
    EXPECT_EQ(d.report(HidReportKind::feature, 0x14)->body_bytes(), 1u);
    EXPECT_EQ(d.report(HidReportKind::output, 0x10), nullptr);
    EXPECT_EQ(d.longest_report_bytes(HidReportKind::input), 65u);
}

TEST(ReportDescriptor, RepeatedUsagesAreToldApartByTheirInnermostNamedCollection) {
    const HidReportDescriptor d = parse_report_descriptor(eye_tracker_descriptor());
    std::vector<std::pair<HidUsage, int>> x_fields;
    for (const HidField& field : d.fields)
        if (field.usage == hid_usage(0x12, 0x21))
            x_fields.emplace_back(innermost_collection(field) & 0xFFFF, field.bit_offset / 8);
    EXPECT_THAT(x_fields, testing::ElementsAre(testing::Pair(0x24u, 8), testing::Pair(0x25u, 16),
                                               testing::Pair(0x26u, 28), testing::Pair(0x27u, 40)));
    // An anonymous collection inside Capabilities: the first one with a name counts.
    EXPECT_EQ(innermost_collection(field_of(d, 0x101)), hid_usage(0x12, 0x11));
}

TEST(ReportDescriptor, ConstantFieldsWithAUsageAreKept) {
    const HidReportDescriptor d = parse_report_descriptor(eye_tracker_descriptor());
    EXPECT_TRUE(field_of(d, 0x21).constant);
}

TEST(ReportDescriptor, ConstantFieldsWithoutAUsageAreCountedAsPadding) {
    // One byte, six 32-bit paddings without usages, one byte.
    const auto d =
        parse_report_descriptor(bytes_from_hex("05 12 09 01 A1 01 15 00 26 FF 00 75 08 95 01 09 20 81 02 75 "
                                               "20 95 06 81 03 75 08 95 01 09 21 81 02 C0"));
    ASSERT_EQ(d.fields.size(), 2u);
    EXPECT_EQ(d.fields[1].bit_offset, 8 + 192);
    EXPECT_EQ(d.reports.at(0).body_bytes(), 26u);
}

TEST(ReportDescriptor, AMaximumWrittenInAShortSignedFormIsReadUnsigned) {
    const auto max_of = [](const char* max) {
        return parse_report_descriptor(bytes_from_hex(std::string("05 12 09 01 A1 01 15 00 ") + max +
                                                      " 75 08 95 01 09 20 81 02 C0"))
            .fields.at(0)
            .logical_max;
    };
    EXPECT_EQ(max_of("25 FF"), 255);
    EXPECT_EQ(max_of("26 FF 00"), 255);
    EXPECT_EQ(max_of("27 FF FF FF FF"), 4294967295);
    EXPECT_EQ(max_of("25 7F"), 127);
}

TEST(ReportDescriptor, GlobalItemsPersistAndPushAndPopRestoreThem) {
    const auto d = parse_report_descriptor(
        bytes_from_hex("05 12 09 01 A1 01 16 00 80 26 FF 7F 75 10 95 01 09 21 81 02"  // signed 16 bit
                       "A4 75 08 15 00 25 10 09 22 81 02 B4"  // push, unsigned 8 bit, pop
                       "09 23 81 02 C0"));
    ASSERT_EQ(d.fields.size(), 3u);
    EXPECT_EQ(d.fields[1].bit_size, 8);
    EXPECT_EQ(d.fields[1].logical_min, 0);
    EXPECT_EQ(d.fields[2].bit_size, 16);
    EXPECT_EQ(d.fields[2].logical_min, -32768);
}

TEST(ReportDescriptor, UsageRangesExtendedUsagesAndLongItemsAreUnderstood) {
    const auto d =
        parse_report_descriptor(bytes_from_hex("05 09 A1 01 FE 02 AA 01 02 19 01 29 03 15 00 25 01 75 01 95 "
                                               "03 81 02 0B 21 00 12 00 75 10 95 01 81 02 C0"));
    ASSERT_EQ(d.fields.size(), 4u);
    EXPECT_EQ(d.fields[0].usage, hid_usage(0x09, 1));
    EXPECT_EQ(d.fields[2].usage, hid_usage(0x09, 3));
    EXPECT_EQ(d.fields[2].bit_offset, 2);
    EXPECT_EQ(d.fields[3].usage, hid_usage(0x12, 0x21));
    EXPECT_FALSE(d.has_report_ids);
}

TEST(ReportDescriptor, UnitExponentsAreSignedNibbles) {
    const HidReportDescriptor d = parse_report_descriptor(eye_tracker_descriptor());
    EXPECT_EQ(field_of(d, 0x20).unit_exponent, -6);
    EXPECT_EQ(field_of(d, 0x20).unit, 0x1001u);
    EXPECT_EQ(field_of(d, 0x21).unit_exponent, -4);
}

TEST(ReportDescriptor, EveryTruncationIsRefusedOrParsedButNeverReadBeyond) {
    const auto bytes = eye_tracker_descriptor();
    int refused = 0;
    for (std::size_t length = 1; length < bytes.size(); ++length) {
        try {
            parse_report_descriptor(std::span(bytes).first(length));
        } catch (const std::runtime_error&) {
            ++refused;
        }
    }
    EXPECT_EQ(refused, 363);  // all but lengths 2 and 4, before the first collection opens
}

TEST(ReportDescriptor, NoiseNeverCrashesTheParser) {
    Random random(17);
    auto bytes = eye_tracker_descriptor();
    for (int i = 0; i < 3000; ++i) {
        auto noisy = bytes;
        for (int k = 0; k < 4; ++k)
            noisy[random.below(noisy.size())] = static_cast<std::uint8_t>(random.next());
        try {
            const EyeTrackerLayout layout(parse_report_descriptor(noisy));
            layout.decode_tracking(golden_gaze_report());
            layout.mode_request(3);
        } catch (const std::runtime_error&) {
        }
    }
}

TEST(ReportDescriptor, AbsurdlyLongReportsAreRefused) {
    EXPECT_THROW(parse_report_descriptor(bytes_from_hex("A1 01 77 FF FF FF 7F 97 FF FF FF 7F 81 03 C0")),
                 std::runtime_error);
}

TEST(EyeTrackerReport, TheGoldenReportDecodes) {
    const auto reading = reference_layout().decode_tracking(golden_gaze_report());
    ASSERT_TRUE(reading);
    EXPECT_EQ(reading->device_time->ns, 1234567890LL * 1000);
    EXPECT_NEAR(*reading->gaze.x_m, 0.258, 1e-12);
    EXPECT_NEAR(*reading->gaze.y_m, 0.145, 1e-12);
    EXPECT_FALSE(reading->gaze.z_m);
    EXPECT_NEAR(*reading->left_eye.x_m, 0.2265, 1e-12);
    EXPECT_NEAR(*reading->left_eye.z_m, 0.6, 1e-12);
    EXPECT_NEAR(*reading->right_eye.x_m, 0.2895, 1e-12);
    EXPECT_NEAR(*reading->head.x_m, 0.258, 1e-12);
}

TEST(EyeTrackerReport, AValueOutsideTheLogicalRangeIsUnknown) {
    auto report = golden_gaze_report();
    for (std::size_t i = 9; i < 13; ++i) report[i] = i == 12 ? 0x7f : 0xff;
    const auto reading = reference_layout().decode_tracking(report);
    ASSERT_TRUE(reading);
    EXPECT_FALSE(reading->gaze.x_m);
    EXPECT_TRUE(reading->gaze.y_m);
    EXPECT_FALSE(direction_of_gaze_point(reading->gaze, kVirtualScreen, kVirtualScreenDistance_m));
}

TEST(EyeTrackerReport, NegativePositionsAreNegative) {
    auto report = golden_gaze_report();
    const std::int32_t value = -123456;
    std::memcpy(&report[17], &value, 4);
    EXPECT_NEAR(*reference_layout().decode_tracking(report)->left_eye.x_m, -0.123456, 1e-12);
}

TEST(EyeTrackerReport, StatusAndConfigurationDecode) {
    const EyeTrackerLayout layout = reference_layout();
    for (const HidReportKind kind : {HidReportKind::input, HidReportKind::feature}) {
        const auto status = layout.decode_status(bytes_from_hex("13 01 78 00"), kind);
        ASSERT_TRUE(status);
        EXPECT_EQ(status->state, EyeTrackerState::ready);
        EXPECT_EQ(status->rate_hz, 120);
    }
    const auto screen =
        layout.decode_screen(bytes_from_hex("12 ac 10 c5 a0 78 56 34 12 15 20 a0 df 07 00 d0 6c 04 00"));
    ASSERT_TRUE(screen);
    EXPECT_NEAR(screen->width_m, 0.516, 1e-12);
    EXPECT_NEAR(screen->height_m, 0.290, 1e-12);
    EXPECT_EQ(layout.configuration_report_id(), 0x12);
    EXPECT_EQ(layout.status_feature_id(), 0x13);
}

TEST(EyeTrackerReport, AnImplausibleScreenIsNone) {
    EXPECT_FALSE(reference_layout().decode_screen(
        bytes_from_hex("12 ac 10 c5 a0 78 56 34 12 15 20 00 00 00 00 00 00 00 00")));
}

TEST(EyeTrackerReport, TheModeRequestIsTheControlFeature) {
    EXPECT_THAT(reference_layout().mode_request(3).value(), testing::ElementsAre(0x14, 0x03));
    EXPECT_THAT(reference_layout().mode_request(0).value(), testing::ElementsAre(0x14, 0x00));
}

TEST(EyeTrackerReport, EveryTruncatedLengthAndUnknownIdIsNoReading) {
    const EyeTrackerLayout layout = reference_layout();
    const auto report = golden_gaze_report();
    for (std::size_t length = 0; length < report.size(); ++length)
        EXPECT_FALSE(layout.decode_tracking(std::span(report).first(length))) << length;
    for (int id = 0; id < 256; ++id) {
        auto other = report;
        other[0] = static_cast<std::uint8_t>(id);
        EXPECT_EQ(layout.decode_tracking(other).has_value(), id == 0x10);
    }
    const auto screen = bytes_from_hex("12 ac 10 c5 a0 78 56 34 12 15 20 a0 df 07 00 d0 6c 04 00");
    for (std::size_t length = 0; length < screen.size(); ++length)
        EXPECT_FALSE(layout.decode_screen(std::span(screen).first(length)));
    const auto status = bytes_from_hex("13 01 78 00");
    for (std::size_t length = 0; length < 2; ++length)
        EXPECT_FALSE(layout.decode_status(std::span(status).first(length), HidReportKind::input));
}

TEST(EyeTrackerReport, ATimestampMayBeOneTwoOrEightFields) {
    for (const char* stamp :
         {"75 40 95 01 09 20 81 02", "75 20 95 02 09 20 81 02", "75 08 95 08 09 20 81 02"}) {
        const EyeTrackerLayout layout(parse_report_descriptor(bytes_from_hex(
            std::string("05 12 09 01 A1 01 09 10 A1 02 15 00 26 FF 00 66 01 10 55 0A ") + stamp +
            "65 11 55 0C 16 00 80 26 FF 7F 75 10 95 02 09 24 A1 00 09 21 09 22 81 02 C0 C0 C0")));
        // No report ids: a zero stands before the body.
        auto report = bytes_from_hex("00 08 07 06 05 04 03 02 00 64 00 38 ff");
        const auto reading = layout.decode_tracking(report);
        ASSERT_TRUE(reading) << stamp;
        EXPECT_EQ(reading->device_time->ns, 0x0002030405060708LL * 1000);
        EXPECT_NEAR(*reading->gaze.x_m, 100e-6, 1e-15);
        EXPECT_NEAR(*reading->gaze.y_m, -200e-6, 1e-15);
    }
}

TEST(EyeTrackerReport, ADeviceWithoutAGazePointIsRefused) {
    EXPECT_THROW(EyeTrackerLayout(parse_report_descriptor(bytes_from_hex("05 01 09 02 A1 01 C0"))),
                 std::runtime_error);
}

TEST(GazePoint, TheCentreOfTheScreenIsStraightAheadAndItsEdge50DegreesAway) {
    const double half = kVirtualScreen.width_m / 2;
    const auto at = [&](double x, double y) {
        return *direction_of_gaze_point({half + x, half - y, {}}, kVirtualScreen, kVirtualScreenDistance_m);
    };
    EXPECT_NEAR(at(0, 0).azimuth_deg, 0, 1e-12);
    EXPECT_NEAR(at(half, 0).azimuth_deg, 50, 1e-4);
    EXPECT_NEAR(at(0, half).elevation_deg, 50, 1e-4);
    EXPECT_LT(at(0, -0.1).elevation_deg, 0);
}

}  // namespace
}  // namespace parafovea
