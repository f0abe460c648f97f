// Builds pipelines and descriptor sets, begins rendering and reads GPU time.
#include "renderer/gpu_pipeline.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "shader_code/fullscreen_vert.h"

namespace parafovea {
namespace {

using OwnedShaderModule = Owned<VkShaderModule, vkDestroyShaderModule>;

OwnedShaderModule make_module(Gpu& gpu, std::span<const std::uint32_t> code) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    VkShaderModule shader_module = VK_NULL_HANDLE;
    check_vulkan(vkCreateShaderModule(gpu.device(), &info, nullptr, &shader_module), "reading a shader");
    return {gpu.device(), shader_module};
}

// Keeps the arrays that VkSpecializationInfo points to.
class Specialization {
  public:
    explicit Specialization(const std::vector<ShaderConstant>& constants) {
        for (const ShaderConstant& constant : constants) {
            const auto offset = static_cast<std::uint32_t>(values_.size() * sizeof(std::uint32_t));
            entries_.push_back({constant.id, offset, sizeof(std::uint32_t)});
            values_.push_back(constant.value);
        }
        info_ = {static_cast<std::uint32_t>(entries_.size()), entries_.data(),
                 values_.size() * sizeof(std::uint32_t), values_.data()};
    }
    Specialization(const Specialization&) = delete;
    Specialization& operator=(const Specialization&) = delete;

    const VkSpecializationInfo* info() const { return entries_.empty() ? nullptr : &info_; }

  private:
    std::vector<VkSpecializationMapEntry> entries_;
    std::vector<std::uint32_t> values_;
    VkSpecializationInfo info_{};
};

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, VkShaderModule shader_module,
                                           const Specialization& specialization) {
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = stage;
    info.module = shader_module;
    info.pName = "main";
    info.pSpecializationInfo = specialization.info();
    return info;
}

}  // namespace

DescriptorSet::DescriptorSet(Gpu& gpu, std::span<const Binding> bindings)
    : device_(gpu.device()), bindings_(bindings.begin(), bindings.end()) {
    std::vector<VkDescriptorSetLayoutBinding> layout_bindings;
    std::vector<VkDescriptorPoolSize> sizes;
    for (const Binding& b : bindings) {
        layout_bindings.push_back({b.binding, b.type, b.count, VK_SHADER_STAGE_ALL, nullptr});
        sizes.push_back({b.type, b.count});
    }
    VkDescriptorSetLayoutCreateInfo layout_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    layout_info.bindingCount = static_cast<std::uint32_t>(layout_bindings.size());
    layout_info.pBindings = layout_bindings.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    check_vulkan(vkCreateDescriptorSetLayout(device_, &layout_info, nullptr, &layout), "describing bindings");
    layout_ = {device_, layout};

    VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = static_cast<std::uint32_t>(sizes.size());
    pool_info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check_vulkan(vkCreateDescriptorPool(device_, &pool_info, nullptr, &pool), "creating a descriptor pool");
    pool_ = {device_, pool};

    VkDescriptorSetAllocateInfo allocate{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout;
    check_vulkan(vkAllocateDescriptorSets(device_, &allocate, &set_), "allocating descriptors");
}

VkDescriptorType DescriptorSet::type_of(std::uint32_t binding) const {
    const auto found = std::ranges::find(bindings_, binding, &Binding::binding);
    assert(found != bindings_.end());
    return found->type;
}

void DescriptorSet::write(const VkWriteDescriptorSet& write) {
    vkUpdateDescriptorSets(device_, 1, &write, 0, nullptr);
}

void DescriptorSet::set_buffer(std::uint32_t binding, const GpuBuffer& buffer) {
    const VkDescriptorBufferInfo info{buffer.get(), 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    w.dstSet = set_;
    w.dstBinding = binding;
    w.descriptorCount = 1;
    w.descriptorType = type_of(binding);
    w.pBufferInfo = &info;
    write(w);
}

void DescriptorSet::set_sampled_image(std::uint32_t binding, VkImageView view, VkSampler sampler,
                                      std::uint32_t array_element) {
    const VkDescriptorImageInfo info{sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    w.dstSet = set_;
    w.dstBinding = binding;
    w.dstArrayElement = array_element;
    w.descriptorCount = 1;
    w.descriptorType = type_of(binding);
    w.pImageInfo = &info;
    write(w);
}

void DescriptorSet::set_storage_image(std::uint32_t binding, VkImageView view) {
    const VkDescriptorImageInfo info{VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL};
    VkWriteDescriptorSet w{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    w.dstSet = set_;
    w.dstBinding = binding;
    w.descriptorCount = 1;
    w.descriptorType = type_of(binding);
    w.pImageInfo = &info;
    write(w);
}

OwnedPipelineLayout make_pipeline_layout(Gpu& gpu, std::span<const VkDescriptorSetLayout> sets,
                                         std::uint32_t push_constant_bytes) {
    const VkPushConstantRange range{kPushConstantStages, 0, push_constant_bytes};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
    info.pSetLayouts = sets.data();
    info.pushConstantRangeCount = push_constant_bytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    check_vulkan(vkCreatePipelineLayout(gpu.device(), &info, nullptr, &layout), "creating a pipeline layout");
    return {gpu.device(), layout};
}

OwnedPipeline make_graphics_pipeline(Gpu& gpu, const GraphicsPipelineDescription& d) {
    const Specialization specialization(d.constants);
    const OwnedShaderModule vertex = make_module(gpu, d.vertex);
    const OwnedShaderModule fragment =
        d.fragment.empty() ? OwnedShaderModule() : make_module(gpu, d.fragment);
    std::vector<VkPipelineShaderStageCreateInfo> stages{
        stage_info(VK_SHADER_STAGE_VERTEX_BIT, vertex.get(), specialization)};
    if (fragment) stages.push_back(stage_info(VK_SHADER_STAGE_FRAGMENT_BIT, fragment.get(), specialization));

    VkPipelineVertexInputStateCreateInfo vertex_input{
        VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    vertex_input.vertexBindingDescriptionCount = static_cast<std::uint32_t>(d.vertex_bindings.size());
    vertex_input.pVertexBindingDescriptions = d.vertex_bindings.data();
    vertex_input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(d.vertex_attributes.size());
    vertex_input.pVertexAttributeDescriptions = d.vertex_attributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = 1;
    viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = d.cull;
    raster.frontFace = d.front_face;
    raster.depthBiasEnable = d.depth_bias_constant != 0 || d.depth_bias_slope != 0;
    raster.depthBiasConstantFactor = d.depth_bias_constant;
    raster.depthBiasSlopeFactor = d.depth_bias_slope;
    raster.lineWidth = 1;
    VkPipelineMultisampleStateCreateInfo multisample{
        VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = d.depth_test;
    depth.depthWriteEnable = d.depth_write;
    depth.depthCompareOp = d.depth_compare;

    VkPipelineColorBlendAttachmentState blend{};
    blend.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT |
                           VK_COLOR_COMPONENT_A_BIT;
    blend.blendEnable = d.alpha_blend;
    blend.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    const std::vector<VkPipelineColorBlendAttachmentState> blends(d.color_formats.size(), blend);
    VkPipelineColorBlendStateCreateInfo color{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    color.attachmentCount = static_cast<std::uint32_t>(blends.size());
    color.pAttachments = blends.data();
    const std::array dynamic_states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = dynamic_states.size();
    dynamic.pDynamicStates = dynamic_states.data();
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(d.color_formats.size());
    rendering.pColorAttachmentFormats = d.color_formats.data();
    rendering.depthAttachmentFormat = d.depth_format;

    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.pNext = &rendering;
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &vertex_input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &multisample;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &color;
    info.pDynamicState = &dynamic;
    info.layout = d.layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check_vulkan(vkCreateGraphicsPipelines(gpu.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
                 "building a graphics pipeline");
    return {gpu.device(), pipeline};
}

GraphicsPipelineDescription fullscreen_pass(std::span<const std::uint32_t> fragment, VkPipelineLayout layout,
                                            std::vector<VkFormat> color_formats,
                                            std::vector<ShaderConstant> constants) {
    GraphicsPipelineDescription pass;
    pass.vertex = shader_code::fullscreen_vert;
    pass.fragment = fragment;
    pass.layout = layout;
    pass.color_formats = std::move(color_formats);
    pass.constants = std::move(constants);
    return pass;
}

OwnedPipeline make_fullscreen_pipeline(Gpu& gpu, std::span<const std::uint32_t> fragment,
                                       VkPipelineLayout layout, std::vector<VkFormat> color_formats,
                                       std::vector<ShaderConstant> constants) {
    return make_graphics_pipeline(
        gpu, fullscreen_pass(fragment, layout, std::move(color_formats), std::move(constants)));
}

OwnedPipeline make_compute_pipeline(Gpu& gpu, std::span<const std::uint32_t> code, VkPipelineLayout layout,
                                    std::vector<ShaderConstant> constants) {
    const Specialization specialization(constants);
    const OwnedShaderModule shader_module = make_module(gpu, code);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = stage_info(VK_SHADER_STAGE_COMPUTE_BIT, shader_module.get(), specialization);
    info.layout = layout;
    VkPipeline pipeline = VK_NULL_HANDLE;
    check_vulkan(vkCreateComputePipelines(gpu.device(), VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
                 "building a compute pipeline");
    return {gpu.device(), pipeline};
}

void begin_rendering(VkCommandBuffer commands, VkExtent2D extent, std::span<const ColorTarget> color,
                     const DepthTarget* depth) {
    std::vector<VkRenderingAttachmentInfo> attachments;
    for (const ColorTarget& target : color) {
        VkRenderingAttachmentInfo attachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
        attachment.imageView = target.view;
        attachment.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        attachment.loadOp = target.clear     ? VK_ATTACHMENT_LOAD_OP_CLEAR
                            : target.discard ? VK_ATTACHMENT_LOAD_OP_DONT_CARE
                                             : VK_ATTACHMENT_LOAD_OP_LOAD;
        attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        attachment.clearValue.color = target.clear_value;
        attachments.push_back(attachment);
    }
    VkRenderingAttachmentInfo depth_attachment{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea = {{0, 0}, extent};
    info.layerCount = 1;
    info.colorAttachmentCount = static_cast<std::uint32_t>(attachments.size());
    info.pColorAttachments = attachments.data();
    if (depth != nullptr) {
        depth_attachment.imageView = depth->view;
        depth_attachment.imageLayout = depth->read_only ? VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL
                                                        : VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
        depth_attachment.loadOp = depth->clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
        depth_attachment.storeOp =
            depth->read_only ? VK_ATTACHMENT_STORE_OP_NONE : VK_ATTACHMENT_STORE_OP_STORE;
        depth_attachment.clearValue.depthStencil = {depth->clear_depth, 0};
        info.pDepthAttachment = &depth_attachment;
    }
    vkCmdBeginRendering(commands, &info);
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height),
                              0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &info.renderArea);
}

void draw_fullscreen(VkCommandBuffer commands, VkPipeline pipeline, VkPipelineLayout layout,
                     std::span<const VkDescriptorSet> sets) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    if (!sets.empty()) {
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0,
                                static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
    }
    vkCmdDraw(commands, 3, 1, 0, 0);
}

PassTimer::PassTimer(Gpu& gpu, std::uint32_t most_passes) : device_(gpu.device()), most_passes_(most_passes) {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(gpu.physical_device(), &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(gpu.physical_device(), &count, families.data());
    const std::uint32_t valid_bits = families[gpu.queue_family()].timestampValidBits;
    if (valid_bits == 0) return;
    valid_bits_mask_ = valid_bits == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << valid_bits) - 1;
    ms_per_tick_ = gpu.limits().timestampPeriod * 1e-6;
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = 2 * most_passes;
    VkQueryPool queries = VK_NULL_HANDLE;
    check_vulkan(vkCreateQueryPool(device_, &info, nullptr, &queries), "creating timers");
    queries_ = {device_, queries};
}

void PassTimer::reset(VkCommandBuffer commands) {
    names_.clear();
    if (queries_) vkCmdResetQueryPool(commands, queries_.get(), 0, 2 * most_passes_);
}

void PassTimer::start(VkCommandBuffer commands, std::string name) {
    assert(names_.size() < most_passes_);
    if (queries_) {
        vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(),
                             static_cast<std::uint32_t>(2 * names_.size()));
    }
    names_.push_back(std::move(name));
}

void PassTimer::stop(VkCommandBuffer commands) {
    if (queries_) {
        vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(),
                             static_cast<std::uint32_t>(2 * names_.size() - 1));
    }
}

std::vector<std::uint64_t> PassTimer::read() const {
    std::vector<std::uint64_t> ticks(2 * names_.size());
    if (!queries_ || ticks.empty()) return {};
    check_vulkan(
        vkGetQueryPoolResults(device_, queries_.get(), 0, static_cast<std::uint32_t>(ticks.size()),
                              ticks.size() * sizeof(std::uint64_t), ticks.data(), sizeof(std::uint64_t),
                              VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "reading timers");
    return ticks;
}

std::vector<PassTimer::Pass> PassTimer::passes() const {
    const std::vector<std::uint64_t> ticks = read();
    std::vector<Pass> passes;
    for (std::size_t i = 0; 2 * i < ticks.size(); ++i) {
        const double ms =
            static_cast<double>((ticks[2 * i + 1] - ticks[2 * i]) & valid_bits_mask_) * ms_per_tick_;
        const auto same = std::ranges::find(passes, names_[i], &Pass::name);
        if (same == passes.end()) {
            passes.push_back({names_[i], ms});
        } else {
            same->ms += ms;
        }
    }
    return passes;
}

double PassTimer::total_ms() const {
    const std::vector<std::uint64_t> ticks = read();
    if (ticks.empty()) return 0;
    return static_cast<double>((ticks.back() - ticks.front()) & valid_bits_mask_) * ms_per_tick_;
}

}  // namespace parafovea
