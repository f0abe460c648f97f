// Shows pictures in a window, each for whole refreshes.
#include "app/window_stage.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <vector>

namespace parafovea {

namespace {

// What a trial shows (fixation, two stimuli, black, question), the pages around it, and some to spare.
constexpr std::size_t kReadyPictures = 10;
constexpr int kPatchPx = 40;
constexpr int kWarmUpFrames = 10, kMeasuredFrames = 60;

constexpr ResourceUse kUsePresent{VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE,
                                  VK_IMAGE_LAYOUT_PRESENT_SRC_KHR};
constexpr VkImageSubresourceRange kColor{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

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

GpuImage make_image(Gpu& gpu, SizePx size) {
    ImageDescription description;
    description.width = static_cast<std::uint32_t>(size.width);
    description.height = static_cast<std::uint32_t>(size.height);
    description.usage =
        VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    return GpuImage(gpu, description);
}

void fill(Gpu& gpu, const GpuImage& image, std::span<const std::uint8_t> rgba) {
    upload(gpu, image, std::as_bytes(rgba));
    gpu.submit_and_wait(
        [&](VkCommandBuffer commands) { image_barrier(commands, image, kUseSampled, kUseTransferSource); });
}

void blit(VkCommandBuffer commands, const GpuImage& from, VkImage to, int left, int top, int right,
          int bottom, VkFilter filter) {
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = {static_cast<std::int32_t>(from.extent().width),
                            static_cast<std::int32_t>(from.extent().height), 1};
    region.dstOffsets[0] = {left, top, 0};
    region.dstOffsets[1] = {right, bottom, 1};
    vkCmdBlitImage(commands, from.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, filter);
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
      white_(make_image(surface.gpu(), {1, 1})) {
    const std::array<std::uint8_t, 4> white = {255, 255, 255, 255};
    fill(surface_.gpu(), white_, white);
    measure_refresh(monitor);
}

void WindowStage::measure_refresh(const Monitor& monitor) {
    if (monitor.refresh_hz > 0) {
        std::vector<HostTime> times;
        const Ready& black = make_ready({});
        for (int i = 0; i < kWarmUpFrames + kMeasuredFrames; ++i) {
            surface_.acquire();
            if (i >= kWarmUpFrames) times.push_back(clock_.now());
            present(black, false);
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
        if (ready.name != on_screen_) present(ready, stimulus);
        shown.display_time = refresh.time;
        shown.missed_vsyncs = refresh.missed;
    } else {
        surface_.acquire();
        const Refresh refresh = observed_->next(clock_.now());
        present(ready, stimulus);
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
    present(make_ready(picture), false);
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
        slot->image = make_image(surface_.gpu(), protocol_.display.view.size);
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
        fill(surface_.gpu(), ready.image, rendered.rgba);
        ready.hash = rendered.hash;
    } else {
        fill(surface_.gpu(), ready.image, pages_.draw(picture, progress_).rgba);
    }
    ready.name = name;
}

void WindowStage::present(const Ready& ready, bool patch_is_white) {
    surface_.acquire();
    const SizePx window = surface_.size();
    const Placement place = placement_of(protocol_.display.view.size, window);
    surface_.present([&](VkCommandBuffer commands, VkImage target) {
        image_barrier(commands, target, kColor, kUseNone, kUseTransferTarget);
        const VkClearColorValue black{{0, 0, 0, 1}};
        vkCmdClearColorImage(commands, target, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &kColor);
        image_barrier(commands, target, kColor, kUseTransferTarget, kUseTransferTarget);
        const int left = static_cast<int>(place.left_px), top = static_cast<int>(place.top_px);
        const int right =
            left + static_cast<int>(std::lround(place.scale * protocol_.display.view.size.width));
        const int bottom =
            top + static_cast<int>(std::lround(place.scale * protocol_.display.view.size.height));
        blit(commands, ready.image, target, left, top, std::min(right, window.width),
             std::min(bottom, window.height), place.scale == 1 ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
        if (protocol_.display.photodiode_patch && patch_is_white) {
            image_barrier(commands, target, kColor, kUseTransferTarget, kUseTransferTarget);
            blit(commands, white_, target, 0, std::max(0, window.height - kPatchPx),
                 std::min(kPatchPx, window.width), window.height, VK_FILTER_NEAREST);
        }
        image_barrier(commands, target, kColor, kUseTransferTarget, kUsePresent);
    });
    on_screen_ = ready.name;
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
