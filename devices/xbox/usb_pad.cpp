// The libusb thread of a wired Xbox pad.
#include "devices/xbox/usb_pad.h"

#include <libusb-1.0/libusb.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "devices/xbox/xbox_report.h"

namespace parafovea {
namespace {

constexpr unsigned kSendTimeout_ms = 100;

// The part of a configuration that is the pad itself.
struct PadInterface {
    UsbPadKind kind = UsbPadKind::xbox360;
    int number = 0;
    std::uint8_t in = 0, out = 0;
    Duration interval;
    std::size_t packet_bytes = 64;
};

Duration polling_interval(std::uint8_t b_interval, int speed) {
    // Full speed counts milliseconds; high speed and above, powers of two of 125 us.
    if (speed < LIBUSB_SPEED_HIGH) return Duration::from_ms(b_interval ? b_interval : 1);
    const int exponent = b_interval > 0 && b_interval <= 16 ? b_interval - 1 : 0;
    return {125'000LL << exponent};
}

std::optional<PadInterface> find_pad_interface(libusb_device* device) {
    libusb_config_descriptor* config = nullptr;
    if (libusb_get_active_config_descriptor(device, &config) != 0 &&
        libusb_get_config_descriptor(device, 0, &config) != 0)
        return std::nullopt;
    std::optional<PadInterface> found;
    for (int i = 0; i < config->bNumInterfaces && !found; ++i) {
        if (config->interface[i].num_altsetting < 1) continue;
        const libusb_interface_descriptor& setting = config->interface[i].altsetting[0];
        const auto is = [&](int c, int sub, int protocol) {
            return setting.bInterfaceClass == c && setting.bInterfaceSubClass == sub &&
                   setting.bInterfaceProtocol == protocol;
        };
        PadInterface pad;
        if (is(0xFF, 0x5D, 0x01))
            pad.kind = UsbPadKind::xbox360;
        else if (is(0xFF, 0x47, 0xD0) && setting.bInterfaceNumber == 0)
            pad.kind = UsbPadKind::gip;
        else
            continue;
        pad.number = setting.bInterfaceNumber;
        for (int e = 0; e < setting.bNumEndpoints; ++e) {
            const libusb_endpoint_descriptor& endpoint = setting.endpoint[e];
            if ((endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) != LIBUSB_TRANSFER_TYPE_INTERRUPT)
                continue;
            if (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) {
                pad.in = endpoint.bEndpointAddress;
                pad.interval = polling_interval(endpoint.bInterval, libusb_get_device_speed(device));
                if (endpoint.wMaxPacketSize > 0) pad.packet_bytes = endpoint.wMaxPacketSize;
            } else {
                pad.out = endpoint.bEndpointAddress;
            }
        }
        if (pad.in != 0) found = pad;
    }
    libusb_free_config_descriptor(config);
    return found;
}

// Calls visit(device, interface) for every pad until it returns true.
template <typename Visit>
void for_each_pad(libusb_context* context, Visit visit) {
    libusb_device** devices = nullptr;
    const ssize_t count = libusb_get_device_list(context, &devices);
    for (ssize_t i = 0; i < count; ++i) {
        const auto pad = find_pad_interface(devices[i]);
        if (pad && visit(devices[i], *pad)) break;
    }
    if (devices) libusb_free_device_list(devices, 1);
}

const char* name_of(UsbPadKind kind) {
    return kind == UsbPadKind::xbox360 ? "Xbox 360 pad" : "Xbox One pad";
}

struct UsbContext {
    UsbContext() {
        if (libusb_init(&usb) != 0) throw std::runtime_error("libusb cannot start; is /dev/bus/usb there?");
    }
    UsbContext(const UsbContext&) = delete;
    UsbContext& operator=(const UsbContext&) = delete;
    ~UsbContext() { libusb_exit(usb); }

    libusb_context* usb = nullptr;
};

class OpenUsbPad final : public OpenPad {
  public:
    OpenUsbPad(Clock& clock, libusb_device_handle* handle, const PadInterface& pad)
        : clock_(clock), handle_(handle), pad_(pad) {
        if (pad_.kind == UsbPadKind::gip)
            for (const auto& message : gip_.start()) send(message);
        // The first report of a 360 pad is as true as any other; nothing is held down before it.
        state_known_ = pad_.kind == UsbPadKind::xbox360;
    }
    OpenUsbPad(const OpenUsbPad&) = delete;
    OpenUsbPad& operator=(const OpenUsbPad&) = delete;
    ~OpenUsbPad() override {
        libusb_release_interface(handle_, pad_.number);  // gives the kernel its driver back
        libusb_close(handle_);
    }

    bool read(std::vector<ControllerEvent>& events) override {
        std::array<std::uint8_t, 1024> buffer;
        const std::size_t wanted = std::min(buffer.size(), std::max<std::size_t>(pad_.packet_bytes, 32));
        int received = 0;
        const int error = libusb_interrupt_transfer(handle_, pad_.in, buffer.data(), static_cast<int>(wanted),
                                                    &received, kPadReadTimeout_ms);
        const HostTime arrival = clock_.now();
        // A time-out may still have brought data.
        if (received > 0) take(std::span(buffer).first(static_cast<std::size_t>(received)), arrival, events);
        return error == 0 || error == LIBUSB_ERROR_TIMEOUT || error == LIBUSB_ERROR_INTERRUPTED ||
               error == LIBUSB_ERROR_OVERFLOW;
    }

    std::string description() const override {
        return std::string(name_of(pad_.kind)) + " through libusb, stamped on arrival, polled every " +
               std::to_string(pad_.interval.ns / 1000) + " us";
    }

  private:
    void send(const GipConnection::Message& message) {
        if (pad_.out == 0) return;
        GipConnection::Message copy = message;
        int sent = 0;
        libusb_interrupt_transfer(handle_, pad_.out, copy.data(), static_cast<int>(copy.size()), &sent,
                                  kSendTimeout_ms);
    }

    void take(std::span<const std::uint8_t> transfer, HostTime arrival,
              std::vector<ControllerEvent>& events) {
        std::vector<PadState> states;
        if (pad_.kind == UsbPadKind::xbox360) {
            if (const auto state = decode_xbox360(transfer)) states.push_back(*state);
        } else {
            GipConnection::Received received = gip_.receive(transfer);
            for (const auto& message : received.replies) send(message);
            if (received.announced) state_known_ = false;
            states = std::move(received.states);
        }
        for (const PadState& state : states) {
            if (state_known_) append_changes(state_, state, arrival, pad_.interval, events);
            state_ = state;
            state_known_ = true;
        }
    }

    Clock& clock_;
    libusb_device_handle* handle_;
    PadInterface pad_;
    GipConnection gip_;
    PadState state_;
    bool state_known_ = false;
};

class UsbPadFinder final : public PadFinder {
  public:
    explicit UsbPadFinder(Clock& clock) : clock_(clock) {}

    std::unique_ptr<OpenPad> open() override {
        std::unique_ptr<OpenPad> opened;
        int error = 0;
        bool seen = false;
        for_each_pad(context_.usb, [&](libusb_device* device, const PadInterface& pad) {
            seen = true;
            libusb_device_handle* handle = nullptr;
            error = libusb_open(device, &handle);
            if (error != 0) return false;
            // A system without kernel drivers says no, which is fine.
            libusb_set_auto_detach_kernel_driver(handle, 1);
            error = libusb_claim_interface(handle, pad.number);
            if (error != 0) {
                libusb_close(handle);
                return false;
            }
            opened = std::make_unique<OpenUsbPad>(clock_, handle, pad);
            return true;
        });
        if (!seen)
            throw std::runtime_error(
                "no wired Xbox pad is connected; plug one in, or see `parafovea devices`");
        if (!opened)
            throw std::runtime_error(
                std::string("the wired Xbox pad cannot be opened (") + libusb_error_name(error) +
                "); install the udev rules (see `parafovea devices`) or end the program that holds it");
        return opened;
    }

  private:
    Clock& clock_;
    UsbContext context_;
};

}  // namespace

std::vector<FoundUsbPad> list_usb_pads() {
    std::vector<FoundUsbPad> found;
    libusb_context* context = nullptr;
    if (libusb_init(&context) != 0) return found;
    for_each_pad(context, [&](libusb_device* device, const PadInterface& pad) {
        libusb_device_descriptor descriptor{};
        libusb_get_device_descriptor(device, &descriptor);
        libusb_device_handle* handle = nullptr;
        const bool readable = libusb_open(device, &handle) == 0;
        if (handle) libusb_close(handle);
        found.push_back({pad.kind, descriptor.idVendor, descriptor.idProduct, readable});
        return false;
    });
    libusb_exit(context);
    return found;
}

UsbPad::UsbPad(Clock& clock, Duration search_interval)
    : PadThread(clock, search_interval, std::make_unique<UsbPadFinder>(clock)) {}

}  // namespace parafovea
