// The item parser: global state, local state, main items.
#include "devices/hid/report_descriptor.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace parafovea {
namespace {

constexpr int kLongestReportBits = 65536 * 8;

struct GlobalState {
    std::uint16_t usage_page = 0;
    std::int32_t logical_min = 0;
    std::uint32_t logical_max_bits = 0;  // as written: its sign depends on the minimum
    int logical_max_bytes = 0;
    std::uint32_t unit = 0;
    int unit_exponent = 0;
    std::uint32_t report_size = 0, report_count = 0;
    std::uint8_t report_id = 0;
};

struct LocalState {
    std::vector<HidUsage> usages;
    std::optional<HidUsage> usage_min;
};

std::int32_t sign_extend(std::uint32_t value, int bytes) {
    if (bytes == 1) return static_cast<std::int8_t>(value);
    if (bytes == 2) return static_cast<std::int16_t>(value);
    return static_cast<std::int32_t>(value);
}

class Parser {
  public:
    explicit Parser(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    HidReportDescriptor run() {
        while (position_ < bytes_.size()) item();
        if (!collections_.empty()) fail("a collection is not closed");
        return std::move(result_);
    }

  private:
    [[noreturn]] void fail(const char* why) const {
        throw std::runtime_error("HID report descriptor, byte " + std::to_string(position_) + " of " +
                                 std::to_string(bytes_.size()) + ": " + why);
    }

    void item() {
        const std::uint8_t prefix = bytes_[position_];
        if (prefix == 0xFE) {  // a long item: none is defined, pass over it
            if (position_ + 2 >= bytes_.size() || position_ + 3 + bytes_[position_ + 1] > bytes_.size())
                fail("the descriptor ends within a long item");
            position_ += 3u + bytes_[position_ + 1];
            return;
        }
        const int size = (prefix & 3) == 3 ? 4 : prefix & 3;
        if (position_ + 1 + static_cast<std::size_t>(size) > bytes_.size())
            fail("the descriptor ends within an item");
        std::uint32_t data = 0;
        for (int i = 0; i < size; ++i)
            data |= std::uint32_t{bytes_[position_ + 1 + static_cast<std::size_t>(i)]} << 8 * i;

        switch (prefix >> 2 & 3) {
            case 0:
                main_item(prefix >> 4, data);
                break;
            case 1:
                global_item(prefix >> 4, data, size);
                break;
            case 2:
                local_item(prefix >> 4, data, size);
                break;
            default:
                break;  // reserved
        }
        position_ += 1 + static_cast<std::size_t>(size);
    }

    void global_item(int tag, std::uint32_t data, int size) {
        switch (tag) {
            case 0x0:
                global_.usage_page = static_cast<std::uint16_t>(data);
                break;
            case 0x1:
                global_.logical_min = sign_extend(data, size);
                break;
            case 0x2:
                global_.logical_max_bits = data;
                global_.logical_max_bytes = size;
                break;
            case 0x5:
                // A signed nibble; some write it as a signed byte.
                global_.unit_exponent =
                    data <= 0xF ? static_cast<int>(data ^ 8) - 8 : sign_extend(data, size);
                break;
            case 0x6:
                global_.unit = data;
                break;
            case 0x7:
                global_.report_size = data;
                break;
            case 0x8:
                if (data == 0 || data > 255) fail("a report id must be 1 to 255");
                global_.report_id = static_cast<std::uint8_t>(data);
                result_.has_report_ids = true;
                break;
            case 0x9:
                global_.report_count = data;
                break;
            case 0xA:
                stack_.push_back(global_);
                break;
            case 0xB:
                if (stack_.empty()) fail("pop without a push");
                global_ = stack_.back();
                stack_.pop_back();
                break;
            default:
                break;  // physical range: not needed; others reserved
        }
    }

    void local_item(int tag, std::uint32_t data, int size) {
        const HidUsage usage =
            size == 4 ? data : hid_usage(global_.usage_page, static_cast<std::uint16_t>(data));
        if (tag == 0x0) {
            local_.usages.push_back(usage);
        } else if (tag == 0x1) {
            local_.usage_min = usage;
        } else if (tag == 0x2 && local_.usage_min) {
            for (HidUsage u = *local_.usage_min; u <= usage && local_.usages.size() < 65536; ++u)
                local_.usages.push_back(u);
            local_.usage_min.reset();
        }
    }

    void main_item(int tag, std::uint32_t data) {
        if (tag == 0x8) fields(HidReportKind::input, data);
        if (tag == 0x9) fields(HidReportKind::output, data);
        if (tag == 0xB) fields(HidReportKind::feature, data);
        if (tag == 0xA) collections_.push_back(local_.usages.empty() ? 0 : local_.usages.front());
        if (tag == 0xC) {
            if (collections_.empty()) fail("a collection ends that never began");
            collections_.pop_back();
        }
        local_ = {};
    }

    void fields(HidReportKind kind, std::uint32_t flags) {
        auto report = std::find_if(result_.reports.begin(), result_.reports.end(), [&](const HidReport& r) {
            return r.kind == kind && r.report_id == global_.report_id;
        });
        if (report == result_.reports.end())
            report = result_.reports.insert(report, {kind, global_.report_id, 0});
        const std::uint64_t bits = std::uint64_t{global_.report_size} * global_.report_count;
        if (global_.report_size > kLongestReportBits || report->bits + bits > kLongestReportBits)
            fail("a report is longer than 64 KiB");

        const bool variable = flags & 2;
        if (variable && !local_.usages.empty() && global_.report_size > 0) {
            HidField field;
            field.kind = kind;
            field.report_id = global_.report_id;
            field.bit_size = static_cast<int>(global_.report_size);
            field.constant = flags & 1;
            field.logical_min = global_.logical_min;
            // A maximum below the minimum was meant unsigned (25 FF for 255).
            field.logical_max = sign_extend(global_.logical_max_bits, global_.logical_max_bytes);
            if (field.logical_max < field.logical_min) field.logical_max = global_.logical_max_bits;
            field.unit = global_.unit;
            field.unit_exponent = global_.unit_exponent;
            field.collections = collections_;
            for (std::uint32_t i = 0; i < global_.report_count; ++i) {
                field.bit_offset = report->bits + static_cast<int>(i * global_.report_size);
                field.usage = local_.usages[std::min<std::size_t>(i, local_.usages.size() - 1)];
                result_.fields.push_back(field);
            }
        }
        report->bits += static_cast<int>(bits);
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t position_ = 0;
    GlobalState global_;
    LocalState local_;
    std::vector<GlobalState> stack_;
    std::vector<HidUsage> collections_;
    HidReportDescriptor result_;
};

}  // namespace

const HidReport* HidReportDescriptor::report(HidReportKind kind, std::uint8_t report_id) const {
    for (const HidReport& r : reports)
        if (r.kind == kind && r.report_id == report_id) return &r;
    return nullptr;
}

std::size_t HidReportDescriptor::longest_report_bytes(HidReportKind kind) const {
    std::size_t longest = 0;
    for (const HidReport& r : reports)
        if (r.kind == kind) longest = std::max(longest, r.body_bytes() + (has_report_ids ? 1 : 0));
    return longest;
}

HidReportDescriptor parse_report_descriptor(std::span<const std::uint8_t> descriptor) {
    return Parser(descriptor).run();
}

std::optional<std::int64_t> hid_value(const HidField& field, std::span<const std::uint8_t> body) {
    if (field.bit_size < 1 || field.bit_size > 64) return std::nullopt;
    if (static_cast<std::size_t>(field.bit_offset + field.bit_size + 7) / 8 > body.size())
        return std::nullopt;
    std::uint64_t value = 0;
    for (int i = 0; i < field.bit_size; ++i) {
        const int bit = field.bit_offset + i;
        const std::uint64_t set = body[static_cast<std::size_t>(bit / 8)] >> (bit % 8) & 1;
        value |= set << i;
    }
    if (field.logical_min < 0 && field.bit_size < 64 && value >> (field.bit_size - 1) & 1)
        value |= ~std::uint64_t{0} << field.bit_size;
    return static_cast<std::int64_t>(value);
}

HidUsage innermost_collection(const HidField& field) {
    for (auto usage = field.collections.rbegin(); usage != field.collections.rend(); ++usage)
        if (*usage != 0) return *usage;
    return 0;
}

}  // namespace parafovea
