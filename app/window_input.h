// Keyboard, gamepad and mouse of a window, as controllers and as gaze.
#pragma once

#include <array>
#include <mutex>
#include <vector>

#include "devices/clock.h"
#include "devices/controller_source.h"
#include "devices/gaze_source.h"
#include "devices/geometry.h"

struct GLFWwindow;

namespace parafovea {

// The main thread polls; the session's thread drains the three sources. A key's or button's time is that of
// the poll that saw it, its error the time since the poll before.
class WindowInput {
  public:
    // Listens to the keys of the window. `picture` is what the window shows (see placement_of).
    WindowInput(GLFWwindow* window, const ViewGeometry& picture, Clock& clock);
    ~WindowInput();
    WindowInput(const WindowInput&) = delete;
    WindowInput& operator=(const WindowInput&) = delete;

    // Main thread, after the window system's events were processed.
    void poll();

    // Letters A, B, X, Y, the arrow keys, left and right shift (shoulders), Tab (view) and Enter (menu).
    ControllerSource& keyboard() { return keyboard_; }
    // The first gamepad that GLFW knows, by its place on an Xbox pad.
    ControllerSource& gamepad() { return gamepad_; }
    // Where the mouse points on the picture, as gaze; lost outside the window.
    GazeSource& mouse() { return mouse_; }

  private:
    class Buttons final : public ControllerSource {
      public:
        explicit Buttons(const char* name) : name_(name) {}
        void add(const ControllerEvent& event);
        void drain(std::vector<ControllerEvent>& events) override;
        std::string description() const override { return name_; }

      private:
        const char* name_;
        std::mutex mutex_;
        std::vector<ControllerEvent> waiting_;
    };
    class Mouse final : public GazeSource {
      public:
        void add(const GazeSample& sample);
        void drain(std::vector<GazeSample>& samples) override;
        std::string description() const override { return "mouse, polled at 120 Hz"; }

      private:
        std::mutex mutex_;
        std::vector<GazeSample> waiting_;
    };

    static void on_key(GLFWwindow* window, int key, int scancode, int action, int modifiers);
    void poll_gamepad(HostTime now);
    void poll_mouse(HostTime now);

    GLFWwindow* window_;
    ViewGeometry picture_;
    Clock& clock_;
    Buttons keyboard_{"keyboard of the participant's window"};
    Buttons gamepad_{"gamepad through GLFW"};
    Mouse mouse_;
    HostTime last_poll_, last_mouse_;
    std::int64_t mouse_sequence_ = 0;
    bool pad_connected_ = false;
    std::array<bool, 12> pad_down_{};  // by Button
};

}  // namespace parafovea
