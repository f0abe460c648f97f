// ioctl servers for fake hidraw and usbfs nodes.
#include "tests/devices/fake_hardware.h"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <linux/input.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace parafovea {
namespace {

std::string hex(std::span<const std::uint8_t> bytes) {
    std::string text;
    char pair[3];
    for (const std::uint8_t byte : bytes) {
        std::snprintf(pair, sizeof pair, "%02X", byte);
        text += pair;
    }
    return text;
}

void add(UMockdevTestbed* testbed, const std::string& description) {
    GError* error = nullptr;
    if (!umockdev_testbed_add_from_string(testbed, description.c_str(), &error))
        throw std::runtime_error(error ? error->message : "umockdev refuses the device");
}

void attach(UMockdevTestbed* testbed, const char* node, UMockdevIoctlBase* handler) {
    GError* error = nullptr;
    if (!umockdev_testbed_attach_ioctl(testbed, node, handler, &error))
        throw std::runtime_error(error ? error->message : "umockdev refuses the ioctl handler");
}

// umockdev leaves the node of a removed device behind.
void remove_node(UMockdevTestbed* testbed, const std::string& node) {
    gchar* const root = umockdev_testbed_get_root_dir(testbed);
    ::unlink((std::string(root) + node).c_str());
    g_free(root);
}

// Nobody can find the device any more, and then who has its node open sees it hang up: the far end of the
// node's terminal closes. The number of that end stays taken, because umockdev will close it.
void hang_up(UMockdevTestbed* testbed, const std::string& node, const std::vector<std::string>& paths,
             UMockdevIoctlBase* handler) {
    const int fd = umockdev_testbed_get_dev_fd(testbed, node.c_str());
    for (const std::string& path : paths) umockdev_testbed_remove_device(testbed, ("/sys" + path).c_str());
    remove_node(testbed, node);
    const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    ::dup2(nothing, fd);
    ::close(nothing);
    // Let the program notice before its ioctl server goes.
    ::usleep(200'000);
    umockdev_testbed_detach_ioctl(testbed, node.c_str(), nullptr);
    g_object_unref(handler);
}

// The memory that the ioctl's argument points to.
UMockdevIoctlData* argument(UMockdevIoctlClient* client, std::size_t size) {
    return umockdev_ioctl_data_resolve(umockdev_ioctl_client_get_arg(client), 0, size, nullptr);
}

}  // namespace

FakeHidDevice::FakeHidDevice(UMockdevTestbed* testbed, int bus, std::uint16_t vendor, std::uint16_t product,
                             Bytes descriptor)
    : testbed_(testbed), bus_(bus), vendor_(vendor), product_(product), descriptor_(std::move(descriptor)) {
    char name[64];
    std::snprintf(name, sizeof name, "/devices/fake/%04X:%04X:%04X.0001", bus, vendor, product);
    hid_path_ = name;
}

FakeHidDevice::~FakeHidDevice() {
    if (plugged_) unplug();
}

void FakeHidDevice::plug() {
    char id[64];
    std::snprintf(id, sizeof id, "%04X:%08X:%08X", bus_, vendor_, product_);
    add(testbed_, "P: " + hid_path_ + "\nE: SUBSYSTEM=hid\nE: HID_ID=" + id +
                      "\nE: HID_NAME=Fake device\nE: HID_UNIQ=1\nH: report_descriptor=" + hex(descriptor_) +
                      "\n");
    // A new number each time, as the kernel may give it; umockdev cannot use one again.
    const std::string name = "hidraw" + std::to_string(times_plugged_++);
    node_ = "/dev/" + name;
    hidraw_path_ = hid_path_ + "/hidraw/" + name;
    add(testbed_, "P: " + hidraw_path_ + "\nN: " + name + "\nE: SUBSYSTEM=hidraw\nE: DEVNAME=" + node_ +
                      "\nL: device=../../../" + hid_path_.substr(hid_path_.rfind('/') + 1) + "\n");
    handler_ = umockdev_ioctl_base_new();
    g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
    attach(testbed_, node_.c_str(), handler_);
    plugged_ = true;
}

void FakeHidDevice::unplug() {
    hang_up(testbed_, node_, {hidraw_path_, hid_path_}, handler_);
    plugged_ = false;
}

void FakeHidDevice::send(const Bytes& report) {
    const int fd = umockdev_testbed_get_dev_fd(testbed_, node_.c_str());
    if (::write(fd, report.data(), report.size()) != static_cast<ssize_t>(report.size()))
        throw std::runtime_error("the fake HID device cannot send");
}

std::vector<Bytes> FakeHidDevice::set_reports() const {
    const std::lock_guard lock(mutex_);
    return set_reports_;
}

gboolean FakeHidDevice::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    auto* device = static_cast<FakeHidDevice*>(self);
    const gulong request = umockdev_ioctl_client_get_request(client);
    const std::size_t size = _IOC_SIZE(request);
    if (_IOC_TYPE(request) != 'H') return FALSE;
    if (request == HIDIOCGRDESCSIZE) {
        const int length = static_cast<int>(device->descriptor_.size());
        std::memcpy(argument(client, size)->data, &length, sizeof length);
        umockdev_ioctl_client_complete(client, 0, 0);
        return TRUE;
    }
    if (_IOC_NR(request) != 0x06 && _IOC_NR(request) != 0x07) return FALSE;
    UMockdevIoctlData* const data = argument(client, size);
    if (_IOC_NR(request) == 0x06) {  // HIDIOCSFEATURE
        const std::lock_guard lock(device->mutex_);
        device->set_reports_.emplace_back(data->data, data->data + size);
        umockdev_ioctl_client_complete(client, static_cast<glong>(size), 0);
        return TRUE;
    }
    for (const Bytes& feature : device->features) {  // HIDIOCGFEATURE
        if (feature[0] != data->data[0] || feature.size() > size) continue;
        std::memcpy(data->data, feature.data(), feature.size());
        umockdev_ioctl_client_complete(client, static_cast<glong>(feature.size()), 0);
        return TRUE;
    }
    umockdev_ioctl_client_complete(client, -1, EPIPE);
    return TRUE;
}

FakeInputDevice::~FakeInputDevice() {
    if (plugged_) unplug();
}

void FakeInputDevice::plug() {
    const std::string name = "event" + std::to_string(times_plugged_++);
    node_ = "/dev/input/" + name;
    path_ = "/devices/fake/input/" + name;
    add(testbed_, "P: " + path_ + "\nN: input/" + name + "\nE: SUBSYSTEM=input\nE: DEVNAME=" + node_ + "\n");
    handler_ = umockdev_ioctl_base_new();
    g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
    attach(testbed_, node_.c_str(), handler_);
    plugged_ = true;
}

void FakeInputDevice::unplug() {
    hang_up(testbed_, node_, {path_}, handler_);
    plugged_ = false;
}

void FakeInputDevice::send(std::uint16_t type, std::uint16_t code, int value, std::int64_t stamp_ns) {
    input_event events[2] = {};
    for (input_event& event : events) {
        event.input_event_sec = stamp_ns / 1'000'000'000;
        event.input_event_usec = stamp_ns / 1000 % 1'000'000;
    }
    events[0].type = type;
    events[0].code = code;
    events[0].value = value;
    const int fd = umockdev_testbed_get_dev_fd(testbed_, node_.c_str());
    if (::write(fd, events, sizeof events) != sizeof events)
        throw std::runtime_error("the fake pad cannot send");
}

gboolean FakeInputDevice::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    auto* device = static_cast<FakeInputDevice*>(self);
    const gulong request = umockdev_ioctl_client_get_request(client);
    const std::size_t size = _IOC_SIZE(request);
    if (_IOC_TYPE(request) != 'E') return FALSE;
    UMockdevIoctlData* const data = argument(client, size);
    const auto set_bit = [&](int bit) {
        const auto byte = static_cast<std::size_t>(bit / 8);
        if (byte < size) data->data[byte] = static_cast<guint8>(data->data[byte] | 1 << bit % 8);
    };
    if (request == EVIOCSCLOCKID) {
        int id = 0;
        std::memcpy(&id, data->data, sizeof id);
        device->clock_asked_ = id;
    } else if (request == EVIOCGID) {
        const input_id id{BUS_USB, 0x045e, 0x028e, 0x0114};
        std::memcpy(data->data, &id, sizeof id);
    } else if (_IOC_NR(request) == _IOC_NR(EVIOCGNAME(0))) {
        std::memcpy(data->data, "Fake X-Box 360 pad", 19);
    } else if (_IOC_NR(request) == _IOC_NR(EVIOCGBIT(EV_KEY, 0))) {
        for (const int code : {BTN_A, BTN_B, BTN_TL, BTN_TR}) set_bit(code);
    } else if (_IOC_NR(request) == _IOC_NR(EVIOCGKEY(0))) {
        for (const int code : device->held) set_bit(code);
    } else if (_IOC_NR(request) != _IOC_NR(EVIOCGABS(ABS_HAT0X)) &&
               _IOC_NR(request) != _IOC_NR(EVIOCGABS(ABS_HAT0Y))) {
        return FALSE;
    }
    umockdev_ioctl_client_complete(client, static_cast<glong>(size), 0);
    return TRUE;
}

FakeUsbPad::FakeUsbPad(UMockdevTestbed* testbed, std::uint16_t vendor, std::uint16_t product,
                       std::uint8_t subclass, std::uint8_t protocol)
    : testbed_(testbed), vendor_(vendor), product_(product), path_("/devices/fake/usb1/1-1") {
    const auto low = [](int v) { return static_cast<std::uint8_t>(v); };
    const auto high = [](int v) { return static_cast<std::uint8_t>(v >> 8); };
    descriptors_ = {18,
                    1,
                    0,
                    2,
                    0xFF,
                    0xFF,
                    0xFF,
                    64,
                    low(vendor),
                    high(vendor),
                    low(product),
                    high(product),
                    0x14,
                    1,
                    0,
                    0,
                    0,
                    1,
                    9,
                    2,
                    32,
                    0,
                    1,
                    1,
                    0,
                    0xA0,
                    250,  // configuration of 32 bytes
                    9,
                    4,
                    0,
                    0,
                    2,
                    0xFF,
                    subclass,
                    protocol,
                    0,  // interface
                    7,
                    5,
                    0x81,
                    3,
                    64,
                    0,
                    4,  // interrupt IN, every 4 ms
                    7,
                    5,
                    0x01,
                    3,
                    64,
                    0,
                    8};  // interrupt OUT, every 8 ms
}

FakeUsbPad::~FakeUsbPad() {
    if (plugged_) unplug();
    forget_transfers();
}

void FakeUsbPad::plug() {
    char ids[120];
    std::snprintf(ids, sizeof ids, "A: idVendor=%04x\nA: idProduct=%04x\nE: PRODUCT=%x/%x/114\n", vendor_,
                  product_, vendor_, product_);
    gone_ = false;
    add(testbed_,
        "P: " + path_ +
            "\nN: bus/usb/001/002\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DEVNAME=/dev/bus/usb/001/002\n"
            "E: BUSNUM=001\nE: DEVNUM=002\nE: MAJOR=189\nE: MINOR=1\nA: busnum=1\nA: devnum=2\nA: speed=12\n"
            "A: bConfigurationValue=1\nA: bNumConfigurations=1\n" +
            ids + "H: descriptors=" + hex(descriptors_) + "\n");
    handler_ = umockdev_ioctl_base_new();
    g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(on_ioctl), this);
    attach(testbed_, "/dev/bus/usb/001/002", handler_);
    plugged_ = true;
}

void FakeUsbPad::unplug() {
    gone_ = true;
    umockdev_testbed_uevent(testbed_, ("/sys" + path_).c_str(), "remove");
    // Let the program notice before the node and its ioctl server go.
    ::usleep(300'000);
    umockdev_testbed_remove_device(testbed_, ("/sys" + path_).c_str());
    remove_node(testbed_, "/dev/bus/usb/001/002");
    umockdev_testbed_detach_ioctl(testbed_, "/dev/bus/usb/001/002", nullptr);
    g_object_unref(handler_);
    plugged_ = false;
    forget_transfers();
}

void FakeUsbPad::send(const Bytes& packet) {
    const std::lock_guard lock(mutex_);
    to_send_.push_back(packet);
}

std::vector<Bytes> FakeUsbPad::received() const {
    const std::lock_guard lock(mutex_);
    return received_;
}

void FakeUsbPad::forget_transfers() {
    const std::lock_guard lock(mutex_);
    for (auto* list : {&waiting_, &finished_}) {
        for (const Transfer& transfer : *list) {
            umockdev_ioctl_data_unref(transfer.buffer);
            umockdev_ioctl_data_unref(transfer.urb);
        }
        list->clear();
    }
}

gboolean FakeUsbPad::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer self) {
    auto* pad = static_cast<FakeUsbPad*>(self);
    const gulong request = umockdev_ioctl_client_get_request(client);
    // As the kernel does: transfers under way end, new ones fail.
    if (pad->gone_ && request != USBDEVFS_REAPURB && request != USBDEVFS_REAPURBNDELAY) {
        umockdev_ioctl_client_complete(client, -1, ENODEV);
        return TRUE;
    }
    switch (request) {
        case USBDEVFS_SUBMITURB:
            pad->submit(client);
            return TRUE;
        case USBDEVFS_REAPURB:
        case USBDEVFS_REAPURBNDELAY:
            pad->reap(client);
            return TRUE;
        case USBDEVFS_DISCARDURB:
            pad->discard(client);
            return TRUE;
        case USBDEVFS_DISCONNECT_CLAIM:
            ++pad->detached_;
            umockdev_ioctl_client_complete(client, 0, 0);
            return TRUE;
        case USBDEVFS_CLAIMINTERFACE:
        case USBDEVFS_RELEASEINTERFACE:
            umockdev_ioctl_client_complete(client, 0, 0);
            return TRUE;
        case USBDEVFS_IOCTL: {
            UMockdevIoctlData* const data = argument(client, sizeof(usbdevfs_ioctl));
            if (reinterpret_cast<const usbdevfs_ioctl*>(data->data)->ioctl_code == USBDEVFS_CONNECT)
                ++pad->handed_back_;
            umockdev_ioctl_client_complete(client, 1, 0);
            return TRUE;
        }
        default:
            return FALSE;
    }
}

void FakeUsbPad::submit(UMockdevIoctlClient* client) {
    UMockdevIoctlData* const data = argument(client, sizeof(usbdevfs_urb));
    auto* urb = reinterpret_cast<usbdevfs_urb*>(data->data);
    UMockdevIoctlData* const buffer = umockdev_ioctl_data_resolve(
        data, offsetof(usbdevfs_urb, buffer), static_cast<std::size_t>(urb->buffer_length), nullptr);
    {
        const std::lock_guard lock(mutex_);
        if (urb->endpoint & 0x80) {
            waiting_.push_back({data, buffer});
        } else {
            received_.emplace_back(buffer->data, buffer->data + urb->buffer_length);
            urb->status = 0;
            urb->actual_length = urb->buffer_length;
            finished_.push_back({data, buffer});
        }
    }
    umockdev_ioctl_client_complete(client, 0, 0);
}

void FakeUsbPad::reap(UMockdevIoctlClient* client) {
    const std::lock_guard lock(mutex_);
    if (gone_) {
        for (const Transfer& transfer : waiting_) {
            reinterpret_cast<usbdevfs_urb*>(transfer.urb->data)->status = -ESHUTDOWN;
            finished_.push_back(transfer);
        }
        waiting_.clear();
    }
    if (finished_.empty() && !waiting_.empty() && !to_send_.empty()) {
        const Transfer transfer = waiting_.front();
        waiting_.erase(waiting_.begin());
        auto* urb = reinterpret_cast<usbdevfs_urb*>(transfer.urb->data);
        const Bytes packet = to_send_.front();
        to_send_.erase(to_send_.begin());
        urb->status = 0;
        urb->actual_length = static_cast<int>(packet.size());
        std::memcpy(transfer.buffer->data, packet.data(), packet.size());
        finished_.push_back(transfer);
    }
    if (finished_.empty()) {
        ::usleep(500);  // the caller asks again at once: spare the machine
        umockdev_ioctl_client_complete(client, -1, gone_ ? ENODEV : EAGAIN);
        return;
    }
    const Transfer transfer = finished_.front();
    finished_.erase(finished_.begin());
    umockdev_ioctl_data_set_ptr(argument(client, sizeof(void*)), 0, transfer.urb);
    umockdev_ioctl_client_complete(client, 0, 0);
}

void FakeUsbPad::discard(UMockdevIoctlClient* client) {
    gulong address = 0;
    std::memcpy(&address, umockdev_ioctl_client_get_arg(client)->data, sizeof address);
    const std::lock_guard lock(mutex_);
    for (std::size_t i = 0; i < waiting_.size(); ++i) {
        if (waiting_[i].urb->client_addr != address) continue;
        reinterpret_cast<usbdevfs_urb*>(waiting_[i].urb->data)->status = -ENOENT;
        finished_.push_back(waiting_[i]);
        waiting_.erase(waiting_.begin() + static_cast<std::ptrdiff_t>(i));
        umockdev_ioctl_client_complete(client, 0, 0);
        return;
    }
    umockdev_ioctl_client_complete(client, -1, EINVAL);
}

}  // namespace parafovea
