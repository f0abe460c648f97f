// Turns GLFW's keys, pads and pointer into events and samples.
#include "app/window_input.h"

#include <GLFW/glfw3.h>

#include <optional>
#include <utility>

#include "app/window_surface.h"

namespace parafovea {

namespace {

constexpr Duration kMousePeriod{8'333'333};

std::optional<Button> button_of_key(int key) {
    switch (key) {
        case GLFW_KEY_A:
            return Button::a;
        case GLFW_KEY_B:
            return Button::b;
        case GLFW_KEY_X:
            return Button::x;
        case GLFW_KEY_Y:
            return Button::y;
        case GLFW_KEY_LEFT_SHIFT:
            return Button::left_shoulder;
        case GLFW_KEY_RIGHT_SHIFT:
            return Button::right_shoulder;
        case GLFW_KEY_TAB:
            return Button::view;
        case GLFW_KEY_ENTER:
            return Button::menu;
        case GLFW_KEY_UP:
            return Button::up;
        case GLFW_KEY_DOWN:
            return Button::down;
        case GLFW_KEY_LEFT:
            return Button::left;
        case GLFW_KEY_RIGHT:
            return Button::right;
        default:
            return std::nullopt;
    }
}

constexpr std::array<std::pair<int, Button>, 12> kPadButtons = {{
    {GLFW_GAMEPAD_BUTTON_A, Button::a},
    {GLFW_GAMEPAD_BUTTON_B, Button::b},
    {GLFW_GAMEPAD_BUTTON_X, Button::x},
    {GLFW_GAMEPAD_BUTTON_Y, Button::y},
    {GLFW_GAMEPAD_BUTTON_LEFT_BUMPER, Button::left_shoulder},
    {GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER, Button::right_shoulder},
    {GLFW_GAMEPAD_BUTTON_BACK, Button::view},
    {GLFW_GAMEPAD_BUTTON_START, Button::menu},
    {GLFW_GAMEPAD_BUTTON_DPAD_UP, Button::up},
    {GLFW_GAMEPAD_BUTTON_DPAD_DOWN, Button::down},
    {GLFW_GAMEPAD_BUTTON_DPAD_LEFT, Button::left},
    {GLFW_GAMEPAD_BUTTON_DPAD_RIGHT, Button::right},
}};

}  // namespace

void WindowInput::Buttons::add(const ControllerEvent& event) {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(event);
}

void WindowInput::Buttons::drain(std::vector<ControllerEvent>& events) {
    const std::scoped_lock lock(mutex_);
    events.insert(events.end(), waiting_.begin(), waiting_.end());
    waiting_.clear();
}

void WindowInput::Mouse::add(const GazeSample& sample) {
    const std::scoped_lock lock(mutex_);
    waiting_.push_back(sample);
}

void WindowInput::Mouse::drain(std::vector<GazeSample>& samples) {
    const std::scoped_lock lock(mutex_);
    samples.insert(samples.end(), waiting_.begin(), waiting_.end());
    waiting_.clear();
}

WindowInput::WindowInput(GLFWwindow* window, const ViewGeometry& picture, Clock& clock)
    : window_(window), picture_(picture), clock_(clock), last_poll_(clock.now()), last_mouse_(last_poll_) {
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, on_key);
}

WindowInput::~WindowInput() {
    glfwSetKeyCallback(window_, nullptr);
    glfwSetWindowUserPointer(window_, nullptr);
}

void WindowInput::on_key(GLFWwindow* window, int key, int, int action, int) {
    WindowInput& input = *static_cast<WindowInput*>(glfwGetWindowUserPointer(window));
    const std::optional<Button> button = button_of_key(key);
    if (!button || action == GLFW_REPEAT) return;
    const HostTime now = input.clock_.now();
    const ControllerEventKind kind =
        action == GLFW_PRESS ? ControllerEventKind::press : ControllerEventKind::release;
    input.keyboard_.add({kind, *button, now, now - input.last_poll_});
}

void WindowInput::poll() {
    const HostTime now = clock_.now();
    poll_gamepad(now);
    poll_mouse(now);
    last_poll_ = now;
}

void WindowInput::poll_gamepad(HostTime now) {
    GLFWgamepadstate state{};
    bool connected = false;
    for (int pad = GLFW_JOYSTICK_1; pad <= GLFW_JOYSTICK_LAST && !connected; ++pad)
        connected = glfwGetGamepadState(pad, &state) == GLFW_TRUE;
    const Duration error = now - last_poll_;
    if (connected != pad_connected_) {
        gamepad_.add({connected ? ControllerEventKind::connected : ControllerEventKind::disconnected,
                      Button::a, now, error});
        pad_connected_ = connected;
        pad_down_ = {};
    }
    if (!connected) return;
    for (const auto& [index, button] : kPadButtons) {
        const bool down = state.buttons[index] == GLFW_PRESS;
        bool& was_down = pad_down_[static_cast<std::size_t>(button)];
        if (down == was_down) continue;
        was_down = down;
        gamepad_.add({down ? ControllerEventKind::press : ControllerEventKind::release, button, now, error});
    }
}

void WindowInput::poll_mouse(HostTime now) {
    if (now - last_mouse_ < kMousePeriod) return;
    last_mouse_ = now;
    double x = 0, y = 0;
    int width = 0, height = 0;
    glfwGetCursorPos(window_, &x, &y);
    glfwGetWindowSize(window_, &width, &height);

    GazeSample sample;
    sample.sequence = mouse_sequence_++;
    sample.device_time = {now.ns};
    sample.host_time = sample.arrival_time = now;
    sample.host_time_error = now - last_poll_;
    if (x >= 0 && y >= 0 && x < width && y < height) {
        const Placement place = placement_of(picture_.size, {width, height});
        sample.status = GazeStatus::tracked;
        sample.direction = picture_.direction_from_point(
            {(x - place.left_px) / place.scale, (y - place.top_px) / place.scale});
    }
    mouse_.add(sample);
}

}  // namespace parafovea
