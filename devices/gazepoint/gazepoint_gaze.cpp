// The socket thread of a Gazepoint tracker.
#include "devices/gazepoint/gazepoint_gaze.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "devices/unit_vector.h"

namespace parafovea {
namespace {

constexpr int kConnectTimeout_ms = 2000;
constexpr int kReadTimeout_ms = 50;

// What we ask for; ENABLE_SEND_DATA starts the stream and comes last.
constexpr std::array kEnable = {"ENABLE_SEND_COUNTER",   "ENABLE_SEND_TIME",      "ENABLE_SEND_POG_BEST",
                                "ENABLE_SEND_POG_LEFT",  "ENABLE_SEND_POG_RIGHT", "ENABLE_SEND_EYE_LEFT",
                                "ENABLE_SEND_EYE_RIGHT", "ENABLE_SEND_DATA"};

}  // namespace

GazepointGaze::GazepointGaze(Clock& clock, const GazepointSettings& settings)
    : clock_(clock),
      settings_(settings),
      mapping_({.least_latency = settings.latency,
                .least_latency_error = settings.latency_error,
                .resolution = Duration::from_ms(0.1)}) {
    socket_ = connect_and_enable();
    if (socket_ < 0)
        throw std::runtime_error("no Gazepoint tracker answers at " + settings.host + ":" +
                                 std::to_string(settings.port) +
                                 "; start Gazepoint Control, or give the address of the machine it runs on");
    connected_ = true;
    thread_ = std::jthread([this](std::stop_token stop) { run(stop); });
}

GazepointGaze::~GazepointGaze() {
    thread_ = {};
    if (socket_ >= 0) ::close(socket_);
}

std::string GazepointGaze::description() const {
    std::array<char, 160> text;
    std::snprintf(text.data(), text.size(), "Gazepoint at %s:%d, screen %g x %g m at %g m",
                  settings_.host.c_str(), settings_.port, settings_.screen_width_m, settings_.screen_height_m,
                  settings_.screen_distance_m);
    return text.data();
}

int GazepointGaze::connect_and_enable() const {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(settings_.port);
    if (inet_pton(AF_INET, settings_.host.c_str(), &address.sin_addr) != 1) return -1;
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd < 0) return -1;

    // Connect without waiting for longer than the time-out.
    bool ok = ::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    if (!ok && errno == EINPROGRESS) {
        pollfd ready{fd, POLLOUT, 0};
        int error = 0;
        socklen_t size = sizeof error;
        ok = poll(&ready, 1, kConnectTimeout_ms) == 1 &&
             getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0;
    }
    const int yes = 1;
    setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    for (const char* id : kEnable) {
        const std::string line = std::string("<SET ID=\"") + id + "\" STATE=\"1\" />\r\n";
        ok = ok && ::send(fd, line.data(), line.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(line.size());
    }
    if (ok) return fd;
    ::close(fd);
    return -1;
}

void GazepointGaze::run(std::stop_token stop) {
    LineSplitter splitter;
    HostTime retry_at = clock_.now();
    while (!stop.stop_requested()) {
        if (socket_ < 0) {
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            if (clock_.now() < retry_at) continue;
            socket_ = connect_and_enable();
            retry_at = clock_.now() + settings_.retry_interval;
            splitter = {};
            connected_ = socket_ >= 0;
            continue;
        }
        pollfd ready{socket_, POLLIN, 0};
        if (poll(&ready, 1, kReadTimeout_ms) <= 0) continue;
        std::array<char, 4096> bytes;
        const ssize_t size = ::recv(socket_, bytes.data(), bytes.size(), 0);
        const HostTime arrival = clock_.now();
        if (size < 0 && (errno == EAGAIN || errno == EINTR)) continue;
        if (size <= 0) {
            connected_ = false;
            ::close(socket_);
            socket_ = -1;
            retry_at = arrival + settings_.retry_interval;
            continue;
        }
        for (const std::string& line : splitter.feed({bytes.data(), static_cast<std::size_t>(size)}))
            if (const auto message = parse_open_gaze(line))
                if (const auto record = decode_open_gaze_record(*message)) handle(*record, arrival);
    }
}

void GazepointGaze::handle(const OpenGazeRecord& record, HostTime arrival) {
    GazeSample sample;
    sample.arrival_time = arrival;
    sequence_ = record.count ? *record.count : sequence_ + 1;
    sample.sequence = sequence_;
    if (record.time_s) {
        sample.device_time = {static_cast<std::int64_t>(std::llround(*record.time_s * 1e9))};
        const MappedTime mapped = mapping_.map(sample.device_time, arrival);
        sample.host_time = mapped.time;
        sample.host_time_error = mapped.error;
    } else {
        sample.device_time = {arrival.ns};
        sample.host_time = arrival - settings_.latency;
        sample.host_time_error = settings_.latency_error;
    }
    sample.left = EyeSample{direction(record.left), record.left_pupil_mm};
    sample.right = EyeSample{direction(record.right), record.right_pupil_mm};
    sample.direction = direction(record.best);
    sample.status = sample.direction ? GazeStatus::tracked : GazeStatus::lost;
    ring_.push(sample);
}

std::optional<DirectionDeg> GazepointGaze::direction(const std::optional<ScreenFraction>& point) const {
    if (!point) return std::nullopt;
    return direction_of(Vector3{(point->x - 0.5) * settings_.screen_width_m,
                                (0.5 - point->y) * settings_.screen_height_m, settings_.screen_distance_m});
}

}  // namespace parafovea
