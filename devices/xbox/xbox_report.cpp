// Layouts of the three Xbox report formats.
#include "devices/xbox/xbox_report.h"

#include <algorithm>

namespace parafovea {
namespace {

std::uint16_t u16(std::span<const std::uint8_t> bytes, std::size_t at) {
    return static_cast<std::uint16_t>(bytes[at] | bytes[at + 1] << 8);
}
std::int16_t i16(std::span<const std::uint8_t> bytes, std::size_t at) {
    return static_cast<std::int16_t>(u16(bytes, at));
}

struct ButtonBit {
    std::uint8_t byte, bit;
    Button button;
};

template <std::size_t kCount>
void set_buttons(PadState& state, std::span<const std::uint8_t> bytes, const ButtonBit (&layout)[kCount]) {
    for (const ButtonBit& b : layout) state.set(b.button, bytes[b.byte] >> b.bit & 1);
}

constexpr ButtonBit kXbox360Buttons[] = {{2, 0, Button::up},
                                         {2, 1, Button::down},
                                         {2, 2, Button::left},
                                         {2, 3, Button::right},
                                         {2, 4, Button::menu},
                                         {2, 5, Button::view},
                                         {3, 0, Button::left_shoulder},
                                         {3, 1, Button::right_shoulder},
                                         {3, 4, Button::a},
                                         {3, 5, Button::b},
                                         {3, 6, Button::x},
                                         {3, 7, Button::y}};

// In the payload.
constexpr ButtonBit kGipButtons[] = {{0, 2, Button::menu},
                                     {0, 3, Button::view},
                                     {0, 4, Button::a},
                                     {0, 5, Button::b},
                                     {0, 6, Button::x},
                                     {0, 7, Button::y},
                                     {1, 0, Button::up},
                                     {1, 1, Button::down},
                                     {1, 2, Button::left},
                                     {1, 3, Button::right},
                                     {1, 4, Button::left_shoulder},
                                     {1, 5, Button::right_shoulder}};

constexpr ButtonBit kBluetoothButtons[] = {{14, 0, Button::a},
                                           {14, 1, Button::b},
                                           {14, 3, Button::x},
                                           {14, 4, Button::y},
                                           {14, 6, Button::left_shoulder},
                                           {14, 7, Button::right_shoulder},
                                           {15, 2, Button::view},
                                           {15, 3, Button::menu}};

constexpr ButtonBit kOldBluetoothButtons[] = {{14, 0, Button::a},
                                              {14, 1, Button::b},
                                              {14, 2, Button::x},
                                              {14, 3, Button::y},
                                              {14, 4, Button::left_shoulder},
                                              {14, 5, Button::right_shoulder},
                                              {14, 6, Button::view},
                                              {14, 7, Button::menu}};

// GIP commands and option bits.
constexpr std::uint8_t kAcknowledge = 0x01, kAnnounce = 0x02, kPower = 0x05, kAuthenticate = 0x06,
                       kLed = 0x0A, kInput = 0x20;
constexpr std::uint8_t kWantsAcknowledge = 0x10, kInternal = 0x20, kChunk = 0x80, kClientMask = 0x0F;
constexpr std::size_t kSmallestGipInput = 14;

constexpr std::uint16_t kOneS = 0x02fd;

// A number of up to four 7-bit groups, low first. Moves `at` on; nothing if it is cut short or longer.
std::optional<std::size_t> leb128(std::span<const std::uint8_t> bytes, std::size_t& at) {
    std::size_t value = 0;
    for (int shift = 0; shift < 28; shift += 7) {
        if (at >= bytes.size()) return std::nullopt;
        const std::uint8_t byte = bytes[at++];
        value |= static_cast<std::size_t>(byte & 0x7F) << shift;
        if (!(byte & 0x80)) return value;
    }
    return std::nullopt;
}

std::optional<PadState> decode_gip_input(std::span<const std::uint8_t> payload) {
    if (payload.size() < kSmallestGipInput) return std::nullopt;
    PadState state;
    set_buttons(state, payload, kGipButtons);
    state.triggers = {u16(payload, 2), u16(payload, 4)};
    state.sticks = {i16(payload, 6), i16(payload, 8), i16(payload, 10), i16(payload, 12)};
    return state;
}

}  // namespace

std::optional<PadState> decode_xbox360(std::span<const std::uint8_t> report) {
    if (report.size() < 20 || report[0] != 0x00 || report[1] != 0x14) return std::nullopt;
    PadState state;
    set_buttons(state, report, kXbox360Buttons);
    state.triggers = {report[4], report[5]};
    state.sticks = {i16(report, 6), i16(report, 8), i16(report, 10), i16(report, 12)};
    return state;
}

std::optional<PadState> decode_xbox_bluetooth(std::span<const std::uint8_t> report, std::uint16_t product) {
    if ((report.size() != 16 && report.size() != 17) || report[0] != 0x01) return std::nullopt;
    PadState state;
    if (report.size() == 17)
        set_buttons(state, report, kBluetoothButtons);
    else
        set_buttons(state, report, kOldBluetoothButtons);
    if (product == kOneS && report.size() == 17 && report[16] & 1) state.set(Button::view, true);
    // Sticks are unsigned with down positive; `~` turns down into up without overflow.
    for (std::size_t i = 0; i < 4; ++i) {
        const auto centred = static_cast<std::int16_t>(u16(report, 1 + 2 * i) ^ 0x8000);
        state.sticks[i] = i % 2 ? static_cast<std::int16_t>(~centred) : centred;
    }
    state.triggers = {u16(report, 9), u16(report, 11)};
    // 1 up, then clockwise by eighths to 8.
    const int hat = report[13];
    state.set(Button::up, hat == 8 || hat == 1 || hat == 2);
    state.set(Button::right, hat >= 2 && hat <= 4);
    state.set(Button::down, hat >= 4 && hat <= 6);
    state.set(Button::left, hat >= 6 && hat <= 8);
    return state;
}

std::vector<GipConnection::Message> GipConnection::start() {
    // Power on, light the guide button, say that authentication is done (some clones wait for it).
    return {{kPower, kInternal, next_sequence(), 0x01, 0x00},
            {kLed, kInternal, next_sequence(), 0x03, 0x00, 0x01, 0x14},
            {kAuthenticate, kInternal, next_sequence(), 0x02, 0x01, 0x00}};
}

GipConnection::Received GipConnection::receive(std::span<const std::uint8_t> transfer) {
    Received received;
    for (std::size_t at = 0; at + 4 <= transfer.size();) {
        // The header: command, options, sequence, length, and the offset of a chunk.
        const std::uint8_t command = transfer[at], options = transfer[at + 1], sequence = transfer[at + 2];
        at += 3;
        const auto length = leb128(transfer, at);
        std::size_t chunk_offset = 0;
        if (length && options & kChunk) {
            const auto offset = leb128(transfer, at);
            if (!offset) break;
            chunk_offset = *offset;
        }
        if (!length || *length > transfer.size() - at) break;
        const auto payload = transfer.subspan(at, *length);
        at += *length;

        if ((options & kClientMask) != 0) continue;  // an accessory plugged into the pad
        if (options & kWantsAcknowledge) {
            const std::size_t got = chunk_offset + *length;
            received.replies.push_back({kAcknowledge, kInternal, sequence, 0x09, 0x00, command, kInternal,
                                        static_cast<std::uint8_t>(got), static_cast<std::uint8_t>(got >> 8),
                                        0, 0, 0, 0});
        }
        if (options & kChunk) continue;  // long messages concern no button
        if (command == kAnnounce) {
            received.announced = true;
            for (Message& message : start()) received.replies.push_back(std::move(message));
        } else if (command == kInput) {
            if (const auto state = decode_gip_input(payload)) received.states.push_back(*state);
        }
    }
    return received;
}

std::uint8_t GipConnection::next_sequence() {
    sequence_ = sequence_ == 255 ? 1 : static_cast<std::uint8_t>(sequence_ + 1);
    return sequence_;
}

}  // namespace parafovea
