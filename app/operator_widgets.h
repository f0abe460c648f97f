// What the operator reads and presses, drawn with Dear ImGui: needs no window of its own.
#pragma once

#include <array>
#include <stop_token>

#include "app/operator_board.h"
#include "devices/geometry.h"

namespace parafovea {

// Where in the window the participant's picture is repeated.
struct PreviewPlace {
    float left = 0, top = 0, scale = 1;
    float width = 0, height = 0;
};
PreviewPlace preview_place(SizePx picture, SizePx window);

// Every request goes to the board; keys do all that the mouse can (see OperatorConsole).
class OperatorWidgets {
  public:
    // Borrows the board for its lifetime. `picture` is what the participant sees; `stop` ends the session.
    OperatorWidgets(OperatorBoard& board, const ViewGeometry& picture, std::stop_source stop);

    // Between ImGui::NewFrame() and ImGui::Render(), in a window of this size.
    void draw(const OperatorView& view, SizePx window);

  private:
    void draw_buttons(const OperatorView& view);

    OperatorBoard& board_;
    ViewGeometry picture_;
    std::stop_source stop_;
    std::array<char, 400> note_{};
};

}  // namespace parafovea
