// Turns Linux input events of a pad into button events. Bytes in, values out; the reading is elsewhere.
#pragma once

#include <linux/input.h>

#include <optional>
#include <vector>

#include "devices/controller_source.h"
#include "devices/xbox/pad_state.h"

namespace parafovea {

// The study's button for a key code as the kernel's xpad driver and HID gamepads report it; nothing for
// others.
std::optional<Button> button_of_key(std::uint16_t code);

class EvdevDecoder {
  public:
    // `error` is how much later than the fact the kernel's stamp may be: the pad's polling interval.
    explicit EvdevDecoder(Duration error) : error_(error) {}

    // Takes the state at a moment as it is, with events for what differs from the last one known.
    void resynchronise(const PadState& state, HostTime time, std::vector<ControllerEvent>& events);

    // One event, its time stamp on CLOCK_MONOTONIC. Returns false after a SYN_DROPPED once the rest of the
    // packet has gone by: the caller must then read the pad's state and resynchronise.
    bool decode(const input_event& event, std::vector<ControllerEvent>& events);

  private:
    Duration error_;
    PadState state_;
    bool dropped_ = false;
};

}  // namespace parafovea
