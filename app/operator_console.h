// The operator's window: what the session does, how good gaze and frames are, and what the operator may ask
// for.
#pragma once

#include <memory>
#include <stop_token>

#include "app/operator_board.h"
#include "app/picture_source.h"
#include "app/window_surface.h"
#include "study/protocol.h"

namespace parafovea {

// Belongs to the main thread. The participant never sees it. Every request goes to the board, from where the
// session takes and logs it; keys do all that the mouse can: P pause, C continue, R rest, L repeat the last
// trial, K recalibrate, N note, Ctrl+Q abort.
class OperatorConsole {
  public:
    // Borrows all but `stop`, which ends the session, for its lifetime.
    OperatorConsole(WindowSurface& surface, OperatorBoard& board, PictureSource& pictures,
                    const Protocol& protocol, std::stop_source stop);
    ~OperatorConsole();

    // Draws ten times a second at most, so that the session keeps the machine.
    void draw_when_due();

  private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace parafovea
