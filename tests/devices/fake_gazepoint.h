// A Gazepoint tracker's server of our own, on the loopback.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <set>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>

#include "devices/time.h"

namespace parafovea {

// Accepts one client after the other, waits to be enabled, then streams 200 records a second: gaze at three
// quarters of the screen's width and a quarter of its height, every tenth without. Can hang up, and be away.
class FakeGazepoint {
  public:
    FakeGazepoint() {
        listen();
        thread_ = std::jthread([this](std::stop_token stop) { run(stop); });
    }
    ~FakeGazepoint() {
        thread_ = {};
        ::close(listener_);
    }

    std::uint16_t port() const { return port_; }
    int connections() const { return connections_; }

    void hang_up() { hang_up_ = true; }
    // Hangs up and lets whoever connects wait until told otherwise.
    void set_away(bool away) { away_ = away; }

    // When a record of this time was sent, on the host's clock, to a hundredth of a millisecond.
    HostTime sent_at(DeviceTime time) const {
        return HostTime{began_.time_since_epoch().count()} + (time - DeviceTime{kEpochNs});
    }

    // The device times of all records sent, ns.
    std::set<std::int64_t> times_ns() const {
        const std::scoped_lock lock(mutex_);
        return times_ns_;
    }

  private:
    void listen() {
        listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
            ::listen(listener_, 1) != 0)
            throw std::runtime_error("no loopback");
        socklen_t size = sizeof address;
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
    }

    void run(const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            if (away_) {
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
                continue;
            }
            pollfd ready{listener_, POLLIN, 0};
            if (poll(&ready, 1, 20) != 1) continue;
            const int client = ::accept(listener_, nullptr, nullptr);
            ++connections_;
            if (enabled(client, stop)) stream(client, stop);
            ::close(client);
        }
    }

    bool enabled(int client, const std::stop_token& stop) const {
        std::string asked;
        while (!stop.stop_requested() && asked.find("ENABLE_SEND_DATA\" STATE=\"1\"") == std::string::npos) {
            char bytes[512];
            const ssize_t size = ::recv(client, bytes, sizeof bytes, 0);
            if (size <= 0) return false;
            asked.append(bytes, static_cast<std::size_t>(size));
        }
        return asked.find("ENABLE_SEND_POG_BEST") != std::string::npos;
    }

    void stream(int client, const std::stop_token& stop) {
        while (!stop.stop_requested() && !away_ && !hang_up_.exchange(false)) {
            const double t = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
            char time[32], line[256];
            std::snprintf(time, sizeof time, "%.5f", kEpochNs * 1e-9 + t);
            const int size = std::snprintf(line, sizeof line,
                                           "<ACK ID=\"X\" />\r\n<REC CNT=\"%d\" TIME=\"%s\" "
                                           "BPOGX=\"0.75\" BPOGY=\"0.25\" BPOGV=\"%d\" />\r\n",
                                           count_, time, count_ % 10 != 9);
            ++count_;
            {
                const std::scoped_lock lock(mutex_);
                times_ns_.insert(std::llround(std::strtod(time, nullptr) * 1e9));
            }
            // In two pieces, as the network may cut it.
            if (::send(client, line, 20, MSG_NOSIGNAL) != 20) return;
            if (::send(client, line + 20, static_cast<std::size_t>(size - 20), MSG_NOSIGNAL) < 0) return;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }

    static constexpr std::int64_t kEpochNs = 100'000'000'000;  // what the server's clock reads at first

    int listener_ = -1;
    std::uint16_t port_ = 0;
    int count_ = 0;
    const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
    std::atomic<bool> hang_up_ = false, away_ = false;
    std::atomic<int> connections_ = 0;
    mutable std::mutex mutex_;
    std::set<std::int64_t> times_ns_;
    std::jthread thread_;
};

}  // namespace parafovea
