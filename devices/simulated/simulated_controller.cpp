// A time-ordered list of what the simulated participant's fingers do.
#include "devices/simulated/simulated_controller.h"

#include <algorithm>
#include <cassert>

namespace parafovea {

SimulatedController::SimulatedController(Clock& clock, const SimulatedControllerSettings& settings)
    : clock_(clock), settings_(settings) {
    assert(settings.poll_interval.ns >= 0);
}

void SimulatedController::press(Button button, HostTime at, Duration held) {
    assert(held.ns >= 0);
    schedule(ControllerEventKind::press, button, at);
    schedule(ControllerEventKind::release, button, at + held);
}

void SimulatedController::disconnect(HostTime at) {
    schedule(ControllerEventKind::disconnected, {}, at);
}

void SimulatedController::connect(HostTime at) {
    schedule(ControllerEventKind::connected, {}, at);
}

void SimulatedController::drain(std::vector<ControllerEvent>& events) {
    const HostTime now = clock_.now();
    auto next = scheduled_.begin();
    for (; next != scheduled_.end() && next->time <= now; ++next) {
        if (next->kind == ControllerEventKind::connected || next->kind == ControllerEventKind::disconnected) {
            const bool connects = next->kind == ControllerEventKind::connected;
            if (connects == connected_) continue;
            connected_ = connects;
        } else if (!connected_) {
            continue;
        }
        events.push_back(*next);
    }
    scheduled_.erase(scheduled_.begin(), next);
}

std::string SimulatedController::description() const {
    return "simulated pad, polled every " + std::to_string(settings_.poll_interval.ns / 1000) + " us";
}

void SimulatedController::schedule(ControllerEventKind kind, Button button, HostTime at) {
    const std::int64_t poll = settings_.poll_interval.ns;
    ControllerEvent event{kind, button, at, settings_.poll_interval};
    if (poll > 0) {
        // The first multiple of the interval not before `at`.
        std::int64_t past = at.ns % poll;
        if (past < 0) past += poll;
        if (past > 0) event.time = at + Duration{poll - past};
    }
    const auto after = std::upper_bound(scheduled_.begin(), scheduled_.end(), event.time,
                                        [](HostTime t, const ControllerEvent& e) { return t < e.time; });
    scheduled_.insert(after, event);
}

}  // namespace parafovea
