// Shows pictures in a window, each for whole refreshes.
#include "app/window_stage.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <vector>

namespace parafovea {

namespace {

// What a trial shows (fixation, two stimuli, black, question), the pages around it, and some to spare.
constexpr std::size_t kReadyPictures = 10;
constexpr int kWarmUpFrames = 10, kMeasuredFrames = 60;

constexpr ResourceUse kUsePresent{VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE,
                                  VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};

std::string name_of(const Picture& picture, double progress) {
    switch (picture.kind) {
        case PictureKind::black:
            return "black";
        case PictureKind::fixation:
            return "fixation";
        case PictureKind::stimulus:
            return "stimulus " + picture.scene + " " + to_text(picture.method) + " " +
                   std::to_string(picture.fovea.x) + " " + std::to_string(picture.fovea.y);
        case PictureKind::question:
            return "question " + picture.text;
        case PictureKind::text:
            return "text " + std::to_string(progress) + " " + picture.text;
        case PictureKind::target:
            return "target " + std::to_string(picture.fovea.x) + " " + std::to_string(picture.fovea.y);
    }
    return "";
}

}  // namespace

WindowStage::WindowStage(WindowSurface& surface, const Monitor& monitor, const Protocol& protocol,
                         Clock& clock, PictureSource& pictures, Audience* audience)
    : surface_(surface),
      protocol_(protocol),
      clock_(clock),
      pictures_(pictures),
      audience_(audience),
      pages_(protocol.display.view),
      window_picture_(surface.gpu(), protocol.display.view) {
    measure_refresh(monitor);
}

void WindowStage::measure_refresh(const Monitor& monitor) {
    if (monitor.refresh_hz > 0) {
        std::vector<HostTime> times;
        const Ready& black = make_ready({});
        for (int i = 0; i < kWarmUpFrames + kMeasuredFrames; ++i) {
            surface_.acquire();
            if (i >= kWarmUpFrames) times.push_back(clock_.now());
            present(black, std::nullopt);
        }
        refresh_hz_ = median_rate_hz(times);
        if (keeps_rate(refresh_hz_, monitor.refresh_hz)) {
            observed_.emplace(times.back(), refresh_hz_);
            return;
        }
    }
    refresh_hz_ = protocol_.display.refresh_hz;
    paced_.emplace(clock_.now(), refresh_hz_);
}

ShownFrame WindowStage::show(const Picture& picture) {
    const Ready& ready = make_ready(picture);
    const bool stimulus = picture.kind == PictureKind::stimulus;
    ShownFrame shown;
    shown.index = next_index_++;
    shown.time_source = TimeSource::predicted;
    if (paced_) {
        const Refresh refresh = paced_->next(clock_.now());
        clock_.wait_until(refresh.time);
        if (ready.name != on_screen_ || picture.patch != patch_on_screen_) present(ready, picture.patch);
        shown.display_time = refresh.time;
        shown.missed_vsyncs = refresh.missed;
    } else {
        surface_.acquire();
        const Refresh refresh = observed_->next(clock_.now());
        present(ready, picture.patch);
        // Behind the pictures that are queued already.
        const double queued = static_cast<double>(surface_.images().size()) - 1;
        shown.display_time = refresh.time + Duration::from_seconds(queued / refresh_hz_);
        shown.missed_vsyncs = refresh.missed;
    }
    if (stimulus) shown.image_hash = ready.hash;
    if (audience_ && audience_->looks_at(picture, shown.display_time) && stimulus)
        audience_->sees(pictures_.picture(picture.scene, picture.method, picture.fovea), shown.display_time);
    return shown;
}

void WindowStage::prepare(const PlannedTrial& trial) {
    // The participant looks at black, not at the last question, while pictures are drawn.
    Picture picture;
    if (protocol_.display.photodiode_patch) picture.patch = false;
    present(make_ready(picture), picture.patch);
    picture.kind = PictureKind::fixation;
    make_ready(picture);
    picture.kind = PictureKind::question;
    picture.text = protocol_.text().question;
    make_ready(picture);
    if (protocol_.foveation_gaze != GazePolicy::center) return;
    picture.kind = PictureKind::stimulus;
    picture.text.clear();
    picture.scene = trial.scene;
    picture.fovea = centre_of(protocol_.display.view.size);
    for (const MethodSetting& method : {trial.first, trial.second}) {
        picture.method = method;
        make_ready(picture);
    }
}

const WindowStage::Ready& WindowStage::make_ready(const Picture& picture) {
    const std::string name = name_of(picture, progress_);
    auto slot =
        std::find_if(ready_.begin(), ready_.end(), [&](const Ready& known) { return known.name == name; });
    const bool known = slot != ready_.end();
    if (!known && ready_.size() < kReadyPictures) {
        slot = ready_.emplace(ready_.begin());
        slot->image = make_picture_image(surface_.gpu(), protocol_.display.view.size);
    } else if (!known) {
        slot = std::prev(ready_.end());
    }
    ready_.splice(ready_.begin(), ready_, slot);
    if (!known) fill_with(*slot, picture, name);
    return *slot;
}

void WindowStage::fill_with(Ready& ready, const Picture& picture, const std::string& name) {
    ready.name.clear();
    ready.hash.reset();
    if (picture.kind == PictureKind::stimulus) {
        const RenderedPicture rendered = pictures_.picture(picture.scene, picture.method, picture.fovea);
        fill_picture_image(surface_.gpu(), ready.image, rendered.rgba);
        ready.hash = rendered.hash;
    } else {
        fill_picture_image(surface_.gpu(), ready.image, pages_.draw(picture, progress_).rgba);
    }
    ready.name = name;
}

void WindowStage::present(const Ready& ready, std::optional<bool> patch) {
    surface_.acquire();
    surface_.present([&](VkCommandBuffer commands, VkImage target) {
        window_picture_.record(commands, ready.image, target, surface_.size(), patch, kUsePresent);
    });
    on_screen_ = ready.name;
    patch_on_screen_ = patch;
}

double WindowStage::scale() const {
    return placement_of(protocol_.display.view.size, surface_.size()).scale;
}

std::string WindowStage::description() const {
    char text[160];
    std::snprintf(text, sizeof text, "window %d x %d, picture scale %.4g, %.4g Hz %s", surface_.size().width,
                  surface_.size().height, scale(), refresh_hz_,
                  paced_ ? "by the clock (the display keeps no rate)" : "measured on the display");
    return text;
}

}  // namespace parafovea
