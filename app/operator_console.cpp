// Draws the operator's window with Dear ImGui.
#include "app/operator_console.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <span>

#include "app/participant_pages.h"

namespace parafovea {

namespace {

using SteadyTime = std::chrono::steady_clock::time_point;
constexpr std::chrono::milliseconds kBetweenDraws{100};
constexpr float kFontPx = 17, kMargin = 12;
constexpr VkImageSubresourceRange kColor{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
const ImVec4 kGood{0.55f, 0.85f, 0.55f, 1}, kBad{1.0f, 0.5f, 0.4f, 1}, kDim{0.6f, 0.6f, 0.6f, 1};

const char* request_name(OperatorRequest request) {
    switch (request) {
        case OperatorRequest::none:
            return "";
        case OperatorRequest::pause:
            return "pause";
        case OperatorRequest::proceed:
            return "continue";
        case OperatorRequest::rest:
            return "rest";
        case OperatorRequest::repeat_last:
            return "repeat the last trial";
        case OperatorRequest::recalibrate:
            return "recalibrate";
    }
    return "";
}

// Where in the window the participant's picture is repeated.
struct PreviewPlace {
    float left = 0, top = 0, scale = 1;
    float width = 0, height = 0;
};

PreviewPlace preview_place(SizePx picture, SizePx window) {
    PreviewPlace place;
    place.scale = static_cast<float>(
        std::min({1.0, 0.48 * window.width / picture.width, 0.5 * window.height / picture.height}));
    place.left = place.top = kMargin;
    place.width = std::floor(place.scale * static_cast<float>(picture.width));
    place.height = std::floor(place.scale * static_cast<float>(picture.height));
    return place;
}

// A line of a name in grey and a value.
template <typename... Values>
void row(const char* name, const char* format, Values... values) {
    ImGui::TextColored(kDim, "%s", name);
    ImGui::SameLine(130);
    if constexpr (sizeof...(values) == 0)
        ImGui::TextUnformatted(format);
    else
        ImGui::Text(format, values...);
}

void colored_row(const char* name, bool good, const std::string& value) {
    ImGui::TextColored(kDim, "%s", name);
    ImGui::SameLine(130);
    ImGui::TextColored(good ? kGood : kBad, "%s", value.c_str());
}

std::string number_text(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

void draw_state(const OperatorView& view) {
    row("state", "%s", view.state.empty() ? "starting" : view.state.c_str());
    if (view.session == 0)
        row("part", "training");
    else
        row("part", "%d of %d", view.session, view.sessions);
    row("trials", "%d of %d settled", view.done, view.total);
    ImGui::ProgressBar(view.total > 0 ? static_cast<float>(view.done) / static_cast<float>(view.total) : 0,
                       ImVec2(-1, 8), "");
    if (view.seconds_left) {
        const int seconds = static_cast<int>(std::min(*view.seconds_left, 359999.0));
        row("time left", "about %d:%02d", seconds / 60, seconds % 60);
    } else {
        row("time left", "not known yet");
    }
    if (view.trial) {
        ImGui::Separator();
        row("trial", "%d, %s", view.trial->number, std::string(kind_name(view.trial->kind)).c_str());
        row("scene", "%s", view.trial->scene.c_str());
        row("first", "%s", to_text(view.trial->first).c_str());
        row("second", "%s", to_text(view.trial->second).c_str());
    }
    ImGui::Separator();
    row("answers", "%d: %d same, %d different", view.answered, view.identical,
        view.answered - view.identical);
    colored_row("validation", view.failed_validations == 0,
                std::to_string(view.failed_validations) + " failed");
    colored_row("invalid", view.invalid == 0, std::to_string(view.invalid) + " trials");
}

void draw_health(const OperatorView& view) {
    colored_row("gaze", !view.gaze_silent,
                view.gaze_silent ? "silent: is the tracker running?"
                                 : number_text("%.0f samples/s", view.gaze_rate_hz));
    colored_row("lost", view.gaze_lost_share < 0.2,
                number_text("%.1f %% of 10 s", 100 * view.gaze_lost_share));
    if (view.calibration && view.calibration->mean_accuracy_deg)
        colored_row("calibration", view.calibration->accepted,
                    number_text("%.2f\u00b0 mean", *view.calibration->mean_accuracy_deg) +
                        number_text(", %.2f\u00b0 worst", view.calibration->worst_accuracy_deg.value_or(0)) +
                        (view.calibration->accepted ? "" : ": recalibrate"));
    else
        row("calibration", "none yet");
    colored_row("controller", view.controller_connected,
                view.controller_connected ? "connected" : "unplugged");

    std::vector<float> frames(view.frame_ms.begin(), view.frame_ms.end());
    const float longest = frames.empty() ? 0 : *std::max_element(frames.begin(), frames.end());
    row("frames", "%.2f Hz, longest of the last %.1f ms", view.refresh_hz, static_cast<double>(longest));
    const float top = 3000.0f / static_cast<float>(std::max(view.refresh_hz, 1.0));
    ImGui::PlotLines("##frames", frames.data(), static_cast<int>(frames.size()), 0, nullptr, 0, top,
                     ImVec2(-1, 50));
    colored_row("missed", view.missed == 0, std::to_string(view.missed) + " refreshes in trials");
}

void draw_answers(const OperatorView& view) {
    if (!ImGui::BeginTable(
            "answers", 5,
            ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingStretchProp))
        return;
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("trial", 0, 1.2f);
    ImGui::TableSetupColumn("compared with full", 0, 4.5f);
    ImGui::TableSetupColumn("answer", 0, 1.4f);
    ImGui::TableSetupColumn("time", 0, 1);
    ImGui::TableSetupColumn("invalid because", 0, 2);
    ImGui::TableHeadersRow();
    for (const AnsweredTrial& answer : view.answers) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::Text("%d", answer.number);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(answer.kind == TrialKind::validation ? "validation"
                                                                    : answer.condition.c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(!answer.identical ? "none" : *answer.identical ? "same" : "different");
        ImGui::TableNextColumn();
        if (answer.identical) ImGui::Text("%.2f s", answer.reaction_s);
        ImGui::TableNextColumn();
        ImGui::TextColored(kBad, "%s", answer.invalid.c_str());
    }
    ImGui::EndTable();
}

void draw_gaze(const OperatorView& view, const ViewGeometry& geometry, const PreviewPlace& place) {
    ImDrawList* lines = ImGui::GetBackgroundDrawList();
    const ImVec2 low{place.left, place.top}, high{place.left + place.width, place.top + place.height};
    lines->AddRect(low, high, IM_COL32(90, 90, 90, 255));
    lines->PushClipRect(low, high);
    for (const GazeSample& sample : view.gaze) {
        if (!sample.direction) continue;
        const PointPx point = geometry.point_from_direction(*sample.direction);
        const ImVec2 at{place.left + place.scale * static_cast<float>(point.x),
                        place.top + place.scale * static_cast<float>(point.y)};
        if (&sample != &view.gaze.back())
            lines->AddCircleFilled(at, 2, IM_COL32(255, 200, 60, 90));
        else
            lines->AddCircle(at, 9, IM_COL32(255, 90, 60, 255), 0, 2.5f);
    }
    lines->PopClipRect();
}

}  // namespace

struct OperatorConsole::Parts {
    WindowSurface& surface;
    OperatorBoard& board;
    PictureSource& pictures;
    const Protocol& protocol;
    std::stop_source stop;

    ParticipantPages pages;
    VkDescriptorPool descriptors = VK_NULL_HANDLE;
    VkRenderPass pass = VK_NULL_HANDLE;
    std::vector<VkImageView> views;
    std::vector<VkFramebuffer> framebuffers;
    int generation = 0;
    GpuImage preview;
    std::string previewed;
    std::array<char, 400> note{};
    SteadyTime last_draw;

    VkDevice device() const { return surface.gpu().device(); }

    void make_pass();
    void make_framebuffers();
    void destroy_framebuffers();
    void make_imgui();
    void update_preview(const Picture& picture);
    void draw_buttons(const OperatorView& view);
    void draw_widgets(const OperatorView& view, const PreviewPlace& place);
    void record(VkCommandBuffer commands, VkImage target, const PreviewPlace& place);
};

OperatorConsole::OperatorConsole(WindowSurface& surface, OperatorBoard& board, PictureSource& pictures,
                                 const Protocol& protocol, std::stop_source stop)
    : parts_(new Parts{surface, board, pictures, protocol, std::move(stop),
                       ParticipantPages(protocol.display.view)}) {
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

void OperatorConsole::Parts::draw_buttons(const OperatorView& view) {
    struct Choice {
        const char* label;
        int key;
        OperatorRequest request;
    };
    constexpr std::array<Choice, 5> kChoices = {
        {{"Pause (P)", GLFW_KEY_P, OperatorRequest::pause},
         {"Continue (C)", GLFW_KEY_C, OperatorRequest::proceed},
         {"Rest (R)", GLFW_KEY_R, OperatorRequest::rest},
         {"Repeat last (L)", GLFW_KEY_L, OperatorRequest::repeat_last},
         {"Recalibrate (K)", GLFW_KEY_K, OperatorRequest::recalibrate}}};
    const bool typing = ImGui::GetIO().WantTextInput, control = ImGui::GetIO().KeyCtrl;
    for (const Choice& choice : kChoices) {
        const bool pressed = ImGui::Button(choice.label);
        ImGui::SameLine();
        if (pressed || (!typing && !control && ImGui::IsKeyPressed(choice.key, false)))
            board.ask(choice.request);
    }
    if (ImGui::Button("Abort (Ctrl+Q)") || (control && ImGui::IsKeyPressed(GLFW_KEY_Q, false)))
        ImGui::OpenPopup("Abort the session?");
    if (ImGui::BeginPopupModal("Abort the session?", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        ImGui::TextUnformatted("The running trial is broken off; the session can be resumed.");
        if (ImGui::Button("Abort (Enter)") || ImGui::IsKeyPressed(GLFW_KEY_ENTER, false)) {
            stop.request_stop();
            ImGui::CloseCurrentPopup();
        }
        ImGui::SameLine();
        if (ImGui::Button("Go on (Escape)") || ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false))
            ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    }

    if (!typing && !control && ImGui::IsKeyReleased(GLFW_KEY_N)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-160);
    if (ImGui::InputTextWithHint("##note", "Note (N), Enter stores it with the time", note.data(),
                                 note.size(), ImGuiInputTextFlags_EnterReturnsTrue) &&
        note[0] != '\0') {
        board.write_note(note.data());
        note.fill('\0');
    }
    ImGui::SameLine();
    if (view.asked != OperatorRequest::none)
        ImGui::TextColored(kGood, "next: %s", request_name(view.asked));
    else if (stop.stop_requested())
        ImGui::TextColored(kBad, "stopping");
    else
        ImGui::TextUnformatted("");
}

void OperatorConsole::Parts::draw_widgets(const OperatorView& view, const PreviewPlace& place) {
    const float width = static_cast<float>(surface.size().width),
                height = static_cast<float>(surface.size().height);
    constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBackground;
    const auto panel = [&](const char* name, float left, float top, float right, float bottom) {
        ImGui::SetNextWindowPos(ImVec2(left, top));
        ImGui::SetNextWindowSize(ImVec2(std::max(right - left, 50.0f), std::max(bottom - top, 50.0f)));
        ImGui::Begin(name, nullptr, kFixed);
    };
    const float middle = place.left + place.width, below = place.top + place.height + kMargin;
    const float buttons_top = height - 100;
    panel("state", middle, 0, width, below);
    draw_state(view);
    ImGui::Separator();
    draw_health(view);
    ImGui::End();
    panel("answers", 0, below, width, buttons_top);
    draw_answers(view);
    ImGui::End();
    panel("requests", 0, buttons_top, width, height);
    draw_buttons(view);
    ImGui::End();
    draw_gaze(view, protocol.display.view, place);
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
    parts.draw_widgets(view, place);
    ImGui::Render();
    parts.surface.present(
        [&](VkCommandBuffer commands, VkImage target) { parts.record(commands, target, place); });
}

}  // namespace parafovea
