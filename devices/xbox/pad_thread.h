// The reading thread of an Xbox pad, however the pad is attached: reads it, notices that it went away, and
// looks for it again.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "devices/arrival_ring.h"
#include "devices/clock.h"
#include "devices/controller_source.h"

namespace parafovea {

// How long a read waits at the most, so that stopping is prompt; also how late a loss may be noticed.
inline constexpr int kPadReadTimeout_ms = 50;

// A pad that is open.
class OpenPad {
  public:
    virtual ~OpenPad() = default;

    // Appends what happened, after waiting for it for kPadReadTimeout_ms at the most. False: the pad is gone.
    virtual bool read(std::vector<ControllerEvent>& events) = 0;

    // For the log: how it is attached, and where its times come from.
    virtual std::string description() const = 0;
};

// One way of attaching pads.
class PadFinder {
  public:
    virtual ~PadFinder() = default;

    // The first pad there is. Throws std::runtime_error, saying what to do, if there is none or it may not be
    // opened.
    virtual std::unique_ptr<OpenPad> open() = 0;
};

// Reads in its own thread, and reports connected and disconnected. Buttons held when the pad goes are not
// reported as released.
class PadThread : public ControllerSource {
  public:
    // Throws what the finder throws. The clock must outlive it and allow calls from two threads.
    PadThread(Clock& clock, Duration search_interval, std::unique_ptr<PadFinder> finder);

    void drain(std::vector<ControllerEvent>& events) override { ring_.drain(events); }
    std::string description() const override { return description_; }

    bool connected() const { return connected_; }

  private:
    void run(const std::stop_token& stop);
    void search();

    Clock& clock_;
    Duration search_interval_;
    ArrivalRing<ControllerEvent, 1 << 12> ring_;
    std::atomic<bool> connected_ = true;
    std::unique_ptr<PadFinder> finder_;
    std::unique_ptr<OpenPad> pad_;  // nothing while it is away
    std::string description_;
    HostTime search_at_;
    std::jthread thread_;  // last: ends before the rest goes
};

}  // namespace parafovea
