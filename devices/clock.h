// The host's monotonic clock, real or simulated. All waiting goes through it, so a session can run without
// time passing.
#pragma once

#include "devices/time.h"

namespace parafovea {

class Clock {
  public:
    virtual ~Clock() = default;

    // Never runs backwards.
    virtual HostTime now() = 0;

    // Returns once now() >= time.
    virtual void wait_until(HostTime time) = 0;
};

// CLOCK_MONOTONIC.
class SteadyClock final : public Clock {
  public:
    HostTime now() override;
    void wait_until(HostTime time) override;
};

// Time that moves only when somebody waits.
class SimulatedClock final : public Clock {
  public:
    HostTime now() override { return now_; }
    void wait_until(HostTime time) override { now_ = time > now_ ? time : now_; }

  private:
    HostTime now_;
};

}  // namespace parafovea
