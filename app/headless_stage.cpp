// Keeps the refresh rate of a display that is not there.
#include "app/headless_stage.h"

#include "app/photodiode_patch.h"

namespace parafovea {

HeadlessStage::HeadlessStage(const ViewGeometry& view, double refresh_hz, Clock& clock,
                             PictureSource& pictures, Audience& audience)
    : view_(view),
      refresh_hz_(refresh_hz),
      clock_(clock),
      pictures_(pictures),
      audience_(audience),
      start_(clock.now()) {}

ShownFrame HeadlessStage::show(const Picture& picture) {
    ShownFrame shown;
    shown.index = next_index_++;
    // From the start and not from the last frame, so that rounding to nanoseconds never adds up.
    shown.display_time = start_ + Duration::from_seconds(static_cast<double>(next_index_) / refresh_hz_);
    shown.time_source = TimeSource::simulated;
    clock_.wait_until(shown.display_time);

    if (audience_.looks_at(picture, shown.display_time) && picture.kind == PictureKind::stimulus) {
        RenderedPicture rendered = pictures_.picture(picture.scene, picture.method, picture.fovea);
        // The hash is of the stimulus, as on every other stage.
        shown.image_hash = rendered.hash;
        if (picture.patch) draw_patch(rendered.rgba, rendered.size, patch_side_px(view_), *picture.patch);
        audience_.sees(rendered, shown.display_time);
    }
    return shown;
}

}  // namespace parafovea
