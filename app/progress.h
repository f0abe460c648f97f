// A progress bar with the time left on a terminal, plain lines otherwise, nothing when quiet. Writes to
// standard error.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace parafovea {

class Progress {
  public:
    Progress(std::string title, int total, bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    // `detail` says what is going on now, e.g. the trial and its condition.
    void update(int done, std::string_view detail);

  private:
    using SteadyTime = std::chrono::steady_clock::time_point;

    std::string title_;
    int total_;
    bool quiet_;
    bool terminal_;
    SteadyTime start_, last_print_;
    bool printed_ = false;
};

}  // namespace parafovea
