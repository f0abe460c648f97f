// Draws a picture: the scene's passes, the method's passes, the stages after it, the pixels back.
#include "renderer/frame_renderer.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "renderer/eye_dominance.h"
#include "renderer/methods/method_list.h"

namespace parafovea {
namespace {

constexpr std::uint32_t kMostPasses = 32;

void add_time(std::vector<PassTimer::Pass>& passes, const PassTimer::Pass& pass) {
    const auto found = std::ranges::find(passes, pass.name, &PassTimer::Pass::name);
    if (found == passes.end())
        passes.push_back(pass);
    else
        found->ms += pass.ms;
}

}  // namespace

FrameRenderer::FrameRenderer(Gpu& gpu, const Scene& scene, const ScenePassOptions& options)
    : gpu_(gpu),
      passes_(gpu, scene, options),
      shade_in_compute_(options.shade_in_compute.value_or(!gpu.runs_on_the_cpu())),
      timer_(gpu, kMostPasses) {}

FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::make_targets(const Order& order) {
    const SizePx size = order.size;
    const auto width = static_cast<std::uint32_t>(size.width);
    const auto height = static_cast<std::uint32_t>(size.height);
    const auto picture = [&](VkImageUsageFlags usage) {
        return GpuImage(gpu_, {.format = kTargetFormat,
                               .width = width,
                               .height = height,
                               .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | usage});
    };
    if (size != size_) {
        if (size.width < 1 || size.height < 1) {
            throw std::runtime_error("a picture of " + std::to_string(size.width) + "x" +
                                     std::to_string(size.height) +
                                     " pixels cannot be drawn; both sides must be at least 1");
        }
        size_ = {};
        target_ = {};
        before_stages_ = {};
        before_contrast_ = {};
        pixels_ = {};
        target_ = picture(VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
        pixels_ = GpuBuffer(gpu_, VkDeviceSize{width} * height * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                            BufferPlace::readback);
        size_ = size;
    }
    const bool taa = order.stages.taa > 0, contrast = order.stages.contrast > 0;
    if ((taa || contrast) && !before_stages_) before_stages_ = picture(VK_IMAGE_USAGE_SAMPLED_BIT);
    if (taa && contrast && !before_contrast_) before_contrast_ = picture(VK_IMAGE_USAGE_SAMPLED_BIT);
    if (contrast && !contrast_) contrast_.emplace(gpu_, kTargetFormat);
}

FoveationMethod& FrameRenderer::method_called(const std::string& name) {
    std::unique_ptr<FoveationMethod>& method = methods_[name];
    if (!method) method = make_method(gpu_, name, shading_source());
    return *method;
}

ShadingSource FrameRenderer::shading_source() const {
    return {.thing = passes_.ray_marched() ? ShadedThing::primitives : ShadedThing::meshes,
            .layout = passes_.shading_set_layout(),
            .constants = passes_.shading_constants(),
            .in_compute = shade_in_compute_};
}

FrameRenderer::Order FrameRenderer::order(SizePx size, const CameraView& view, const RenderMethod& method,
                                          PointPx gaze, bool read_pixels) const {
    check(method);
    Order order{size, view, method_for_dominant_eye(method), {}, gaze, read_pixels};
    order.stages = take_frame_stages(order.method);
    return order;
}

FoveationMethod& FrameRenderer::prepare(const Order& order) {
    make_targets(order);
    FoveationMethod& drawing = method_called(order.method.name);
    drawing.configure(order.method);
    drawing.prepare(order.size, order.gaze);
    return drawing;
}

void FrameRenderer::draw(const Order& order, FoveationMethod& drawing, TemporalFilter* filter, bool last) {
    const bool contrast = last && order.stages.contrast > 0;
    const bool staged = filter != nullptr || contrast;
    SpacingGrid spacing;
    if (staged) spacing = spacing_grid(drawing, order.size);
    const Jitter jitter = filter != nullptr ? halton_jitter(filter->frames() % order.stages.taa) : Jitter{};
    CameraView view = order.view;
    if (!passes_.ray_marched()) {
        // The scene is cut into pixels before the method samples it.
        view.jitter_px.x += jitter.x;
        view.jitter_px.y += jitter.y;
    }
    passes_.set_view(order.size, view);
    const bool moving = filter != nullptr && !(still_ && filter == &*still_);
    const bool march_depth = moving && passes_.ray_marched();
    if (march_depth && !marched_depth_) marched_depth_.emplace(gpu_, shading_source());

    gpu_.submit_and_wait([&](VkCommandBuffer commands) {
        timer_.reset(commands);
        passes_.record(commands, &timer_);
        if (march_depth) {
            timer_.start(commands, "depth");
            marched_depth_->record(commands, passes_.shading_set(), target_.extent());
            timer_.stop(commands);
        }
        const GpuImage& drawn = staged ? before_stages_ : target_;
        image_barrier(commands, drawn, kUseNone, kUseColorTarget);
        drawing.record({commands, passes_.shading_set(), &drawn, &timer_, jitter});
        const GpuImage* seen = &drawn;
        if (filter != nullptr) {
            const GpuImage& blended = contrast ? before_contrast_ : target_;
            image_barrier(commands, *seen, kUseColorTarget, kUseSampled);
            image_barrier(commands, blended, kUseNone, kUseColorTarget);
            timer_.start(commands, "post");
            filter->record(commands, {.frame = seen,
                                      .depth = march_depth ? &marched_depth_->image() : passes_.depth(),
                                      .view = order.view,
                                      .spacing = &spacing,
                                      .least_weight = order.stages.taa_alpha,
                                      .target = &blended});
            timer_.stop(commands);
            seen = &blended;
        }
        if (contrast) {
            image_barrier(commands, *seen, kUseColorTarget, kUseSampled);
            image_barrier(commands, target_, kUseNone, kUseColorTarget);
            timer_.start(commands, "post");
            contrast_->record(commands, *seen, spacing, order.stages.contrast, target_);
            timer_.stop(commands);
        }
        if (!last || !order.read_pixels) return;
        image_barrier(commands, target_, kUseColorTarget, kUseTransferSource);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageExtent = {target_.extent().width, target_.extent().height, 1};
        vkCmdCopyImageToBuffer(commands, target_.get(), kUseTransferSource.layout, pixels_.get(), 1, &copy);
        memory_barrier(commands, kUseTransferTarget, kUseHostRead);
    });
}

void FrameRenderer::count(const FoveationMethod& drawing, FrameStatistics& sum) const {
    sum.shaded_samples += drawing.statistics().shaded_samples;
    const std::vector<PassTimer::Pass> passes = timer_.passes();
    if (passes.empty()) return;
    const double total_before = sum.pass_ms("total");
    std::erase_if(sum.passes, [](const PassTimer::Pass& pass) { return pass.name == "total"; });
    for (const PassTimer::Pass& pass : passes) add_time(sum.passes, pass);
    sum.passes.push_back({"total", total_before + timer_.total_ms()});
}

RenderedFrame FrameRenderer::finished(const Order& order, const FoveationMethod& drawing,
                                      FrameStatistics sum) const {
    RenderedFrame frame;
    if (order.read_pixels) {
        frame.image.size = order.size;
        frame.image.rgba.resize(pixels_.size_bytes());
        std::memcpy(frame.image.rgba.data(), pixels_.mapped(), frame.image.rgba.size());
    }
    const MethodStatistics cost = drawing.statistics();
    sum.size = order.size;
    sum.buffer = cost.buffer;
    sum.screen_pixels =
        static_cast<std::uint64_t>(order.size.width) * static_cast<std::uint64_t>(order.size.height);
    sum.triangles = passes_.triangles_in_view();
    sum.device = gpu_.device_name();
    sum.driver = gpu_.driver_name();
    sum.device_memory_bytes = gpu_.allocated_bytes();
    sum.peak_device_memory_bytes = gpu_.peak_allocated_bytes();
    sum.built = passes_.built();
    sum.built.insert(sum.built.end(), cost.built.begin(), cost.built.end());
    sum.left_out = passes_.left_out();
    sum.left_out.insert(sum.left_out.end(), cost.left_out.begin(), cost.left_out.end());
    const auto note = [&](bool built, const char* name, const std::string& how) {
        (built ? sum.built : sum.left_out).push_back({name, built ? how : "not asked for"});
    };
    note(order.stages.taa > 0, "anti-aliasing over time",
         std::to_string(order.stages.taa) + " places of a sample in turn");
    note(order.stages.contrast > 0, "contrast preservation", "gain of Patney et al. 2016 by local blur");
    frame.statistics = std::move(sum);
    return frame;
}

RenderedFrame FrameRenderer::render(SizePx size, const CameraView& view, const RenderMethod& method,
                                    PointPx gaze, bool read_pixels) {
    const Order wanted = order(size, view, method, gaze, read_pixels);
    FoveationMethod& drawing = prepare(wanted);
    FrameStatistics sum;
    if (wanted.stages.taa == 0) {
        draw(wanted, drawing, nullptr, true);
        count(drawing, sum);
    } else {
        if (!still_) still_.emplace(gpu_, kTargetFormat);
        still_->cut();
        for (int i = 1; i <= wanted.stages.taa; ++i) {
            draw(wanted, drawing, &*still_, i == wanted.stages.taa);
            count(drawing, sum);
        }
    }
    return finished(wanted, drawing, std::move(sum));
}

RenderedFrame FrameRenderer::render_next(TemporalFilter& filter, SizePx size, const CameraView& view,
                                         const RenderMethod& method, PointPx gaze, bool read_pixels) {
    const Order wanted = order(size, view, method, gaze, read_pixels);
    FoveationMethod& drawing = prepare(wanted);
    if (wanted.stages.taa == 0) filter.cut();
    draw(wanted, drawing, wanted.stages.taa > 0 ? &filter : nullptr, true);
    FrameStatistics sum;
    count(drawing, sum);
    return finished(wanted, drawing, std::move(sum));
}

std::vector<double> FrameRenderer::sample_density(SizePx size, const RenderMethod& method, PointPx gaze) {
    const FoveationMethod& drawing = prepare(order(size, {}, method, gaze, false));
    std::vector<double> density;
    density.reserve(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
    for (int y = 0; y < size.height; ++y) {
        for (int x = 0; x < size.width; ++x) {
            const SampleSpacing spacing = drawing.spacing_at({x + 0.5, y + 0.5});
            density.push_back(1 / (spacing.radial_px * spacing.tangential_px));
        }
    }
    return density;
}

}  // namespace parafovea
