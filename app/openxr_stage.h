// A stage on an OpenXR headset: every eye gets its own picture, foveated at its own gaze point.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include "app/eye_pictures.h"
#include "app/headless_stage.h"
#include "app/participant_pages.h"
#include "devices/clock.h"
#include "devices/openxr/openxr_session.h"
#include "renderer/gpu.h"
#include "study/stage.h"

namespace parafovea {

struct OpenXrStageOptions {
    double gaze_distance_m = 2;    // see Eyes
    bool hash_pictures = false;    // reads every stimulus back; image_hash is then of all views together
    bool validation = false;       // Vulkan's validation layer
    std::stop_token stop;          // ends waiting for a headset that nobody wears
    Audience* audience = nullptr;  // sees what the first view shows; nobody: the participant is a real one
};

// Pictures stay before the eyes, however the head turns, so that the same gaze means the same picture.
// Everything is foveated, drawn and measured on pictures with the headset's own frustums; view() is the
// symmetric picture between the eyes that gaze and targets are given on.
//
// show() draws and hands over one frame, then waits for the turn of the next, so that the gaze drained after
// it is the freshest. A turn that was waited for but is over when show() is called (the program did something
// else meanwhile) shows the picture before once more, and counts as missed. Faults in ShownFrame:
// "display_time_not_positive", "display_time_backwards", "display_time_far_ahead", "session_lost" (a new one
// was made), "headset_off" (taken off, and on again), "not_visible" and "not_focused" (the runtime showed
// something else, or over it), "eyes_moved" (the distance of the eyes was turned to another: eyes() changed),
// "recentred" (by the user; pictures before the eyes do not move, but the participant was busy with it).
class OpenXrStage final : public Stage {
  public:
    // Waits until the headset shows our frames. Throws one line if there is no runtime, headset or device,
    // and if `stop` comes first. The clock must be the host's monotonic one, unless the runtime's pacing is
    // simulated too.
    explicit OpenXrStage(Clock& clock, const OpenXrStageOptions& options = {});
    ~OpenXrStage() override;

    // Loads a scene and builds a method's pipelines before they are needed in time. Throws what loading and
    // rendering throw.
    void prepare(const std::string& scene, const MethodSetting& method);

    // Throws one line if the session ends for good: the user quits in the headset, or it stays lost.
    ShownFrame show(const Picture& picture) override;

    double refresh_hz() const override { return refresh_hz_; }
    ViewGeometry view() const override { return view_; }

    // For the log, e.g. "Simulated FOVE-like headset on Parafovea simulated headset 1.0.0, 2 views of
    // 1280 x 1440 at 70.00 Hz".
    std::string description() const;

    // As they are now. What replay needs to draw the pictures again.
    const Eyes& eyes() const { return eyes_; }

    OpenXrSession& session() { return *session_; }
    const OpenXrInstance& instance() const { return instance_; }
    const Gpu& gpu() const { return gpu_; }

  private:
    struct Page;

    void note(std::string_view fault);
    bool next_turn();
    void recover();
    bool draw_stimulus(const Picture& picture, ShownFrame& shown);
    bool draw_page(const Picture& picture);
    bool hand_over(std::size_t view, const GpuImage& picture, const ResourceUse& use,
                   std::optional<bool> patch);
    const Page& page_for(const Picture& picture);
    Image seen_by(std::size_t view, const Image& page) const;

    Clock& clock_;
    OpenXrStageOptions options_;
    OpenXrInstance instance_;
    Gpu gpu_;
    std::unique_ptr<OpenXrSession> session_;
    EyePictures pictures_;
    Eyes eyes_;  // of the turn that runs
    ViewGeometry view_;
    double refresh_hz_ = 0;
    std::optional<OpenXrFrame> turn_;
    HostTime turn_began_;
    std::int64_t next_index_ = 0;
    int beginnings_ = 0;           // of the session, that are known
    int recentrings_ = 0;          // that are known
    int missed_ = 0;               // since the frame shown last
    bool anything_shown_ = false;  // by this session
    bool watched_ = false;         // this frame is one that the audience looks at
    std::string fault_;            // the gravest since the frame shown last
    std::unique_ptr<ParticipantPages> pages_;
    std::list<Page> drawn_pages_;  // the one used last in front
    GpuImage black_, white_;       // the photodiode's patch
};

}  // namespace parafovea
