// Fake HID and USB devices made with umockdev: the program under test opens them with its own libraries,
// unchanged.
#pragma once

#include <glib-object.h>
#include <umockdev.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace parafovea {

using Bytes = std::vector<std::uint8_t>;

struct GObjectDeleter {
    void operator()(void* object) const { g_object_unref(object); }
};
using Testbed = std::unique_ptr<UMockdevTestbed, GObjectDeleter>;

// A device under /dev/hidraw with feature reports.
class FakeHidDevice {
  public:
    // `bus` is 3 for USB, 5 for Bluetooth.
    FakeHidDevice(UMockdevTestbed* testbed, int bus, std::uint16_t vendor, std::uint16_t product,
                  Bytes descriptor);
    ~FakeHidDevice();

    void plug();
    void unplug();
    void send(const Bytes& report);  // an input report

    // Feature reports that can be asked for; set before plug(). The first byte is the id.
    std::vector<Bytes> features;
    // Feature reports that were set, in order.
    std::vector<Bytes> set_reports() const;

  private:
    static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);

    UMockdevTestbed* testbed_;
    int bus_;
    std::uint16_t vendor_, product_;
    Bytes descriptor_;
    std::string hid_path_, hidraw_path_, node_;
    int times_plugged_ = 0;
    UMockdevIoctlBase* handler_ = nullptr;
    bool plugged_ = false;
    mutable std::mutex mutex_;
    std::vector<Bytes> set_reports_;
};

// A pad under /dev/input with A, B, shoulder buttons and a hat, as the kernel's "xpad" makes it.
class FakeInputDevice {
  public:
    explicit FakeInputDevice(UMockdevTestbed* testbed) : testbed_(testbed) {}
    ~FakeInputDevice();

    void plug();
    void unplug();
    // An event stamped `stamp_ns` on CLOCK_MONOTONIC, and the SYN_REPORT that ends its packet.
    void send(std::uint16_t type, std::uint16_t code, int value, std::int64_t stamp_ns);

    // The clock that the program asked stamps of; -1 if it did not.
    int clock_asked() const { return clock_asked_; }
    // Keys held down, as EVIOCGKEY tells; set before plug().
    std::vector<int> held;

  private:
    static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);

    UMockdevTestbed* testbed_;
    std::string path_, node_;
    int times_plugged_ = 0;
    UMockdevIoctlBase* handler_ = nullptr;
    bool plugged_ = false;
    std::atomic<int> clock_asked_ = -1;
};

// A USB device with one vendor interface and two interrupt endpoints, driven by the kernel's "xpad" until it
// is claimed.
class FakeUsbPad {
  public:
    FakeUsbPad(UMockdevTestbed* testbed, std::uint16_t vendor, std::uint16_t product, std::uint8_t subclass,
               std::uint8_t protocol);
    ~FakeUsbPad();

    void plug();
    void unplug();
    void send(const Bytes& packet);  // goes out with the next interrupt IN transfer

    std::vector<Bytes> received() const;  // what came by interrupt OUT
    int detached() const { return detached_; }
    int handed_back() const { return handed_back_; }

  private:
    struct Transfer {
        UMockdevIoctlData* urb;
        UMockdevIoctlData* buffer;
    };
    static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self);
    void submit(UMockdevIoctlClient* client);
    void reap(UMockdevIoctlClient* client);
    void discard(UMockdevIoctlClient* client);
    void forget_transfers();

    UMockdevTestbed* testbed_;
    Bytes descriptors_;
    std::uint16_t vendor_, product_;
    std::string path_;
    UMockdevIoctlBase* handler_ = nullptr;
    bool plugged_ = false;
    std::atomic<bool> gone_ = false;
    std::atomic<int> detached_ = 0, handed_back_ = 0;
    mutable std::mutex mutex_;
    std::vector<Transfer> waiting_, finished_;
    std::vector<Bytes> to_send_, received_;
};

}  // namespace parafovea
