// The hidapi thread of a HID eye tracker.
#include "devices/hid/hid_gaze.h"

#include <hidapi/hidapi.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace parafovea {
namespace {

constexpr std::uint16_t kEyeTrackerUsage = 0x01;
constexpr std::uint8_t kModeGazeAndEyes = 3, kModeStop = 0;
constexpr int kReadTimeout_ms = 50;
constexpr double kUsualRate_hz = 120;

std::string narrow(const wchar_t* wide) {
    std::string text;
    for (; wide && *wide; ++wide) text += *wide < 128 ? static_cast<char>(*wide) : '?';
    return text;
}

// The kernel keeps the descriptor in sysfs; hidapi before 0.14 does not hand it out.
std::vector<std::uint8_t> read_descriptor(const std::string& path) {
    const auto file = std::filesystem::path("/sys/class/hidraw") / std::filesystem::path(path).filename() /
                      "device/report_descriptor";
    std::ifstream in(file, std::ios::binary);
    std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (bytes.empty()) throw std::runtime_error("cannot read " + file.string());
    return bytes;
}

std::vector<std::uint8_t> get_feature(hid_device* device, const HidReportDescriptor& descriptor,
                                      std::uint8_t id) {
    std::vector<std::uint8_t> report(descriptor.longest_report_bytes(HidReportKind::feature) + 1);
    report[0] = id;
    const int size = hid_get_feature_report(device, report.data(), report.size());
    report.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return report;
}

}  // namespace

std::vector<FoundHidDevice> list_hid_eye_trackers() {
    std::vector<FoundHidDevice> found;
    if (hid_init() != 0) return found;
    hid_device_info* const all = hid_enumerate(0, 0);
    for (const hid_device_info* info = all; info; info = info->next) {
        if (info->usage_page != kEyeTrackerPage || info->usage != kEyeTrackerUsage) continue;
        FoundHidDevice device{info->path, narrow(info->product_string), info->vendor_id, info->product_id,
                              false};
        device.readable = access(info->path, R_OK | W_OK) == 0;
        found.push_back(std::move(device));
    }
    hid_free_enumeration(all);
    return found;
}

struct HidGaze::Device {
    Device(hid_device* h, EyeTrackerLayout l) : handle(h), layout(std::move(l)) {}
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device() {
        if (const auto stop = layout.mode_request(kModeStop))
            hid_send_feature_report(handle, stop->data(), stop->size());
        hid_close(handle);
    }

    hid_device* handle;
    EyeTrackerLayout layout;
    EyeTrackerScreen screen = kVirtualScreen;
    double rate_hz = kUsualRate_hz;
    std::string name;
};

HidGaze::HidGaze(Clock& clock, const HidGazeSettings& settings)
    : clock_(clock),
      settings_(settings),
      mapping_({.least_latency = settings.latency,
                .least_latency_error = settings.latency_error,
                .resolution = {1000}}) {
    device_ = open();
    char text[200];
    std::snprintf(text, sizeof text, "HID eye tracker %s, %g Hz, screen %g x %g m at %g m",
                  device_->name.c_str(), device_->rate_hz, device_->screen.width_m, device_->screen.height_m,
                  settings_.screen_distance_m);
    description_ = text;
    connected_ = true;
    thread_ = std::jthread([this](std::stop_token stop) { run(stop); });
}

HidGaze::~HidGaze() = default;

std::unique_ptr<HidGaze::Device> HidGaze::open() {
    const auto found = list_hid_eye_trackers();
    if (found.empty())
        throw std::runtime_error(
            "no HID eye tracker (usage page 0x12) is connected; plug one in, or see `parafovea devices`");
    const FoundHidDevice& first = found.front();
    hid_device* const handle = hid_open_path(first.path.c_str());
    if (!handle)
        throw std::runtime_error("the HID eye tracker at " + first.path +
                                 " may not be opened; install the udev rules (see `parafovea devices`)");
    std::optional<EyeTrackerLayout> layout;
    try {
        layout.emplace(parse_report_descriptor(read_descriptor(first.path)));
    } catch (...) {
        hid_close(handle);
        throw;
    }
    auto device = std::make_unique<Device>(handle, std::move(*layout));
    device->name = first.name.empty() ? first.path : first.name;

    // Ask what it is set up for, then ask for data. A device without these features just sends.
    const auto& descriptor = device->layout.descriptor();
    if (const auto id = device->layout.configuration_report_id())
        if (const auto screen = device->layout.decode_screen(get_feature(handle, descriptor, *id)))
            device->screen = *screen;
    if (const auto id = device->layout.status_feature_id()) {
        const auto status =
            device->layout.decode_status(get_feature(handle, descriptor, *id), HidReportKind::feature);
        if (status && status->rate_hz) device->rate_hz = *status->rate_hz;
    }
    if (const auto request = device->layout.mode_request(kModeGazeAndEyes))
        hid_send_feature_report(handle, request->data(), request->size());
    return device;
}

void HidGaze::run(std::stop_token stop) {
    HostTime search_at = clock_.now();
    while (!stop.stop_requested()) {
        if (!device_) {
            // A short sleep of the thread itself, so that stopping is never delayed.
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
            if (clock_.now() < search_at) continue;
            search_at = clock_.now() + settings_.search_interval;
            try {
                device_ = open();
                last_device_time_.reset();
                connected_ = true;
            } catch (const std::runtime_error&) {
                // Still unplugged: try again.
            }
            continue;
        }
        // A report is passed on with an id first; devices that have none get a zero.
        const std::size_t id_bytes = device_->layout.descriptor().has_report_ids ? 0 : 1;
        const std::size_t longest = device_->layout.descriptor().longest_report_bytes(HidReportKind::input);
        std::vector<std::uint8_t> report(id_bytes + longest);
        const int size =
            hid_read_timeout(device_->handle, report.data() + id_bytes, longest, kReadTimeout_ms);
        const HostTime arrival = clock_.now();
        if (size < 0) {
            connected_ = false;
            device_.reset();
            search_at = arrival + settings_.search_interval;
        } else if (size > 0) {
            report.resize(static_cast<std::size_t>(size) + id_bytes);
            handle(*device_, report, arrival);
        }
    }
    device_.reset();
}

void HidGaze::handle(Device& device, std::span<const std::uint8_t> report, HostTime arrival) {
    if (const auto status = device.layout.decode_status(report, HidReportKind::input)) {
        if (status->rate_hz) device.rate_hz = *status->rate_hz;
        return;
    }
    const auto reading = device.layout.decode_tracking(report);
    if (!reading) return;

    GazeSample sample;
    sample.arrival_time = arrival;
    if (reading->device_time) {
        sample.device_time = *reading->device_time;
        const MappedTime mapped = mapping_.map(sample.device_time, arrival);
        sample.host_time = mapped.time;
        sample.host_time_error = mapped.error;
        // There is no frame counter: the time between samples tells how many were dropped.
        std::int64_t step = 1;
        if (last_device_time_ && sample.device_time > *last_device_time_)
            step = std::llround((sample.device_time - *last_device_time_).seconds() * device.rate_hz);
        sequence_ += step > 1 ? step : 1;
        last_device_time_ = sample.device_time;
    } else {
        sample.device_time = {arrival.ns};
        sample.host_time = arrival - settings_.latency;
        sample.host_time_error = settings_.latency_error;
        ++sequence_;
    }
    sample.sequence = sequence_ - 1;
    sample.direction = direction_of_gaze_point(reading->gaze, device.screen, settings_.screen_distance_m);
    sample.status = sample.direction ? GazeStatus::tracked : GazeStatus::lost;
    ring_.push(sample);
}

}  // namespace parafovea
