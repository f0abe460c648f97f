// Waits for the signals in a thread of its own.
#include "app/stop_on_signal.h"

#include <csignal>
#include <ctime>

namespace parafovea {

namespace {

sigset_t the_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    sigaddset(&signals, SIGINT);
    sigaddset(&signals, SIGTERM);
    return signals;
}

}  // namespace

StopOnSignal::StopOnSignal(std::stop_source stop) {
    const sigset_t signals = the_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    waiting_ = std::jthread([stop](std::stop_token done) mutable {
        const sigset_t awaited = the_signals();
        const timespec a_while{0, 50'000'000};
        while (!done.stop_requested())
            if (sigtimedwait(&awaited, nullptr, &a_while) > 0) stop.request_stop();
    });
}

StopOnSignal::~StopOnSignal() {
    waiting_ = {};
    const sigset_t signals = the_signals();
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace parafovea
