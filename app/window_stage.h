// A stage in a window of the desktop: real time, on the display's own refresh or, where it has none, on the
// clock.
#pragma once

#include <cstdint>
#include <list>
#include <optional>
#include <string>

#include "app/headless_stage.h"
#include "app/participant_pages.h"
#include "app/picture_source.h"
#include "app/window_picture.h"
#include "app/window_surface.h"
#include "app/window_timing.h"
#include "study/protocol.h"
#include "study/stage.h"
#include "study/trial_plan.h"

namespace parafovea {

class WindowStage final : public Stage {
  public:
    // Borrows all but the monitor for its lifetime; there need be no audience. Measures the display's rate
    // for about a second. A monitor that reports no rate, or does not hold its pictures to it, is paced by
    // the clock at the protocol's rate. The window does not change its size; a stage is used by one thread.
    WindowStage(WindowSurface& surface, const Monitor& monitor, const Protocol& protocol, Clock& clock,
                PictureSource& pictures, Audience* audience);

    // Every frame of a stimulus has the hash of its picture. Paced by the clock, a picture that is on the
    // screen already stays there and is not sent again.
    ShownFrame show(const Picture& picture) override;

    double refresh_hz() const override { return refresh_hz_; }
    ViewGeometry view() const override { return protocol_.display.view; }

    // Makes everything ready that a trial will show, before its first frame, as far as it is known: with
    // tracked foveation each frame's stimulus is drawn when its gaze is known.
    void prepare(const PlannedTrial& trial);

    // The share of the session that is done, for pages of text.
    void set_progress(double share) { progress_ = share; }

    // For the log, e.g. "window 1280 x 1440 at 60.00 Hz (measured), scale 1.00".
    std::string description() const;
    bool paced_by_clock() const { return paced_.has_value(); }
    double scale() const;

  private:
    struct Ready {
        std::string name;  // of what is shown
        GpuImage image;
        std::optional<std::uint64_t> hash;
    };

    const Ready& make_ready(const Picture& picture);
    void fill_with(Ready& ready, const Picture& picture, const std::string& name);
    void present(const Ready& ready, std::optional<bool> patch);
    void measure_refresh(const Monitor& monitor);

    WindowSurface& surface_;
    const Protocol& protocol_;
    Clock& clock_;
    PictureSource& pictures_;
    Audience* audience_;
    ParticipantPages pages_;
    std::list<Ready> ready_;  // the last one used in front
    WindowPicture window_picture_;
    std::string on_screen_;
    std::optional<bool> patch_on_screen_;
    double refresh_hz_ = 0;
    std::optional<PacedRefreshes> paced_;
    std::optional<ObservedRefreshes> observed_;
    std::int64_t next_index_ = 0;
    double progress_ = 0;
};

}  // namespace parafovea
