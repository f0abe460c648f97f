// A view that moves: frame after frame of one eye, each anti-aliased with what came before it.
#pragma once

#include "renderer/frame_renderer.h"
#include "renderer/temporal_filter.h"

namespace parafovea {

// Borrows a renderer; several views (one for each eye) may take turns with one. A method without `taa` is
// drawn as FrameRenderer::render() draws it.
class MovingView {
  public:
    explicit MovingView(FrameRenderer& renderer);

    // Draws the next frame; arguments and errors as of FrameRenderer::render(). The picture depends on the
    // frames since the last cut, and on nothing else. Another size is a cut; another method is not.
    RenderedFrame render(SizePx size, const CameraView& view, const RenderMethod& method, PointPx gaze,
                         bool read_pixels = true);

    // The next frame shows something else: nothing of the past is kept.
    void cut() { filter_.cut(); }

  private:
    FrameRenderer& renderer_;
    TemporalFilter filter_;
};

}  // namespace parafovea
