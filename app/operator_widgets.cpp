// Lays out the operator's window.
#include "app/operator_widgets.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace parafovea {

namespace {

constexpr float kMargin = 12;
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
        case OperatorRequest::abort:
            return "abort";
    }
    return "";
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
    if (view.drift && view.drift->mean_accuracy_deg)
        colored_row("drift", view.drift->accepted,
                    number_text("%.2f\u00b0", *view.drift->mean_accuracy_deg) +
                        (view.drift->accepted ? "" : ": recalibrate"));
    else if (view.drift)
        colored_row("drift", false, "no gaze on the target: recalibrate");
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

PreviewPlace preview_place(SizePx picture, SizePx window) {
    PreviewPlace place;
    place.scale = static_cast<float>(
        std::min({1.0, 0.48 * window.width / picture.width, 0.5 * window.height / picture.height}));
    place.left = place.top = kMargin;
    place.width = std::floor(place.scale * static_cast<float>(picture.width));
    place.height = std::floor(place.scale * static_cast<float>(picture.height));
    return place;
}

OperatorWidgets::OperatorWidgets(OperatorBoard& board, const ViewGeometry& picture, std::stop_source stop)
    : board_(board), picture_(picture), stop_(std::move(stop)) {}

void OperatorWidgets::draw_buttons(const OperatorView& view) {
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
            board_.ask(choice.request);
    }
    if (ImGui::Button("Abort (Ctrl+Q)") || (control && ImGui::IsKeyPressed(GLFW_KEY_Q, false)))
        ImGui::OpenPopup("Abort the session?");
    if (ImGui::BeginPopupModal("Abort the session?", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
        ImGui::TextUnformatted("The running trial is broken off; the session can be resumed.");
        if (ImGui::Button("Abort (Enter)") || ImGui::IsKeyPressed(GLFW_KEY_ENTER, false)) {
            // The session finds the request when it has stopped, and logs who stopped it.
            board_.ask(OperatorRequest::abort);
            stop_.request_stop();
            ImGui::CloseCurrentPopup();
        }
        ImGui::SameLine();
        if (ImGui::Button("Go on (Escape)") || ImGui::IsKeyPressed(GLFW_KEY_ESCAPE, false))
            ImGui::CloseCurrentPopup();
        ImGui::EndPopup();
    }

    if (!typing && !control && ImGui::IsKeyReleased(GLFW_KEY_N)) ImGui::SetKeyboardFocusHere();
    ImGui::SetNextItemWidth(-160);
    if (ImGui::InputTextWithHint("##note", "Note (N), Enter stores it with the time", note_.data(),
                                 note_.size(), ImGuiInputTextFlags_EnterReturnsTrue) &&
        note_[0] != '\0') {
        board_.write_note(note_.data());
        note_.fill('\0');
    }
    ImGui::SameLine();
    if (view.asked != OperatorRequest::none)
        ImGui::TextColored(kGood, "next: %s", request_name(view.asked));
    else if (stop_.stop_requested())
        ImGui::TextColored(kBad, "stopping");
    else
        ImGui::TextUnformatted("");
}

void OperatorWidgets::draw(const OperatorView& view, SizePx window) {
    const PreviewPlace place = preview_place(picture_.size, window);
    const float width = static_cast<float>(window.width), height = static_cast<float>(window.height);
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
    draw_gaze(view, picture_, place);
}

}  // namespace parafovea
