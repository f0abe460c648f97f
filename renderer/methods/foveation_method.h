// The seam of foveation: a method turns a scene's shading function into a picture, at full or at reduced
// cost.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "devices/geometry.h"
#include "renderer/frame_statistics.h"
#include "renderer/gpu_pipeline.h"

namespace parafovea {

// A method by name with its parameters: numbers (switches are 0 or 1) and words chosen from a list. What is
// absent has the method's default; what a method does not know is an error.
struct RenderMethod {
    std::string name = "full";
    std::map<std::string, double> numbers;
    std::map<std::string, std::string> words;

    bool operator==(const RenderMethod&) const = default;
};

// What a method's shaders shade: the variant of shade.glsl and its descriptor set 0.
enum class ShadedThing { meshes, primitives, picture };

// A shader that is compiled for each of them.
struct ShadingCode {
    std::span<const std::uint32_t> meshes, primitives, picture;

    std::span<const std::uint32_t> of(ShadedThing thing) const;
};

struct ShadingSource {
    ShadedThing thing = ShadedThing::meshes;
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    std::vector<ShaderConstant> constants;
    // Reduced buffers are shaded by compute shaders instead of fragments, by methods that can.
    bool in_compute = false;
};

// Whether the device's shaders can write storage images of a format.
bool shaders_can_write(const Gpu& gpu, VkFormat format);

struct Jitter {
    float x = 0;
    float y = 0;

    bool operator==(const Jitter&) const = default;
};

// Tells the pipelines of a method made with a push constant range of sizeof(Jitter); see shaders/jitter.glsl.
void push_jitter(VkCommandBuffer commands, VkPipelineLayout layout, const Jitter& jitter);

struct MethodFrame {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkDescriptorSet shading_set = VK_NULL_HANDLE;
    const GpuImage* target = nullptr;  // of the screen's size; in kUseColorTarget before and after
    PassTimer* timer = nullptr;        // passes are called pass_1 (shading), pass_2 (resampling), post
    // Shifts every sample of the method's own grid, in samples of that grid, each in [-0.5, 0.5): pixels at
    // full resolution, texels in a reduced buffer, whose resampling takes the shift back. A scene of meshes
    // is cut into pixels before any method samples it; CameraView::jitter_px shifts those.
    Jitter jitter;
};

struct MethodStatistics {
    SizePx buffer;                     // what Pass I shades into; the screen for full resolution
    std::uint64_t shaded_samples = 0;  // how often shade_sample() was needed
    std::vector<FeatureNote> built;
    std::vector<FeatureNote> left_out;
};

// How far apart neighbouring samples lie: along the line to the gaze and across it (or along the picture's
// two axes, for a method whose samples lie on a rectangular grid).
struct SampleSpacing {
    double radial_px = 1;
    double tangential_px = 1;
};

class FoveationMethod {
  public:
    virtual ~FoveationMethod() = default;

    // Takes parameters (the name is ignored). Throws std::runtime_error with one line if one is unknown or
    // out of range. Cheap if nothing changed.
    virtual void configure(const RenderMethod& method) = 0;

    // Makes what the next frame needs for a screen and a gaze (pixels; anywhere, see make_kernel_map). Cheap
    // if nothing changed. No frame may be running.
    virtual void prepare(SizePx screen, PointPx gaze) = 0;

    // Records the drawing of one frame, outside rendering. The same calls give the same picture, bit by bit.
    virtual void record(const MethodFrame& frame) = 0;

    // At a screen position, of what the last prepare() was for. A method that does not say otherwise samples
    // every pixel.
    virtual SampleSpacing spacing_at(PointPx) const { return {}; }

    // Of the last frame, once it is done.
    virtual MethodStatistics statistics() const = 0;
};

}  // namespace parafovea
