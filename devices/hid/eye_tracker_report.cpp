// Finds page 0x12 fields by usage and decodes them.
#include "devices/hid/eye_tracker_report.h"

#include <cmath>
#include <stdexcept>
#include <utility>

namespace parafovea {
namespace {

// Usages of page 0x12.
constexpr std::uint16_t kConfiguration = 0x12, kStatus = 0x13, kControl = 0x14;
constexpr std::uint16_t kTimestamp = 0x20, kPositionX = 0x21;
constexpr std::array<std::uint16_t, 4> kPointCollections = {0x24, 0x25, 0x26, 0x27};
constexpr std::uint16_t kCalibratedWidth = 0x204, kCalibratedHeight = 0x205;
constexpr std::uint16_t kSamplingFrequency = 0x300, kConfigurationStatus = 0x301, kModeRequest = 0x400;

// HID unit codes (HID 1.11, section 6.2.2.7).
constexpr std::uint32_t kUnitInch = 0x13, kUnitSecond = 0x1001, kUnitSecondEnglish = 0x1003;

// A field without a unit is in micrometres or microseconds, as in the sample descriptors.
double metres_per_count(const HidField& field) {
    if (field.unit == 0) return 1e-6;
    return (field.unit == kUnitInch ? 0.0254 : 0.01) * std::pow(10.0, field.unit_exponent);
}

double nanoseconds_per_count(const HidField& field) {
    if (field.unit != kUnitSecond && field.unit != kUnitSecondEnglish) return 1000;
    return std::pow(10.0, 9 + field.unit_exponent);
}

bool within_collection(const HidField& field, std::uint16_t collection) {
    for (const HidUsage usage : field.collections)
        if (usage == hid_usage(kEyeTrackerPage, collection)) return true;
    return false;
}

}  // namespace

EyeTrackerLayout::EyeTrackerLayout(HidReportDescriptor descriptor) : descriptor_(std::move(descriptor)) {
    for (const HidField& field : descriptor_.fields) {
        if (field.kind != HidReportKind::input) continue;
        if (field.usage == hid_usage(kEyeTrackerPage, kTimestamp) &&
            (timestamp_.empty() || timestamp_.front()->report_id == field.report_id))
            timestamp_.push_back(&field);
        const HidUsage collection = innermost_collection(field);
        for (std::size_t point = 0; point < kPointCollections.size(); ++point)
            for (std::uint16_t axis = 0; axis < 3; ++axis)
                if (collection == hid_usage(kEyeTrackerPage, kPointCollections[point]) &&
                    !points_[point][axis] &&
                    field.usage == hid_usage(kEyeTrackerPage, static_cast<std::uint16_t>(kPositionX + axis)))
                    points_[point][axis] = &field;
    }
    if (!points_[0][0] || !points_[0][1])
        throw std::runtime_error("the HID device describes no gaze point (usage page 0x12, collection 0x24)");
}

std::optional<EyeTrackerReading> EyeTrackerLayout::decode_tracking(
    std::span<const std::uint8_t> report) const {
    if (report.empty() || report[0] != points_[0][0]->report_id) return std::nullopt;
    const HidReport* layout = descriptor_.report(HidReportKind::input, report[0]);
    if (report.size() < 1 + layout->body_bytes()) return std::nullopt;

    EyeTrackerReading reading;
    if (!timestamp_.empty() && timestamp_.front()->report_id == report[0]) {
        std::uint64_t ticks = 0;
        int shift = 0;
        for (const HidField* field : timestamp_) {
            if (shift + field->bit_size > 64) break;
            const auto part = static_cast<std::uint64_t>(*value(field, report));
            const std::uint64_t mask =
                field->bit_size == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << field->bit_size) - 1;
            ticks |= (part & mask) << shift;
            shift += field->bit_size;
        }
        const auto scale =
            static_cast<std::uint64_t>(std::llround(nanoseconds_per_count(*timestamp_.front())));
        reading.device_time = DeviceTime{static_cast<std::int64_t>(ticks * (scale > 0 ? scale : 1))};
    }
    std::size_t index = 0;
    for (HidPoint* point : {&reading.gaze, &reading.left_eye, &reading.right_eye, &reading.head}) {
        const auto& fields = points_[index++];
        *point = {length_m(fields[0], report), length_m(fields[1], report), length_m(fields[2], report)};
    }
    return reading;
}

std::optional<EyeTrackerStatus> EyeTrackerLayout::decode_status(std::span<const std::uint8_t> report,
                                                                HidReportKind kind) const {
    const auto state = value(find(kind, kStatus, kConfigurationStatus), report);
    if (!state) return std::nullopt;
    EyeTrackerStatus status;
    if (*state >= 1 && *state <= 4) status.state = static_cast<EyeTrackerState>(*state);
    const auto rate = value(find(kind, kStatus, kSamplingFrequency), report);
    if (rate && (*rate & 0xFFFF) > 0) status.rate_hz = static_cast<double>(*rate & 0xFFFF);
    return status;
}

std::optional<EyeTrackerScreen> EyeTrackerLayout::decode_screen(std::span<const std::uint8_t> report) const {
    const auto width = length_m(find(HidReportKind::feature, kConfiguration, kCalibratedWidth), report);
    const auto height = length_m(find(HidReportKind::feature, kConfiguration, kCalibratedHeight), report);
    const auto plausible = [](const std::optional<double>& size) {
        return size && *size > 0.02 && *size < 10;
    };
    if (!plausible(width) || !plausible(height)) return std::nullopt;
    return EyeTrackerScreen{*width, *height};
}

std::optional<std::vector<std::uint8_t>> EyeTrackerLayout::mode_request(std::uint8_t mode) const {
    const HidField* field = find(HidReportKind::feature, kControl, kModeRequest);
    if (!field) return std::nullopt;
    std::vector<std::uint8_t> report(
        1 + descriptor_.report(HidReportKind::feature, field->report_id)->body_bytes());
    report[0] = field->report_id;
    for (int i = 0; i < field->bit_size && i < 8; ++i) {
        const auto bit = static_cast<std::size_t>(field->bit_offset + i);
        if (mode >> i & 1)
            report[1 + bit / 8] = static_cast<std::uint8_t>(report[1 + bit / 8] | 1 << bit % 8);
    }
    return report;
}

std::optional<std::uint8_t> EyeTrackerLayout::configuration_report_id() const {
    const HidField* field = find(HidReportKind::feature, kConfiguration, kCalibratedWidth);
    return field ? std::optional(field->report_id) : std::nullopt;
}

std::optional<std::uint8_t> EyeTrackerLayout::status_feature_id() const {
    const HidField* field = find(HidReportKind::feature, kStatus, kConfigurationStatus);
    return field ? std::optional(field->report_id) : std::nullopt;
}

const HidField* EyeTrackerLayout::find(HidReportKind kind, std::uint16_t collection,
                                       std::uint16_t usage) const {
    for (const HidField& field : descriptor_.fields)
        if (field.kind == kind && field.usage == hid_usage(kEyeTrackerPage, usage) &&
            within_collection(field, collection))
            return &field;
    return nullptr;
}

std::optional<std::int64_t> EyeTrackerLayout::value(const HidField* field,
                                                    std::span<const std::uint8_t> report) const {
    if (!field || report.empty() || report[0] != field->report_id) return std::nullopt;
    return hid_value(*field, report.subspan(1));
}

std::optional<double> EyeTrackerLayout::length_m(const HidField* field,
                                                 std::span<const std::uint8_t> report) const {
    const auto count = value(field, report);
    if (!count) return std::nullopt;
    // A value outside the logical range is HID's null value. Sizes persistently inherit a stale negative
    // minimum, which is why only tracking data are checked, and sizes are taken as unsigned.
    if (field->kind == HidReportKind::input && field->logical_max > field->logical_min &&
        (*count < field->logical_min || *count > field->logical_max))
        return std::nullopt;
    double counts = static_cast<double>(*count);
    if (field->kind == HidReportKind::feature && counts < 0) counts += std::pow(2.0, field->bit_size);
    return counts * metres_per_count(*field);
}

std::optional<DirectionDeg> direction_of_gaze_point(const HidPoint& gaze, EyeTrackerScreen screen,
                                                    double distance_m) {
    if (!gaze.x_m || !gaze.y_m) return std::nullopt;
    const double x = *gaze.x_m - screen.width_m / 2, y = screen.height_m / 2 - *gaze.y_m;
    return DirectionDeg{deg_from_rad(std::atan2(x, distance_m)),
                        deg_from_rad(std::atan2(y, std::hypot(x, distance_m)))};
}

}  // namespace parafovea
