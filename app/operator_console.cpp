// Draws the operator's window with Dear ImGui.
#include "app/operator_console.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include "app/operator_widgets.h"
#include "app/participant_pages.h"

namespace parafovea {

namespace {

using SteadyTime = std::chrono::steady_clock::time_point;
constexpr std::chrono::milliseconds kBetweenDraws{100};
constexpr float kFontPx = 17;
constexpr VkImageSubresourceRange kColor{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

}  // namespace

struct OperatorConsole::Parts {
    WindowSurface& surface;
    OperatorBoard& board;
    PictureSource& pictures;
    const Protocol& protocol;

    ParticipantPages pages;
    OperatorWidgets widgets;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    VkRenderPass pass = VK_NULL_HANDLE;
    std::vector<VkImageView> views;
    std::vector<VkFramebuffer> framebuffers;
    int generation = 0;
    GpuImage preview;
    std::string previewed;
    SteadyTime last_draw;

    VkDevice device() const { return surface.gpu().device(); }

    void make_pass();
    void make_framebuffers();
    void destroy_framebuffers();
    void make_imgui();
    void update_preview(const Picture& picture);
    void record(VkCommandBuffer commands, VkImage target, const PreviewPlace& place);
};

OperatorConsole::OperatorConsole(WindowSurface& surface, OperatorBoard& board, PictureSource& pictures,
                                 const Protocol& protocol, std::stop_source stop)
    : parts_(new Parts{surface, board, pictures, protocol, ParticipantPages(protocol.display.view),
                       OperatorWidgets(board, protocol.display.view, std::move(stop))}) {
    ImageDescription description;
    description.width = static_cast<std::uint32_t>(protocol.display.view.size.width);
    description.height = static_cast<std::uint32_t>(protocol.display.view.size.height);
    description.usage =
        VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    description.mip_levels = 3;
    while (std::min(description.width, description.height) >> (description.mip_levels - 1) == 0)
        --description.mip_levels;
    parts_->preview = GpuImage(surface.gpu(), description);
    parts_->make_pass();
    parts_->make_framebuffers();
    parts_->make_imgui();
}

OperatorConsole::~OperatorConsole() {
    vkDeviceWaitIdle(parts_->device());
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    parts_->destroy_framebuffers();
    vkDestroyRenderPass(parts_->device(), parts_->pass, nullptr);
    vkDestroyDescriptorPool(parts_->device(), parts_->descriptors, nullptr);
}

void OperatorConsole::Parts::make_pass() {
    VkAttachmentDescription color{};
    color.format = surface.format();
    color.samples = VK_SAMPLE_COUNT_1_BIT;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;  // over the preview
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    color.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    color.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    color.initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    info.attachmentCount = 1;
    info.pAttachments = &color;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    check_vulkan(vkCreateRenderPass(device(), &info, nullptr, &pass), "making the console's pass");
}

void OperatorConsole::Parts::make_framebuffers() {
    destroy_framebuffers();
    for (const VkImage image : surface.images()) {
        VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
        view.image = image;
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = surface.format();
        view.subresourceRange = kColor;
        views.emplace_back();
        check_vulkan(vkCreateImageView(device(), &view, nullptr, &views.back()),
                     "making the console's pictures");
        VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
        info.renderPass = pass;
        info.attachmentCount = 1;
        info.pAttachments = &views.back();
        info.width = static_cast<std::uint32_t>(surface.size().width);
        info.height = static_cast<std::uint32_t>(surface.size().height);
        info.layers = 1;
        framebuffers.emplace_back();
        check_vulkan(vkCreateFramebuffer(device(), &info, nullptr, &framebuffers.back()),
                     "making the console's pictures");
    }
    generation = surface.generation();
}

void OperatorConsole::Parts::destroy_framebuffers() {
    for (const VkFramebuffer framebuffer : framebuffers) vkDestroyFramebuffer(device(), framebuffer, nullptr);
    for (const VkImageView view : views) vkDestroyImageView(device(), view, nullptr);
    framebuffers.clear();
    views.clear();
}

void OperatorConsole::Parts::make_imgui() {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
    VkDescriptorPoolCreateInfo pool{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    pool.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    pool.maxSets = 8;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    check_vulkan(vkCreateDescriptorPool(device(), &pool, nullptr, &descriptors),
                 "making the console's descriptors");

    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // nothing is left in the folder the program was started in
    io.Fonts->AddFontFromFileTTF(system_font_file().c_str(), kFontPx);
    ImGui::StyleColorsDark();
    ImGui_ImplGlfw_InitForVulkan(surface.window(), true);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = surface.gpu().instance();
    info.PhysicalDevice = surface.gpu().physical_device();
    info.Device = device();
    info.QueueFamily = surface.gpu().queue_family();
    info.Queue = surface.gpu().queue();
    info.DescriptorPool = descriptors;
    info.MinImageCount = 2;
    info.ImageCount = std::max(2u, static_cast<std::uint32_t>(surface.images().size()));
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = [](VkResult result) { check_vulkan(result, "drawing the console"); };
    ImGui_ImplVulkan_Init(&info, pass);
    surface.gpu().submit_and_wait(
        [](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
}

void OperatorConsole::Parts::update_preview(const Picture& picture) {
    const bool stimulus = picture.kind == PictureKind::stimulus;
    const std::string name = std::to_string(static_cast<int>(picture.kind)) + picture.text +
                             (stimulus ? picture.scene + to_text(picture.method) : "") +
                             (stimulus || picture.kind == PictureKind::target
                                  ? std::to_string(picture.fovea.x) + " " + std::to_string(picture.fovea.y)
                                  : "");
    if (name == previewed) return;
    previewed = name;
    // A stimulus has been rendered for the participant already and is remembered.
    const std::vector<std::uint8_t> rgba =
        stimulus ? pictures.picture(picture.scene, picture.method, picture.fovea).rgba
                 : pages.draw(picture).rgba;
    upload(surface.gpu(), preview, std::as_bytes(std::span(rgba)));
    surface.gpu().submit_and_wait(
        [&](VkCommandBuffer commands) { image_barrier(commands, preview, kUseSampled, kUseTransferSource); });
}

void OperatorConsole::Parts::record(VkCommandBuffer commands, VkImage target, const PreviewPlace& place) {
    image_barrier(commands, target, kColor, kUseNone, kUseTransferTarget);
    const VkClearColorValue grey{{0.09f, 0.09f, 0.1f, 1}};
    vkCmdClearColorImage(commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &grey, 1, &kColor);
    image_barrier(commands, target, kColor, kUseTransferTarget, kUseTransferTarget);

    // From the level that is nearest in size, so that nothing flickers.
    const auto level =
        std::min(preview.mip_levels() - 1,
                 static_cast<std::uint32_t>(std::max(0.0f, std::round(-std::log2(place.scale)))));
    VkImageBlit region{};
    region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
    region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = {static_cast<std::int32_t>(preview.extent().width >> level),
                            static_cast<std::int32_t>(preview.extent().height >> level), 1};
    const SizePx window = surface.size();
    region.dstOffsets[0] = {static_cast<std::int32_t>(place.left), static_cast<std::int32_t>(place.top), 0};
    region.dstOffsets[1] = {std::min(static_cast<std::int32_t>(place.left + place.width), window.width),
                            std::min(static_cast<std::int32_t>(place.top + place.height), window.height), 1};
    vkCmdBlitImage(commands, preview.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
    image_barrier(commands, target, kColor, kUseTransferTarget, kUseColorTarget);

    const std::size_t index =
        static_cast<std::size_t>(std::ranges::find(surface.images(), target) - surface.images().begin());
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = pass;
    begin.framebuffer = framebuffers[index];
    begin.renderArea.extent = {static_cast<std::uint32_t>(window.width),
                               static_cast<std::uint32_t>(window.height)};
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
    vkCmdEndRenderPass(commands);
}

void OperatorConsole::draw_when_due() {
    Parts& parts = *parts_;
    const SteadyTime now = std::chrono::steady_clock::now();
    if (now - parts.last_draw < kBetweenDraws) return;
    parts.last_draw = now;

    const OperatorView view = parts.board.view();
    parts.update_preview(view.picture);
    parts.surface.acquire();
    if (parts.generation != parts.surface.generation()) parts.make_framebuffers();
    const PreviewPlace place = preview_place(parts.protocol.display.view.size, parts.surface.size());
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    parts.widgets.draw(view, parts.surface.size());
    ImGui::Render();
    parts.surface.present(
        [&](VkCommandBuffer commands, VkImage target) { parts.record(commands, target, place); });
}

}  // namespace parafovea
