// Draws for an OpenXR headset.
#include "app/openxr_stage.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <utility>

#include "app/photodiode_patch.h"

namespace parafovea {

namespace {

constexpr std::size_t kPagesKept = 16;

GpuOptions gpu_options(const OpenXrInstance& headset, bool validation) {
    GpuOptions options;
    options.validation = validation;
    options.maker.instance = [&headset](const VkInstanceCreateInfo& info, VkInstance& made) {
        return headset.make_vulkan_instance(info, made);
    };
    options.maker.physical_device = [&headset](VkInstance instance, VkPhysicalDevice& chosen) {
        return headset.choose_vulkan_device(instance, chosen);
    };
    options.maker.device = [&headset](VkPhysicalDevice physical_device, const VkDeviceCreateInfo& info,
                                      VkDevice& made) {
        return headset.make_vulkan_device(physical_device, info, made);
    };
    return options;
}

GpuImage on_device(Gpu& gpu, const Image& image) {
    GpuImage made(gpu, {.format = VK_FORMAT_R8G8B8A8_SRGB,
                        .width = static_cast<std::uint32_t>(image.size.width),
                        .height = static_cast<std::uint32_t>(image.size.height),
                        .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                                 VK_IMAGE_USAGE_SAMPLED_BIT});
    upload(gpu, made, std::as_bytes(std::span(image.rgba)));
    gpu.submit_and_wait([&made](VkCommandBuffer commands) {
        image_barrier(commands, made, kUseSampled, kUseTransferSource);
    });
    return made;
}

bool same_page(const Picture& a, const Picture& b) {
    return a.kind == b.kind && a.text == b.text && (a.kind != PictureKind::target || a.fovea == b.fovea);
}

}  // namespace

struct OpenXrStage::Page {
    Picture picture;
    std::vector<GpuImage> eyes;
};

OpenXrStage::OpenXrStage(Clock& clock, const OpenXrStageOptions& options)
    : clock_(clock),
      options_(options),
      gpu_(gpu_options(instance_, options.validation)),
      session_(std::make_unique<OpenXrSession>(
          instance_,
          OpenXrVulkan{gpu_.instance(), gpu_.physical_device(), gpu_.device(), gpu_.queue_family()}, clock)),
      pictures_(gpu_) {
    eyes_.sizes = instance_.view_sizes();
    eyes_.gaze_distance_m = options.gaze_distance_m;
    while (session_->state() != SessionState::focused) {
        if (!next_turn()) throw std::runtime_error("stopped before the headset was put on");
        if (session_->state() != SessionState::focused) session_->end_frame(*turn_, false);
    }
    refresh_hz_ = session_->refresh_hz().value_or(0);
    view_ = eyes_.view();
    pages_ = std::make_unique<ParticipantPages>(view_);
    const int patch_px = patch_side_px(view_);
    black_ = on_device(gpu_, blank_image({patch_px, patch_px}, 0));
    white_ = on_device(gpu_, blank_image({patch_px, patch_px}, 255));
    // What happened before the first picture is no fault of any.
    missed_ = 0;
    fault_.clear();
}

OpenXrStage::~OpenXrStage() = default;

std::string OpenXrStage::description() const {
    const SizePx size = instance_.view_sizes().front();
    char text[256];
    std::snprintf(text, sizeof text, "%s on %s, %zu %s of %d x %d at %.2f Hz",
                  instance_.headset_name().c_str(), instance_.runtime_name().c_str(),
                  instance_.view_sizes().size(), instance_.view_sizes().size() == 1 ? "view" : "views",
                  size.width, size.height, refresh_hz_);
    return text;
}

// Keeps the gravest.
void OpenXrStage::note(std::string_view fault) {
    const auto gravity = [](std::string_view name) {
        if (name == "session_lost") return 5;
        if (name == "headset_off") return 4;
        if (name == "not_visible") return 3;
        if (name == "not_focused") return 1;
        return name.empty() ? 0 : 2;
    };
    if (gravity(fault) > gravity(fault_)) fault_ = fault;
}

// False if the waiting was stopped.
bool OpenXrStage::next_turn() {
    turn_.reset();
    while (!options_.stop.stop_requested()) {
        const std::optional<OpenXrFrame> frame = session_->begin_frame();
        if (!frame) {
            recover();
            continue;
        }
        note(name_of(frame->checked.fault));
        if (std::exchange(beginnings_, session_->beginnings()) != session_->beginnings()) note("headset_off");
        if (std::exchange(recentrings_, session_->recentrings()) != session_->recentrings())
            note("recentred");
        missed_ += frame->checked.missed_refreshes;
        clock_.wait_until(frame->display_time - frame->period);
        if (frame->should_render && !frame->views.empty()) {
            if (session_->state() != SessionState::focused) note("not_focused");
            if (!nearly_same(eyes_.views, frame->views)) {
                if (!eyes_.views.empty()) note("eyes_moved");
                drawn_pages_.clear();
                eyes_.views = frame->views;
            }
            turn_ = frame;
            turn_->views = eyes_.views;
            turn_began_ = clock_.now();
            return true;
        }
        note("not_visible");
        ++missed_;
        session_->end_frame(*frame, false);
    }
    return false;
}

// The session is not running: makes another if it was lost, else waits a moment.
void OpenXrStage::recover() {
    constexpr Duration kMoment{10'000'000};
    constexpr int kTries = 1000;
    switch (session_->update()) {
        case SessionState::exiting:
            throw std::runtime_error("the session was ended in the headset; start again with --resume");
        case SessionState::lost:
            note("session_lost");
            anything_shown_ = false;
            for (int i = 0; i < kTries && !options_.stop.stop_requested(); ++i) {
                if (session_->restart()) return;
                clock_.wait_until(clock_.now() + kMoment);
            }
            throw std::runtime_error(
                "the headset's session was lost and no new one could be made; check the cable and the OpenXR "
                "runtime, then start again with --resume");
        default:
            note("headset_off");
            anything_shown_ = false;
            clock_.wait_until(clock_.now() + kMoment);
    }
}

ShownFrame OpenXrStage::show(const Picture& picture) {
    // The next turn was waited for when the last picture had been shown. If it is over, something else took
    // the time: the participant keeps seeing the last picture.
    if (turn_ && clock_.now() - turn_began_ > turn_->period) {
        session_->end_frame(*turn_, anything_shown_);
        ++missed_;
        next_turn();
    }

    ShownFrame shown;
    shown.index = next_index_++;
    bool seen = false;
    while (!seen && (turn_ || next_turn())) {
        const OpenXrFrame turn = *turn_;
        if (options_.audience != nullptr) {
            watched_ = options_.audience->looks_at(picture, turn.display_time) &&
                       picture.kind == PictureKind::stimulus;
        }
        shown.gpu_time.reset();
        const bool drawn =
            picture.kind == PictureKind::stimulus ? draw_stimulus(picture, shown) : draw_page(picture);
        session_->end_frame(turn, drawn);
        seen = drawn && session_->state() != SessionState::lost;
        shown.display_time = turn.display_time;
        turn_.reset();
    }
    anything_shown_ = seen;
    if (!seen) {
        note("not_visible");
        shown.display_time = clock_.now();
    }
    shown.missed_vsyncs = std::exchange(missed_, 0);
    shown.fault = std::exchange(fault_, {});
    next_turn();
    return shown;
}

bool OpenXrStage::draw_stimulus(const Picture& picture, ShownFrame& shown) {
    std::uint64_t hash = 0;
    double gpu_ms = 0;
    for (std::size_t i = 0; i < eyes_.views.size(); ++i) {
        const bool watched = watched_ && i == 0;
        const EyePictures::Drawn drawn = pictures_.draw(eyes_, i, picture, options_.hash_pictures || watched);
        gpu_ms += drawn.gpu_ms;
        if (drawn.pixels) hash = EyePictures::combine(hash, *drawn.pixels);
        if (watched) options_.audience->sees(*drawn.pixels, turn_->display_time);
        if (!hand_over(i, *drawn.image, drawn.use, picture.patch)) return false;
    }
    if (options_.hash_pictures) shown.image_hash = hash;
    if (gpu_ms > 0) shown.gpu_time = Duration::from_ms(gpu_ms);
    return true;
}

bool OpenXrStage::draw_page(const Picture& picture) {
    const Page& page = page_for(picture);
    for (std::size_t i = 0; i < eyes_.views.size(); ++i)
        if (!hand_over(i, page.eyes[i], kUseTransferSource, picture.patch)) return false;
    return true;
}

// Copies a picture to a view's image. False if the session is lost meanwhile.
bool OpenXrStage::hand_over(std::size_t view, const GpuImage& picture, const ResourceUse& use,
                            std::optional<bool> patch) {
    const std::optional<VkImage> image = session_->acquire_image(view);
    if (!image) return false;
    constexpr VkImageSubresourceRange kWhole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    const auto copy = [&](VkCommandBuffer commands, const GpuImage& from, std::int32_t top) {
        const auto width = static_cast<std::int32_t>(from.extent().width);
        const auto height = static_cast<std::int32_t>(from.extent().height);
        constexpr VkImageSubresourceLayers kLayer{VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        if (session_->image_format() == from.format()) {
            VkImageCopy region{
                kLayer, {}, kLayer, {0, top, 0}, {from.extent().width, from.extent().height, 1}};
            vkCmdCopyImage(commands, from.get(), kUseTransferSource.layout, *image, kUseTransferTarget.layout,
                           1, &region);
            return;
        }
        // A blit puts the channels into the image's own order.
        VkImageBlit blit{kLayer, {{}, {width, height, 1}}, kLayer, {{0, top, 0}, {width, top + height, 1}}};
        vkCmdBlitImage(commands, from.get(), kUseTransferSource.layout, *image, kUseTransferTarget.layout, 1,
                       &blit, VK_FILTER_NEAREST);
    };
    gpu_.submit_and_wait([&](VkCommandBuffer commands) {
        image_barrier(commands, picture, use, kUseTransferSource);
        image_barrier(commands, *image, kWhole, kUseColorTarget, kUseTransferTarget);
        copy(commands, picture, 0);
        if (patch) {
            const GpuImage& square = *patch ? white_ : black_;
            memory_barrier(commands, kUseTransferTarget, kUseTransferTarget);
            copy(commands, square,
                 static_cast<std::int32_t>(picture.extent().height - square.extent().height));
        }
        image_barrier(commands, *image, kWhole, kUseTransferTarget, kUseColorTarget);
    });
    session_->release_image(view);
    return session_->state() != SessionState::lost;
}

void OpenXrStage::prepare(const std::string& scene, const MethodSetting& method) {
    Picture picture;
    picture.kind = PictureKind::stimulus;
    picture.scene = scene;
    picture.method = method;
    picture.fovea = centre_of(view_.size);
    pictures_.draw(eyes_, 0, picture, false);
}

const OpenXrStage::Page& OpenXrStage::page_for(const Picture& picture) {
    const auto known = std::ranges::find_if(
        drawn_pages_, [&picture](const Page& page) { return same_page(page.picture, picture); });
    if (known != drawn_pages_.end()) {
        drawn_pages_.splice(drawn_pages_.begin(), drawn_pages_, known);
        return drawn_pages_.front();
    }
    const Image flat = pages_->draw(picture);
    Page page{picture, {}};
    for (std::size_t i = 0; i < eyes_.views.size(); ++i)
        page.eyes.push_back(on_device(gpu_, seen_by(i, flat)));
    drawn_pages_.push_front(std::move(page));
    if (drawn_pages_.size() > kPagesKept) drawn_pages_.pop_back();
    return drawn_pages_.front();
}

// The page as a board straight ahead at the gaze distance, as big as it is on view().
Image OpenXrStage::seen_by(std::size_t view, const Image& page) const {
    const SizePx size = eyes_.sizes[view];
    Image seen = blank_image(size);
    const double per_m = view_.distance_px() / options_.gaze_distance_m;
    const PointPx centre = centre_of(view_.size);
    const auto grey = [&page](int x, int y) {
        if (x < 0 || y < 0 || x >= page.size.width || y >= page.size.height) return 0.0;
        return static_cast<double>(
            page.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(page.size.width) +
                           static_cast<std::size_t>(x))]);
    };
    std::uint8_t* out = seen.rgba.data();
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x, out += 4) {
            const Vector3 on_board =
                point_on_plane(eyes_.views[view], size, {x + 0.5, y + 0.5}, options_.gaze_distance_m);
            const double px = centre.x + on_board.x * per_m - 0.5, py = centre.y - on_board.y * per_m - 0.5;
            if (!(px > -1 && py > -1 && px < page.size.width && py < page.size.height)) continue;
            const int left = static_cast<int>(std::floor(px)), top = static_cast<int>(std::floor(py));
            const double fx = px - left, fy = py - top;
            const double value = (grey(left, top) * (1 - fx) + grey(left + 1, top) * fx) * (1 - fy) +
                                 (grey(left, top + 1) * (1 - fx) + grey(left + 1, top + 1) * fx) * fy;
            out[0] = out[1] = out[2] = static_cast<std::uint8_t>(std::lround(value));
        }
    }
    return seen;
}

}  // namespace parafovea
