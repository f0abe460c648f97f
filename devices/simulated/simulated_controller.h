// A hand controller whose buttons are pressed by a simulated participant.
#pragma once

#include <string>
#include <vector>

#include "devices/clock.h"
#include "devices/controller_source.h"

namespace parafovea {

struct SimulatedControllerSettings {
    // The pad is asked for its state this often, like a pad on USB (4 ms: Xbox 360 and One). An event is
    // reported at the first poll after it happened, never corrected, with the interval as its error. Zero:
    // exactly.
    Duration poll_interval = Duration::from_ms(4);
};

// What is scheduled is delivered by drain() once the clock has passed it. Not thread safe. The clock must
// outlive it.
class SimulatedController final : public ControllerSource {
  public:
    explicit SimulatedController(Clock& clock, const SimulatedControllerSettings& settings = {});

    // A typical length of a press on a shoulder button.
    static constexpr Duration kTypicalHold{90'000'000};

    // Schedules a press and its release; any order, any overlap.
    void press(Button button, HostTime at, Duration held = kTypicalHold);

    // Schedules the cable being pulled, or put in again. Buttons pressed while it is out are not seen.
    // Buttons held when it is pulled are not reported as released, just as with a real pad.
    void disconnect(HostTime at);
    void connect(HostTime at);

    void drain(std::vector<ControllerEvent>& events) override;
    std::string description() const override;

  private:
    void schedule(ControllerEventKind kind, Button button, HostTime at);

    Clock& clock_;
    SimulatedControllerSettings settings_;
    std::vector<ControllerEvent>
        scheduled_;  // by time of delivery; equal times in the order they were scheduled
    bool connected_ = true;
};

}  // namespace parafovea
