// Draws the progress bar.
#include "app/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace parafovea {

namespace {

std::string minutes_and_seconds(double seconds) {
    const int whole = static_cast<int>(std::lround(std::min(seconds, 359999.0)));
    char text[16];
    std::snprintf(text, sizeof text, "%d:%02d", whole / 60, whole % 60);
    return text;
}

}  // namespace

Progress::Progress(std::string title, int total, bool quiet)
    : title_(std::move(title)),
      total_(std::max(total, 1)),
      quiet_(quiet),
      terminal_(isatty(STDERR_FILENO) == 1),
      start_(std::chrono::steady_clock::now()),
      last_print_(start_) {}

Progress::~Progress() {
    if (printed_ && terminal_) std::fputc('\n', stderr);
}

void Progress::update(int done, std::string_view detail) {
    if (quiet_) return;
    const SteadyTime now = std::chrono::steady_clock::now();
    const double interval_s = terminal_ ? 0.1 : 10.0;
    const bool last = done >= total_;
    if (!last && printed_ && std::chrono::duration<double>(now - last_print_).count() < interval_s) return;
    last_print_ = now;
    printed_ = true;

    const double share = std::clamp(static_cast<double>(done) / total_, 0.0, 1.0);
    const double elapsed_s = std::chrono::duration<double>(now - start_).count();
    const std::string left = last        ? "done in " + minutes_and_seconds(elapsed_s)
                             : share > 0 ? minutes_and_seconds(elapsed_s * (1 - share) / share) + " left"
                                         : "";
    if (terminal_) {
        constexpr int kWidth = 30;
        const int filled = static_cast<int>(share * kWidth);
        std::fprintf(stderr, "\r%s [%.*s%.*s] %3d%%  %s  %.*s\033[K", title_.c_str(), filled,
                     "##############################", kWidth - filled, "..............................",
                     static_cast<int>(share * 100), left.c_str(), static_cast<int>(detail.size()),
                     detail.data());
    } else {
        std::fprintf(stderr, "%s: %d of %d, %s, %.*s\n", title_.c_str(), done, total_, left.c_str(),
                     static_cast<int>(detail.size()), detail.data());
    }
    std::fflush(stderr);
}

}  // namespace parafovea
