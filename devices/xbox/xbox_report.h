// Reports of Xbox pads: 360 wired, One and Series wired (GIP), One and Series over Bluetooth. Bytes in,
// values out.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "devices/xbox/pad_state.h"

namespace parafovea {

// The 20-byte input report of a wired Xbox 360 pad; nothing for its other reports and shorter ones.
std::optional<PadState> decode_xbox360(std::span<const std::uint8_t> report);

// Input report 0x01 over Bluetooth: 17 bytes, or the 16 of old firmware; nothing for other reports and
// lengths. The One S (product 0x02fd) has its View button where newer pads have Share.
std::optional<PadState> decode_xbox_bluetooth(std::span<const std::uint8_t> report,
                                              std::uint16_t product = 0);

// The protocol of wired One and Series pads: packets with a header, acknowledgements, a start-up sequence.
// One object is one connection; it holds no I/O.
class GipConnection {
  public:
    using Message = std::vector<std::uint8_t>;

    // What to send first, and again whenever the pad announces itself (it lost power).
    std::vector<Message> start();

    struct Received {
        std::vector<PadState> states;  // one an input packet, oldest first
        std::vector<Message> replies;  // to send, in this order
        bool announced = false;        // the pad has just been powered up; replies hold the start-up sequence
    };

    // Takes one transfer, which may hold several packets. What is cut short or unknown is passed over.
    Received receive(std::span<const std::uint8_t> transfer);

  private:
    std::uint8_t next_sequence();

    std::uint8_t sequence_ = 0;
};

}  // namespace parafovea
