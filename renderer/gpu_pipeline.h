// Shaders, pipelines, the resources that are bound to them, drawing into images, and GPU time.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "renderer/gpu_memory.h"

namespace parafovea {

using OwnedPipeline = Owned<VkPipeline, vkDestroyPipeline>;
using OwnedPipelineLayout = Owned<VkPipelineLayout, vkDestroyPipelineLayout>;
using OwnedDescriptorSetLayout = Owned<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using OwnedDescriptorPool = Owned<VkDescriptorPool, vkDestroyDescriptorPool>;
using OwnedQueryPool = Owned<VkQueryPool, vkDestroyQueryPool>;

// What stands at a binding of a descriptor set; visible to all stages.
struct Binding {
    std::uint32_t binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    std::uint32_t count = 1;
};

// One descriptor set with its layout and pool. Fill every binding before the first draw; do not change it
// while a submission that uses it runs.
class DescriptorSet {
  public:
    DescriptorSet() = default;
    DescriptorSet(Gpu& gpu, std::span<const Binding> bindings);
    DescriptorSet(Gpu& gpu, std::initializer_list<Binding> bindings)
        : DescriptorSet(gpu, std::span<const Binding>(bindings.begin(), bindings.size())) {}

    VkDescriptorSetLayout layout() const { return layout_.get(); }
    VkDescriptorSet get() const { return set_; }

    void set_buffer(std::uint32_t binding, const GpuBuffer& buffer);
    void set_sampled_image(std::uint32_t binding, VkImageView view, VkSampler sampler,
                           std::uint32_t array_element = 0);
    void set_storage_image(std::uint32_t binding, VkImageView view);

  private:
    VkDescriptorType type_of(std::uint32_t binding) const;
    void write(const VkWriteDescriptorSet& write);

    VkDevice device_ = VK_NULL_HANDLE;
    std::vector<Binding> bindings_;
    OwnedDescriptorSetLayout layout_;
    OwnedDescriptorPool pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
};

// Push constants, if any, are seen by vertex, fragment and compute stages and start at 0.
inline constexpr VkShaderStageFlags kPushConstantStages =
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT | VK_SHADER_STAGE_COMPUTE_BIT;
OwnedPipelineLayout make_pipeline_layout(Gpu& gpu, std::span<const VkDescriptorSetLayout> sets,
                                         std::uint32_t push_constant_bytes = 0);
inline OwnedPipelineLayout make_pipeline_layout(Gpu& gpu, std::initializer_list<VkDescriptorSetLayout> sets,
                                                std::uint32_t push_constant_bytes = 0) {
    return make_pipeline_layout(gpu, std::span<const VkDescriptorSetLayout>(sets.begin(), sets.size()),
                                push_constant_bytes);
}

// A specialization constant of 32 bits (int, uint or bool), the same in both stages of a graphics pipeline.
struct ShaderConstant {
    std::uint32_t id = 0;
    std::uint32_t value = 0;
};

// Viewport and scissor are dynamic. The code spans are SPIR-V words (see shader_code/*.h).
struct GraphicsPipelineDescription {
    std::span<const std::uint32_t> vertex;
    std::span<const std::uint32_t> fragment;  // empty: depth only
    VkPipelineLayout layout = VK_NULL_HANDLE;
    std::vector<VkVertexInputBindingDescription> vertex_bindings;
    std::vector<VkVertexInputAttributeDescription> vertex_attributes;
    std::vector<VkFormat> color_formats;
    VkFormat depth_format = VK_FORMAT_UNDEFINED;
    VkCullModeFlags cull = VK_CULL_MODE_NONE;
    VkFrontFace front_face = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    bool depth_test = false;
    bool depth_write = false;
    VkCompareOp depth_compare = VK_COMPARE_OP_LESS_OR_EQUAL;
    float depth_bias_constant = 0;
    float depth_bias_slope = 0;
    bool alpha_blend = false;  // source over, straight alpha, on every color target
    std::vector<ShaderConstant> constants;
};
OwnedPipeline make_graphics_pipeline(Gpu& gpu, const GraphicsPipelineDescription& description);

// One triangle over the whole target, at depth 0 (shaders/fullscreen.vert), and a fragment shader.
GraphicsPipelineDescription fullscreen_pass(std::span<const std::uint32_t> fragment, VkPipelineLayout layout,
                                            std::vector<VkFormat> color_formats,
                                            std::vector<ShaderConstant> constants = {});
OwnedPipeline make_fullscreen_pipeline(Gpu& gpu, std::span<const std::uint32_t> fragment,
                                       VkPipelineLayout layout, std::vector<VkFormat> color_formats,
                                       std::vector<ShaderConstant> constants = {});

OwnedPipeline make_compute_pipeline(Gpu& gpu, std::span<const std::uint32_t> code, VkPipelineLayout layout,
                                    std::vector<ShaderConstant> constants = {});

// A target of dynamic rendering. `clear` null: the old contents are kept (load) or, with `discard`, of no
// interest.
struct ColorTarget {
    VkImageView view = VK_NULL_HANDLE;
    bool clear = false;
    bool discard = false;
    VkClearColorValue clear_value{};
};
struct DepthTarget {
    VkImageView view = VK_NULL_HANDLE;
    bool clear = false;
    float clear_depth = 1;
    bool read_only = false;
};

// Begins dynamic rendering over the whole extent and sets viewport and scissor to it; vkCmdEndRendering ends
// it.
void begin_rendering(VkCommandBuffer commands, VkExtent2D extent, std::span<const ColorTarget> color,
                     const DepthTarget* depth = nullptr);
inline void begin_rendering(VkCommandBuffer commands, VkExtent2D extent,
                            std::initializer_list<ColorTarget> color, const DepthTarget* depth = nullptr) {
    begin_rendering(commands, extent, std::span<const ColorTarget>(color.begin(), color.size()), depth);
}

// Binds a full-screen pipeline and its sets and draws its triangle.
void draw_fullscreen(VkCommandBuffer commands, VkPipeline pipeline, VkPipelineLayout layout,
                     std::span<const VkDescriptorSet> sets);

// How long each named stretch of a command buffer took on the device.
class PassTimer {
  public:
    struct Pass {
        std::string name;
        double ms = 0;
    };

    PassTimer(Gpu& gpu, std::uint32_t most_passes);

    // In this order: reset, then start and stop around each pass (not nested, outside rendering), then after
    // submit_and_wait() passes().
    void reset(VkCommandBuffer commands);
    void start(VkCommandBuffer commands, std::string name);
    void stop(VkCommandBuffer commands);

    // In order of recording; a name that was used twice is added up. Empty if the device has no timestamps.
    std::vector<Pass> passes() const;
    double total_ms() const;  // from the first start to the last stop

  private:
    std::vector<std::uint64_t> read() const;

    VkDevice device_ = VK_NULL_HANDLE;
    OwnedQueryPool queries_;
    std::uint32_t most_passes_ = 0;
    double ms_per_tick_ = 0;
    std::uint64_t valid_bits_mask_ = 0;
    std::vector<std::string> names_;
};

}  // namespace parafovea
