// What an Xbox pad's buttons and axes are at one moment, however the pad is attached.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "devices/controller_source.h"

namespace parafovea {

struct PadState {
    std::uint16_t buttons = 0;                // bit n: the n-th Button is down
    std::array<std::int16_t, 4> sticks{};     // left x, y, right x, y; right and up positive
    std::array<std::uint16_t, 2> triggers{};  // left, right; 0 to 255 or 1023 as the pad has it

    bool pressed(Button button) const { return buttons >> static_cast<int>(button) & 1; }
    void set(Button button, bool down) {
        const auto bit = static_cast<std::uint16_t>(1u << static_cast<int>(button));
        buttons = static_cast<std::uint16_t>(down ? buttons | bit : buttons & ~bit);
    }

    bool operator==(const PadState&) const = default;
};

// Appends a press or release for every button that differs, all with the given time and error.
inline void append_changes(const PadState& before, const PadState& after, HostTime time, Duration error,
                           std::vector<ControllerEvent>& events) {
    for (int i = 0; i <= static_cast<int>(Button::right); ++i) {
        const auto button = static_cast<Button>(i);
        if (before.pressed(button) == after.pressed(button)) continue;
        const auto kind = after.pressed(button) ? ControllerEventKind::press : ControllerEventKind::release;
        events.push_back({kind, button, time, error});
    }
}

}  // namespace parafovea
