// Turns Ctrl+C and a polite kill into a request to stop.
#pragma once

#include <stop_token>
#include <thread>

namespace parafovea {

// While it lives, SIGINT and SIGTERM ask `stop` to stop instead of ending the program. To be made before any
// other thread, since threads inherit which signals they leave to this one.
class StopOnSignal {
  public:
    explicit StopOnSignal(std::stop_source stop);
    ~StopOnSignal();
    StopOnSignal(const StopOnSignal&) = delete;
    StopOnSignal& operator=(const StopOnSignal&) = delete;

  private:
    std::jthread waiting_;
};

}  // namespace parafovea
