// Reads a pad and looks for it again.
#include "devices/xbox/pad_thread.h"

#include <chrono>
#include <stdexcept>
#include <utility>

namespace parafovea {

PadThread::PadThread(Clock& clock, Duration search_interval, std::unique_ptr<PadFinder> finder)
    : clock_(clock),
      search_interval_(search_interval),
      finder_(std::move(finder)),
      pad_(finder_->open()),
      description_(pad_->description()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

void PadThread::run(const std::stop_token& stop) {
    std::vector<ControllerEvent> events;
    while (!stop.stop_requested()) {
        if (!pad_) {
            search();
            continue;
        }
        events.clear();
        const bool there = pad_->read(events);
        for (const ControllerEvent& event : events) ring_.push(event);
        if (there) continue;
        const HostTime now = clock_.now();
        pad_.reset();
        connected_ = false;
        ring_.push({ControllerEventKind::disconnected, {}, now, Duration::from_ms(kPadReadTimeout_ms)});
        search_at_ = now + search_interval_;
    }
    pad_.reset();
}

void PadThread::search() {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    if (clock_.now() < search_at_) return;
    search_at_ = clock_.now() + search_interval_;
    try {
        pad_ = finder_->open();
    } catch (const std::runtime_error&) {
        return;  // still away: try again
    }
    connected_ = true;
    ring_.push({ControllerEventKind::connected, {}, clock_.now(), search_interval_});
}

}  // namespace parafovea
