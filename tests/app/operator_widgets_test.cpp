// Every request of the operator, by mouse and by key, from the press to the row in the session file.
#include "app/operator_widgets.h"

#include <GLFW/glfw3.h>
#include <gmock/gmock.h>
#include <imgui.h>
#include <imgui_internal.h>

#include <functional>
#include <string>

#include "app/operator_board.h"
#include "study/session_log_reader.h"
#include "tests/study/lab.h"

namespace parafovea {
namespace {

using testing::ElementsAre;

// The console's widgets in a window that is not there, and a hand on its mouse and keys.
class Console {
  public:
    Console(OperatorBoard& board, std::stop_source stop)
        : board_(board), widgets_(board, {{1280, 1440}, 76.7}, std::move(stop)) {
        ImGui::CreateContext();
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = ImVec2(1280, 1080);
        io.DeltaTime = 0.1f;
        io.KeyMap[ImGuiKey_Enter] = GLFW_KEY_ENTER;
        unsigned char* pixels = nullptr;
        int width = 0, height = 0;
        io.Fonts->GetTexDataAsRGBA32(&pixels, &width, &height);
        draw();
    }
    Console(const Console&) = delete;
    ~Console() { ImGui::DestroyContext(); }

    void draw() {
        ImGui::NewFrame();
        widgets_.draw(board_.view(), {1280, 1080});
        ImGui::Render();
    }

    // Moves the mouse until it is over the button, as a hand would, and clicks. False if there is none.
    bool click(const char* label) {
        ImGuiIO& io = ImGui::GetIO();
        for (float y = 0; y < 1080; y += 8)
            for (float x = 0; x < 1280; x += 8) {
                io.MousePos = ImVec2(x, y);
                // Hovering is worked out while drawing; only windows under the mouse can have the button.
                ImGui::UpdateHoveredWindowAndCaptureFlags();
                ImGuiWindow* window = ImGui::GetCurrentContext()->HoveredWindow;
                if (!window || (std::string_view(window->Name) != "requests" &&
                                std::string_view(window->Name) != "Abort the session?"))
                    continue;
                draw();
                if (ImGui::GetCurrentContext()->HoveredId != window->GetID(label)) continue;
                io.MouseDown[0] = true;
                draw();
                io.MouseDown[0] = false;
                draw();
                io.MousePos = ImVec2(-1, -1);
                draw();
                return true;
            }
        return false;
    }

    void press(int key, bool control = false) {
        ImGuiIO& io = ImGui::GetIO();
        io.KeyCtrl = control;
        io.KeysDown[key] = true;
        draw();
        io.KeysDown[key] = false;
        io.KeyCtrl = false;
        draw();
    }

    void type(const char* text) {
        draw();  // a field that was asked to take the focus has it one frame later
        ImGui::GetIO().AddInputCharactersUTF8(text);
        draw();
    }

  private:
    OperatorBoard& board_;
    OperatorWidgets widgets_;
};

TEST(OperatorWidgets, EachButtonAndEachKeyAsksForItsRequest) {
    SteadyClock clock;
    OperatorBoard board(clock);
    Console console(board, std::stop_source());
    const std::tuple<const char*, int, OperatorRequest> requests[] = {
        {"Pause (P)", GLFW_KEY_P, OperatorRequest::pause},
        {"Continue (C)", GLFW_KEY_C, OperatorRequest::proceed},
        {"Rest (R)", GLFW_KEY_R, OperatorRequest::rest},
        {"Repeat last (L)", GLFW_KEY_L, OperatorRequest::repeat_last},
        {"Recalibrate (K)", GLFW_KEY_K, OperatorRequest::recalibrate}};
    for (const auto& [label, key, request] : requests) {
        EXPECT_EQ(board.take_request(), OperatorRequest::none);
        ASSERT_TRUE(console.click(label)) << label;
        EXPECT_EQ(board.take_request(), request) << label;
        console.press(key);
        EXPECT_EQ(board.take_request(), request) << label;
    }
}

TEST(OperatorWidgets, ANoteIsTypedWithoutItsLettersBeingTakenForRequests) {
    SteadyClock clock;
    OperatorBoard board(clock);
    Console console(board, std::stop_source());
    console.press(GLFW_KEY_N);
    console.type("rubs his eyes");
    console.press(GLFW_KEY_P);  // while typing, the key is a letter
    EXPECT_EQ(board.take_request(), OperatorRequest::none);
    console.press(GLFW_KEY_ENTER);
    const auto notes = board.take_notes();
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_EQ(notes[0].second, "rubs his eyes");
}

TEST(OperatorWidgets, AbortAsksFirst) {
    SteadyClock clock;
    OperatorBoard board(clock);
    std::stop_source stop;
    Console console(board, stop);
    console.press(GLFW_KEY_Q, true);
    EXPECT_FALSE(stop.stop_requested());
    ASSERT_TRUE(console.click("Go on (Escape)"));
    EXPECT_FALSE(stop.stop_requested());
    ASSERT_TRUE(console.click("Abort (Ctrl+Q)"));
    ASSERT_TRUE(console.click("Abort (Enter)"));
    EXPECT_TRUE(stop.stop_requested());
    EXPECT_EQ(board.take_request(), OperatorRequest::abort);
}

TEST(OperatorWidgets, EveryRequestOfASessionIsServedAndLogged) {
    TemporaryFolder folder;
    {
        SessionLog log = test::start(folder / "s.sqlite");
        test::ProgramRun run;
        OperatorBoard board(run.clock);
        std::stop_source stop;
        Console console(board, stop);
        std::string state;
        int trials = 0;
        SessionHooks hooks;
        hooks.stop = stop.get_token();
        hooks.on_progress = [&](const SessionProgress& progress) {
            board.set_progress(progress);
            state = progress.state;
            if (state != "trial") return;
            const auto ask = [&](const char* label) { EXPECT_TRUE(console.click(label)) << label; };
            switch (++trials) {
                case 1:
                    return ask("Pause (P)");
                case 2:
                    return ask("Rest (R)");
                case 3:
                    return ask("Repeat last (L)");
                case 4:
                    return ask("Recalibrate (K)");
                case 5:
                    console.press(GLFW_KEY_N);
                    console.type("yawns");
                    return console.press(GLFW_KEY_ENTER);
                case 6:
                    ask("Abort (Ctrl+Q)");
                    return ask("Abort (Enter)");
                default:
                    return;
            }
        };
        hooks.on_trial = [&](const TrialRecord& record) { board.add_trial(record); };
        hooks.operator_request = [&] {
            if (state == "paused") {
                EXPECT_TRUE(console.click("Continue (C)"));
            }
            for (auto& [time, note] : board.take_notes()) log.append_note(time, note);
            return board.take_request();
        };
        hooks.calibrate = [] {
            CalibrationRecord record;
            record.accepted = true;
            return record;
        };
        EXPECT_EQ(run.go(log, hooks), SessionEnd::stopped);
        EXPECT_EQ(trials, 6);
    }
    const SessionRows rows = read_session(folder / "s.sqlite");
    std::vector<std::string> events;
    for (const EventRow& event : rows.events)
        if (event.kind != "page") events.push_back(event.kind + ": " + event.detail);
    EXPECT_THAT(events, ElementsAre("paused: by the operator", "pause ended: by the operator",
                                    "rest: by the operator", testing::StartsWith("repeat: trial"),
                                    "recalibration: by the operator", "stopped: by the operator"));
    ASSERT_EQ(rows.notes.size(), 1u);
    EXPECT_EQ(rows.notes[0].detail, "yawns");
    EXPECT_EQ(rows.calibrations.size(), 2u) << "one at the start, one on request";
    EXPECT_TRUE(rows.trials.back().interrupted) << "the abort broke off a trial";
}

}  // namespace
}  // namespace parafovea
