// Lets a view's frames go through its own history.
#include "renderer/temporal_view.h"

namespace parafovea {

MovingView::MovingView(FrameRenderer& renderer)
    : renderer_(renderer), filter_(renderer.gpu(), FrameRenderer::kTargetFormat) {}

RenderedFrame MovingView::render(SizePx size, const CameraView& view, const RenderMethod& method,
                                 PointPx gaze, bool read_pixels) {
    return renderer_.render_next(filter_, size, view, method, gaze, read_pixels);
}

}  // namespace parafovea
