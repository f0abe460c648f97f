// The OpenXR runtime and the headset on it, before anything is shown.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "devices/geometry.h"
#include "devices/openxr/openxr_api.h"
#include "devices/time.h"

namespace parafovea {

// Throws one line that says what was being done and what the result means, unless the result is a success.
void check_openxr(XrResult result, const char* doing);

// Opens the active runtime (XR_RUNTIME_JSON, or the system's) and the headset. Lives longer than the Vulkan
// device that is made through it and than every session. Device time is XrTime. Functions may be called from
// any thread, next_event() from one at a time.
class OpenXrInstance {
  public:
    // Throws one line if there is no runtime, no headset, or the runtime cannot do what is needed.
    OpenXrInstance();
    ~OpenXrInstance();
    OpenXrInstance(const OpenXrInstance&) = delete;
    OpenXrInstance& operator=(const OpenXrInstance&) = delete;

    XrInstance handle() const { return instance_; }
    XrSystemId system() const { return system_; }
    const std::string& runtime_name() const { return runtime_name_; }  // with its version
    const std::string& headset_name() const { return headset_name_; }

    bool offers(std::string_view extension) const;  // and it is switched on
    bool has_eye_tracker() const { return has_eye_tracker_; }

    // One view of one eye, two, or two with two insets; and the picture that each should get.
    XrViewConfigurationType view_configuration() const { return view_configuration_; }
    const std::vector<SizePx>& view_sizes() const { return view_sizes_; }

    // XR_KHR_vulkan_enable2: makes Vulkan's instance and device as this runtime needs them. Throws if the
    // runtime fails; what Vulkan says is returned.
    VkResult make_vulkan_instance(const VkInstanceCreateInfo& info, VkInstance& instance) const;
    VkResult choose_vulkan_device(VkInstance instance, VkPhysicalDevice& device) const;
    VkResult make_vulkan_device(VkPhysicalDevice physical_device, const VkDeviceCreateInfo& info,
                                VkDevice& device) const;

    // Between the host's monotonic clock and the runtime's (XR_KHR_convert_timespec_time). Absent where the
    // runtime calls the time invalid.
    std::optional<DeviceTime> device_from_host(HostTime time) const;
    std::optional<HostTime> host_from_device(DeviceTime time) const;

    // Half-width of the uncertainty of host_from_device() at a time: what is lost going there and back, at
    // least a microsecond for the conversion itself.
    Duration conversion_error(HostTime at) const;

    std::optional<XrEventDataBuffer> next_event() const;

    // A function of an extension that is switched on. Throws if the runtime does not have it.
    template <typename Function>
    Function function(const char* name) const {
        return reinterpret_cast<Function>(find_function(name));
    }

  private:
    void create_instance();
    void find_headset();
    void choose_views();
    PFN_xrVoidFunction find_function(const char* name) const;

    XrInstance instance_ = XR_NULL_HANDLE;
    XrSystemId system_ = XR_NULL_SYSTEM_ID;
    std::vector<std::string> extensions_;
    std::string runtime_name_, headset_name_;
    bool has_eye_tracker_ = false;
    XrViewConfigurationType view_configuration_ = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    std::vector<SizePx> view_sizes_;
    PFN_xrConvertTimespecTimeToTimeKHR device_from_timespec_ = nullptr;
    PFN_xrConvertTimeToTimespecTimeKHR timespec_from_device_ = nullptr;
};

}  // namespace parafovea
