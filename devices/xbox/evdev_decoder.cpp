// Key codes, hat axes and dropped packets of the Linux input layer.
#include "devices/xbox/evdev_decoder.h"

namespace parafovea {

std::optional<Button> button_of_key(std::uint16_t code) {
    switch (code) {
        case BTN_A:
            return Button::a;
        case BTN_B:
            return Button::b;
        case BTN_X:
            return Button::x;  // as xpad names them; the face position is called west elsewhere
        case BTN_Y:
            return Button::y;
        case BTN_TL:
            return Button::left_shoulder;
        case BTN_TR:
            return Button::right_shoulder;
        case BTN_SELECT:
            return Button::view;
        case BTN_START:
            return Button::menu;
        case BTN_DPAD_UP:
            return Button::up;
        case BTN_DPAD_DOWN:
            return Button::down;
        case BTN_DPAD_LEFT:
            return Button::left;
        case BTN_DPAD_RIGHT:
            return Button::right;
        default:
            return std::nullopt;
    }
}

void EvdevDecoder::resynchronise(const PadState& state, HostTime time, std::vector<ControllerEvent>& events) {
    append_changes(state_, state, time, error_, events);
    state_ = state;
    dropped_ = false;
}

bool EvdevDecoder::decode(const input_event& event, std::vector<ControllerEvent>& events) {
    if (event.type == EV_SYN && event.code == SYN_DROPPED) dropped_ = true;
    if (dropped_) return !(event.type == EV_SYN && event.code == SYN_REPORT);

    const HostTime time{event.input_event_sec * 1'000'000'000LL + event.input_event_usec * 1000LL};
    PadState next = state_;
    if (event.type == EV_KEY && event.value != 2) {  // 2 repeats a key that is held
        if (const auto button = button_of_key(event.code)) next.set(*button, event.value != 0);
    } else if (event.type == EV_ABS && event.code == ABS_HAT0X) {
        next.set(Button::left, event.value < 0);
        next.set(Button::right, event.value > 0);
    } else if (event.type == EV_ABS && event.code == ABS_HAT0Y) {
        next.set(Button::up, event.value < 0);
        next.set(Button::down, event.value > 0);
    }
    append_changes(state_, next, time, error_, events);
    state_ = next;
    return true;
}

}  // namespace parafovea
