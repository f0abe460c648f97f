// What the eyes in a headset see of a stimulus: every eye its own picture, foveated at its own gaze point.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "app/picture_source.h"
#include "devices/openxr/eye_view.h"
#include "renderer/frame_renderer.h"
#include "study/stage.h"

namespace parafovea {

// Where a headset's eyes are and how they see; views in the head's frame.
struct Eyes {
    std::vector<XrView> views;
    std::vector<SizePx> sizes;  // of their pictures
    // How far away the participant is taken to look. It turns the one gaze direction that a tracker gives
    // into each eye's own; half a metre or infinity instead of two metres moves it by 2.7 or 0.9 degrees.
    double gaze_distance_m = 2;

    // The symmetric picture between the eyes, on which gaze and targets are given.
    ViewGeometry view() const { return picture_between(views, sizes.front()); }

    // Where an eye's picture shows what lies in the direction of a point of view(), at the gaze distance.
    PointPx seen_at(std::size_t eye, PointPx on_view) const;
};

// The frustum of an eye's picture in a scene, whose camera stands for the middle of the head.
CameraView view_of_eye(const XrView& eye, const SceneCamera& camera);

// The method as one of the eyes gets it: see renderer/eye_dominance.h.
RenderMethod method_of_eye(const Eyes& eyes, std::size_t eye, const RenderMethod& method);

// One line that reads back bit for bit. Throws std::runtime_error if it is not such a line.
std::string to_text(const Eyes& eyes);
Eyes parse_eyes(std::string_view text);

// Equal but for what a runtime's arithmetic leaves: a tenth of a millimetre, a hundredth of a degree.
bool nearly_same(const std::vector<XrView>& a, const std::vector<XrView>& b);

// Loads each scene once. Used by one thread.
class EyePictures {
  public:
    explicit EyePictures(Gpu& gpu);
    ~EyePictures();

    struct Drawn {
        const GpuImage* image = nullptr;        // until the next is drawn
        ResourceUse use;                        // that it is in
        std::optional<RenderedPicture> pixels;  // where they were read
        double gpu_ms = 0;                      // 0: not measured
    };

    // Throws what loading and rendering throw. The picture is a stimulus.
    Drawn draw(const Eyes& eyes, std::size_t eye, const Picture& picture, bool read_pixels);

    // Takes one more eye, the first into 0, into the hash of the pixels of all eyes.
    static std::uint64_t combine(std::uint64_t hash, const RenderedPicture& eye);

  private:
    struct LoadedScene;

    LoadedScene& scene_called(const std::string& name);

    Gpu& gpu_;
    std::map<std::string, std::unique_ptr<LoadedScene>> scenes_;
};

}  // namespace parafovea
