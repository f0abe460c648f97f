// A stage without a display: it keeps a refresh rate on a clock, simulated or real, and renders the frames
// that its audience looks at.
#pragma once

#include "app/picture_source.h"
#include "devices/clock.h"
#include "study/stage.h"

namespace parafovea {

// Whoever sits in front of a headless stage.
class Audience {
  public:
    virtual ~Audience() = default;

    // Called for every frame; true when this frame must be rendered, which only a stimulus can be.
    virtual bool looks_at(const Picture& picture, HostTime display_time) = 0;

    // The rendered frame with its photodiode patch, after looks_at said true.
    virtual void sees(const RenderedPicture& picture, HostTime display_time) = 0;
};

class HeadlessStage final : public Stage {
  public:
    // Borrows all three for its lifetime.
    HeadlessStage(const ViewGeometry& view, double refresh_hz, Clock& clock, PictureSource& pictures,
                  Audience& audience);

    // A frame that nobody looks at costs nothing and has no image hash.
    ShownFrame show(const Picture& picture) override;

    double refresh_hz() const override { return refresh_hz_; }
    ViewGeometry view() const override { return view_; }

  private:
    ViewGeometry view_;
    double refresh_hz_;
    Clock& clock_;
    PictureSource& pictures_;
    Audience& audience_;
    HostTime start_;
    std::int64_t next_index_ = 0;
};

}  // namespace parafovea
