// The reading thread of a pad under /dev/input.
#include "devices/xbox/evdev_controller.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "devices/xbox/evdev_decoder.h"

namespace parafovea {
namespace {

// How often the host asks a pad: Microsoft's wired pads 4 ms, other USB pads usually 8 ms, Bluetooth at worst
// 15 ms.
constexpr std::uint16_t kMicrosoft = 0x045e;
Duration polling_interval(std::uint16_t bus, std::uint16_t vendor) {
    if (bus == BUS_USB) return Duration::from_ms(vendor == kMicrosoft ? 4 : 8);
    return Duration::from_ms(15);
}

using KeyBits = std::array<std::uint8_t, KEY_CNT / 8>;

bool has_bit(const KeyBits& bits, int bit) {
    return bits[static_cast<std::size_t>(bit / 8)] >> (bit % 8) & 1;
}

// What the kernel knows of the pad right now.
PadState read_state(int fd) {
    PadState state;
    KeyBits keys{};
    if (ioctl(fd, EVIOCGKEY(sizeof keys), keys.data()) >= 0)
        for (int code = BTN_MISC; code < KEY_CNT; ++code)
            if (has_bit(keys, code))
                if (const auto button = button_of_key(static_cast<std::uint16_t>(code)))
                    state.set(*button, true);
    input_absinfo axis{};
    if (ioctl(fd, EVIOCGABS(ABS_HAT0X), &axis) >= 0 && axis.value != 0)
        state.set(axis.value < 0 ? Button::left : Button::right, true);
    axis = {};
    if (ioctl(fd, EVIOCGABS(ABS_HAT0Y), &axis) >= 0 && axis.value != 0)
        state.set(axis.value < 0 ? Button::up : Button::down, true);
    return state;
}

std::string joystick_link_target(const std::filesystem::path& event) {
    std::error_code error;
    for (const char* folder : {"/dev/input/by-id", "/dev/input/by-path"})
        for (const auto& entry : std::filesystem::directory_iterator(folder, error))
            if (entry.path().filename().string().ends_with("-event-joystick") &&
                std::filesystem::read_symlink(entry.path(), error).filename() == event.filename())
                return entry.path().filename().string();
    return {};
}

class OpenEvdevPad final : public OpenPad {
  public:
    // Takes over the file. Throws if the pad cannot stamp its events on our clock.
    OpenEvdevPad(Clock& clock, int fd, const FoundPad& found)
        : clock_(clock),
          fd_(fd),
          name_(found.name),
          error_(polling_interval(found.bus, found.vendor)),
          decoder_(error_) {
        // Stamps on our clock instead of the wall clock; without them no response time is worth anything.
        int clock_id = CLOCK_MONOTONIC;
        if (ioctl(fd_, EVIOCSCLOCKID, &clock_id) < 0) {
            ::close(fd_);
            throw std::runtime_error("the pad at " + found.path +
                                     " cannot stamp its events with CLOCK_MONOTONIC");
        }
        // Buttons held down from before are nobody's answer.
        std::vector<ControllerEvent> from_before;
        decoder_.resynchronise(read_state(fd_), clock_.now(), from_before);
    }
    OpenEvdevPad(const OpenEvdevPad&) = delete;
    OpenEvdevPad& operator=(const OpenEvdevPad&) = delete;
    ~OpenEvdevPad() override { ::close(fd_); }

    bool read(std::vector<ControllerEvent>& events) override {
        pollfd ready{fd_, POLLIN, 0};
        if (poll(&ready, 1, kPadReadTimeout_ms) <= 0) return true;
        std::array<input_event, 64> packet;
        const ssize_t bytes = ::read(fd_, packet.data(), sizeof packet);
        if (bytes < 0 && (errno == EAGAIN || errno == EINTR)) return true;
        if (bytes <= 0) return false;
        for (std::size_t i = 0; i < static_cast<std::size_t>(bytes) / sizeof(input_event); ++i)
            if (!decoder_.decode(packet[i], events))
                decoder_.resynchronise(read_state(fd_), clock_.now(), events);
        return true;
    }

    std::string description() const override {
        return "evdev pad " + name_ + ", kernel time stamps, polled every " +
               std::to_string(error_.ns / 1000) + " us";
    }

  private:
    Clock& clock_;
    int fd_;
    std::string name_;
    Duration error_;
    EvdevDecoder decoder_;
};

class EvdevFinder final : public PadFinder {
  public:
    explicit EvdevFinder(Clock& clock) : clock_(clock) {}

    std::unique_ptr<OpenPad> open() override {
        const auto pads = list_evdev_pads();
        if (pads.empty())
            throw std::runtime_error(
                "no pad is connected under /dev/input; plug one in, or see `parafovea devices`");
        const auto pad = std::find_if(pads.begin(), pads.end(), [](const FoundPad& p) { return p.readable; });
        if (pad == pads.end())
            throw std::runtime_error("the pad at " + pads.front().path +
                                     " may not be read; install the udev rules or join the group input (see "
                                     "`parafovea devices`)");
        const int fd = ::open(pad->path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
        if (fd < 0)
            throw std::runtime_error("the pad at " + pad->path +
                                     " went away while being opened; plug it in again");
        return std::make_unique<OpenEvdevPad>(clock_, fd, *pad);
    }

  private:
    Clock& clock_;
};

}  // namespace

std::vector<FoundPad> list_evdev_pads() {
    std::vector<FoundPad> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/dev/input", error)) {
        if (!entry.path().filename().string().starts_with("event")) continue;
        FoundPad pad;
        pad.path = entry.path().string();
        const int fd = ::open(pad.path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
        if (fd < 0) {
            pad.name = joystick_link_target(entry.path());
            if (!pad.name.empty()) found.push_back(pad);
            continue;
        }
        KeyBits keys{};
        input_id id{};
        std::array<char, 128> name{};
        const bool is_pad = ioctl(fd, EVIOCGBIT(EV_KEY, sizeof keys), keys.data()) >= 0 &&
                            has_bit(keys, BTN_A) && has_bit(keys, BTN_B);
        if (ioctl(fd, EVIOCGID, &id) >= 0) {
            pad.vendor = id.vendor;
            pad.product = id.product;
            pad.bus = id.bustype;
        }
        if (ioctl(fd, EVIOCGNAME(name.size() - 1), name.data()) >= 0) pad.name = name.data();
        ::close(fd);
        pad.readable = true;
        if (is_pad) found.push_back(pad);
    }
    std::sort(found.begin(), found.end(),
              [](const FoundPad& a, const FoundPad& b) { return a.path < b.path; });
    return found;
}

EvdevController::EvdevController(Clock& clock, Duration search_interval)
    : PadThread(clock, search_interval, std::make_unique<EvdevFinder>(clock)) {}

}  // namespace parafovea
