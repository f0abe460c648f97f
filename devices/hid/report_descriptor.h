// Parses a HID report descriptor into fields: which bits of which report mean what (HID 1.11, section 6.2.2).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace parafovea {

enum class HidReportKind { input, output, feature };

// A usage with its page: page << 16 | usage.
using HidUsage = std::uint32_t;
constexpr HidUsage hid_usage(std::uint16_t page, std::uint16_t usage) {
    return HidUsage{page} << 16 | usage;
}

struct HidField {
    HidReportKind kind = HidReportKind::input;
    std::uint8_t report_id = 0;  // 0 where the device has no report ids
    int bit_offset = 0;          // in the report's body, after the id byte if there is one
    int bit_size = 0;
    HidUsage usage = 0;
    bool constant = false;  // devices flag fields as constant that do carry data
    std::int64_t logical_min = 0, logical_max = 0;
    std::uint32_t unit = 0;
    int unit_exponent = 0;
    std::vector<HidUsage> collections;  // outermost first; 0 for one without a usage
};

struct HidReport {
    HidReportKind kind = HidReportKind::input;
    std::uint8_t report_id = 0;
    int bits = 0;  // of the body

    std::size_t body_bytes() const { return static_cast<std::size_t>(bits + 7) / 8; }
};

struct HidReportDescriptor {
    std::vector<HidField>
        fields;  // variable fields with a usage, in the order of their bits within each report
    std::vector<HidReport> reports;
    bool has_report_ids = false;

    // Nothing if there is no such report.
    const HidReport* report(HidReportKind kind, std::uint8_t report_id) const;
    // Bytes that the longest report of this kind takes, with its id if there are ids.
    std::size_t longest_report_bytes(HidReportKind kind) const;
};

// Throws std::runtime_error, with the byte, on a descriptor that ends within an item, has unbalanced
// collections or stacks, or describes a report longer than 64 KiB. Padding and arrays are counted but make no
// fields.
HidReportDescriptor parse_report_descriptor(std::span<const std::uint8_t> descriptor);

// The field's bits (at most 64) out of a report's body, sign-extended where the logical minimum is negative;
// absent where the body is too short.
std::optional<std::int64_t> hid_value(const HidField& field, std::span<const std::uint8_t> body);

// The first collection with a usage, from the innermost outwards; 0 if none.
HidUsage innermost_collection(const HidField& field);

}  // namespace parafovea
