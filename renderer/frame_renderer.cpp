// Draws one frame: the scene's passes, the method's passes, the pixels back.
#include "renderer/frame_renderer.h"

#include <cstring>
#include <stdexcept>

#include "renderer/methods/method_list.h"

namespace parafovea {
namespace {

constexpr std::uint32_t kMostPasses = 32;

}  // namespace

FrameRenderer::FrameRenderer(Gpu& gpu, const Scene& scene, const ScenePassOptions& options)
    : gpu_(gpu), passes_(gpu, scene, options), timer_(gpu, kMostPasses) {}

FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::make_targets(SizePx size) {
    if (size == size_) return;
    if (size.width < 1 || size.height < 1) {
        throw std::runtime_error("a picture of " + std::to_string(size.width) + "x" +
                                 std::to_string(size.height) +
                                 " pixels cannot be drawn; both sides must be at least 1");
    }
    size_ = {};
    const auto width = static_cast<std::uint32_t>(size.width);
    const auto height = static_cast<std::uint32_t>(size.height);
    target_ = {};
    pixels_ = {};
    target_ =
        GpuImage(gpu_, {.format = VK_FORMAT_R8G8B8A8_SRGB,
                        .width = width,
                        .height = height,
                        .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    pixels_ = GpuBuffer(gpu_, VkDeviceSize{width} * height * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                        BufferPlace::readback);
    size_ = size;
}

FoveationMethod& FrameRenderer::method_called(const std::string& name) {
    std::unique_ptr<FoveationMethod>& method = methods_[name];
    if (!method) {
        method = make_method(gpu_, name,
                             {.thing = passes_.ray_marched() ? ShadedThing::primitives : ShadedThing::meshes,
                              .layout = passes_.shading_set_layout(),
                              .constants = passes_.shading_constants()});
    }
    return *method;
}

RenderedFrame FrameRenderer::render(SizePx size, const CameraView& view, const RenderMethod& method,
                                    PointPx gaze, bool read_pixels) {
    check(method);
    make_targets(size);
    FoveationMethod& drawing = method_called(method.name);
    drawing.configure(method);
    drawing.prepare(size, gaze);
    passes_.set_view(size, view);
    gpu_.submit_and_wait([&](VkCommandBuffer commands) {
        timer_.reset(commands);
        passes_.record(commands, &timer_);
        image_barrier(commands, target_, kUseNone, kUseColorTarget);
        drawing.record({commands, passes_.shading_set(), &target_, &timer_});
        if (!read_pixels) return;
        image_barrier(commands, target_, kUseColorTarget, kUseTransferSource);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        copy.imageExtent = {target_.extent().width, target_.extent().height, 1};
        vkCmdCopyImageToBuffer(commands, target_.get(), kUseTransferSource.layout, pixels_.get(), 1, &copy);
        memory_barrier(commands, kUseTransferTarget, kUseHostRead);
    });

    RenderedFrame frame;
    if (read_pixels) {
        frame.image.size = size;
        frame.image.rgba.resize(pixels_.size_bytes());
        std::memcpy(frame.image.rgba.data(), pixels_.mapped(), frame.image.rgba.size());
    }
    const MethodStatistics cost = drawing.statistics();
    FrameStatistics& statistics = frame.statistics;
    statistics.size = size;
    statistics.buffer = cost.buffer;
    statistics.screen_pixels =
        static_cast<std::uint64_t>(size.width) * static_cast<std::uint64_t>(size.height);
    statistics.shaded_samples = cost.shaded_samples;
    statistics.passes = timer_.passes();
    if (!statistics.passes.empty()) statistics.passes.push_back({"total", timer_.total_ms()});
    statistics.triangles = passes_.triangles_in_view();
    statistics.device = gpu_.device_name();
    statistics.driver = gpu_.driver_name();
    statistics.device_memory_bytes = gpu_.allocated_bytes();
    statistics.peak_device_memory_bytes = gpu_.peak_allocated_bytes();
    statistics.built = passes_.built();
    statistics.built.insert(statistics.built.end(), cost.built.begin(), cost.built.end());
    statistics.left_out = passes_.left_out();
    statistics.left_out.insert(statistics.left_out.end(), cost.left_out.begin(), cost.left_out.end());
    return frame;
}

}  // namespace parafovea
