// What a hand controller delivers, whichever it is.
#pragma once

#include <string>
#include <vector>

#include "devices/time.h"

namespace parafovea {

// Buttons by their place on an Xbox pad.
enum class Button { a, b, x, y, left_shoulder, right_shoulder, view, menu, up, down, left, right };

enum class ControllerEventKind { press, release, connected, disconnected };

struct ControllerEvent {
    ControllerEventKind kind = ControllerEventKind::press;
    Button button = Button::a;  // meaningless for connected and disconnected
    HostTime time;              // when it happened, host clock
    Duration time_error;        // half-width of that time's uncertainty
};

class ControllerSource {
  public:
    virtual ~ControllerSource() = default;

    // Appends every event that has arrived up to now, oldest first. Never blocks.
    virtual void drain(std::vector<ControllerEvent>& events) = 0;

    virtual std::string description() const = 0;
};

}  // namespace parafovea
