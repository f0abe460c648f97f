// The seam of foveation: a method turns a scene's shading function into a picture, at full or at reduced
// cost.
#pragma once

#include <cstdint>
#include <map>
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

struct ShadingSource {
    ShadedThing thing = ShadedThing::meshes;
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    std::vector<ShaderConstant> constants;
};

struct MethodFrame {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VkDescriptorSet shading_set = VK_NULL_HANDLE;
    const GpuImage* target = nullptr;  // of the screen's size; in kUseColorTarget before and after
    PassTimer* timer = nullptr;        // passes are called pass_1 (shading), pass_2 (resampling), post
};

struct MethodStatistics {
    SizePx buffer;                     // what Pass I shades into; the screen for full resolution
    std::uint64_t shaded_samples = 0;  // how often shade_sample() was needed
    std::vector<FeatureNote> built;
    std::vector<FeatureNote> left_out;
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

    // Of the last frame, once it is done.
    virtual MethodStatistics statistics() const = 0;
};

}  // namespace parafovea
