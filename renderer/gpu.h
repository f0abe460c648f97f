// The Vulkan device that everything is drawn on: instance, device, its one queue, and what the validation
// layers said.
//
// A Gpu lives longer than whatever was made with it. One thread at a time may use it. Every failure throws
// std::runtime_error with one line: what failed, on which device, and what the user can do.
#pragma once

#include <vulkan/vulkan.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace parafovea {

// Makes the Vulkan instance and device in Vulkan's place, as an OpenXR runtime must
// (XR_KHR_vulkan_enable2). Each is called once, in this order, and left empty together.
struct GpuMaker {
    std::function<VkResult(const VkInstanceCreateInfo&, VkInstance&)> instance;
    std::function<VkResult(VkInstance, VkPhysicalDevice&)> physical_device;  // the one that must be used
    std::function<VkResult(VkPhysicalDevice, const VkDeviceCreateInfo&, VkDevice&)> device;
};

struct GpuOptions {
    // The Khronos validation layer with synchronization validation; what it says is in validation_messages().
    bool validation = false;
    // A part of the wanted device's name; empty: the first of the fastest kind (discrete, integrated,
    // virtual, CPU).
    std::string device_name;
    GpuMaker maker;  // empty: Vulkan itself
};

// Throws one line that says what was being done and what the result means; returns on success. Device lost,
// out of memory and the like are told in words.
void check_vulkan(VkResult result, const char* doing);

// A Vulkan object of a device, destroyed with its owner. Empty after a move.
template <typename Handle, auto destroy>
class Owned {
  public:
    Owned() = default;
    Owned(VkDevice device, Handle handle) : device_(device), handle_(handle) {}
    Owned(Owned&& other) noexcept
        : device_(other.device_), handle_(std::exchange(other.handle_, Handle{VK_NULL_HANDLE})) {}
    Owned& operator=(Owned&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        return *this;
    }
    ~Owned() {
        if (handle_ != VK_NULL_HANDLE) destroy(device_, handle_, nullptr);
    }

    Handle get() const { return handle_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    Handle handle_ = VK_NULL_HANDLE;
};

class Gpu {
  public:
    explicit Gpu(const GpuOptions& options = {});
    ~Gpu();
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    VkInstance instance() const { return instance_; }
    VkPhysicalDevice physical_device() const { return physical_device_; }
    VkDevice device() const { return device_; }
    VkQueue queue() const { return queue_; }  // graphics, compute and transfer
    std::uint32_t queue_family() const { return queue_family_; }

    // For example "llvmpipe (LLVM 15.0.6, 256 bits)" and "llvmpipe Mesa 22.3.6 (LLVM 15.0.6)".
    const std::string& device_name() const { return device_name_; }
    const std::string& driver_name() const { return driver_name_; }
    VkPhysicalDeviceType device_type() const { return properties_.deviceType; }
    bool runs_on_the_cpu() const { return properties_.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
    const VkPhysicalDeviceLimits& limits() const { return properties_.limits; }
    const VkPhysicalDeviceFeatures& features() const { return features_; }  // those that are switched on

    // Records commands, submits them and waits until they are done.
    void submit_and_wait(const std::function<void(VkCommandBuffer)>& record);

    // Index of a memory type among `allowed_types` (a bit mask) with all of `required` and, if there is one,
    // `wanted`.
    std::uint32_t memory_type(std::uint32_t allowed_types, VkMemoryPropertyFlags required,
                              VkMemoryPropertyFlags wanted = 0) const;

    // Bytes of device memory that are allocated now through GpuBuffer and GpuImage, and the most there ever
    // were.
    VkDeviceSize allocated_bytes() const { return allocated_bytes_; }
    VkDeviceSize peak_allocated_bytes() const { return peak_allocated_bytes_; }
    void count_allocation(VkDeviceSize bytes);
    void count_release(VkDeviceSize bytes) { allocated_bytes_ -= bytes; }

    // Everything the validation layers have said so far (warnings and errors); empty without `validation`.
    const std::vector<std::string>& validation_messages() const { return validation_messages_; }

  private:
    void create_instance(const GpuOptions& options);
    void choose_physical_device(const GpuOptions& options);
    void create_device(const GpuMaker& maker);
    void destroy();

    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queue_family_ = 0;
    VkCommandPool command_pool_ = VK_NULL_HANDLE;
    VkCommandBuffer command_buffer_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    VkPhysicalDeviceProperties properties_{};
    VkPhysicalDeviceFeatures features_{};
    VkPhysicalDeviceMemoryProperties memory_{};
    std::string device_name_;
    std::string driver_name_;
    VkDeviceSize allocated_bytes_ = 0;
    VkDeviceSize peak_allocated_bytes_ = 0;
    std::vector<std::string> validation_messages_;
};

}  // namespace parafovea
