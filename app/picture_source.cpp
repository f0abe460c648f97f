// Renders stimuli through the renderer and remembers them.
#include "app/picture_source.h"

#include <cstring>
#include <utility>

#include "renderer/scene_camera.h"
#include "renderer/scene_catalog.h"

namespace parafovea {

std::uint64_t hash_of_pixels(const std::vector<std::uint8_t>& rgba) {
    constexpr std::uint64_t kPrime = 1099511628211u;
    std::uint64_t hash = 14695981039346656037u;
    std::size_t i = 0;
    for (; i + 8 <= rgba.size(); i += 8) {
        std::uint64_t word;
        std::memcpy(&word, rgba.data() + i, 8);
        hash = (hash ^ word) * kPrime;
        hash ^= hash >> 32;  // lets high bytes reach low bits, which multiplication alone does not
    }
    for (; i < rgba.size(); ++i) hash = (hash ^ rgba[i]) * kPrime;
    return hash;
}

struct PictureSource::Remembered {
    std::string scene;
    MethodSetting method;
    PointPx fovea;
    RenderedPicture picture;
};

struct PictureSource::LoadedScene {
    FrameRenderer renderer;
    CameraView view;
};

PictureSource::PictureSource(const ViewGeometry& view, std::size_t memory_bytes)
    : view_(view), capacity_(memory_bytes) {}

PictureSource::~PictureSource() = default;

RenderedPicture PictureSource::picture(const std::string& scene, const MethodSetting& method, PointPx fovea) {
    const std::scoped_lock lock(mutex_);
    for (auto known = remembered_.begin(); known != remembered_.end(); ++known) {
        if (known->scene != scene || known->fovea != fovea || known->method != method) continue;
        remembered_.splice(remembered_.begin(), remembered_, known);
        return known->picture;
    }
    remembered_.push_front({scene, method, fovea, render(scene, method, fovea)});
    const std::size_t bytes_each = remembered_.front().picture.rgba.size();
    while (remembered_.size() > 1 && remembered_.size() * bytes_each > capacity_) remembered_.pop_back();
    return remembered_.front().picture;
}

RenderedPicture PictureSource::render(const std::string& scene, const MethodSetting& method, PointPx fovea) {
    std::unique_ptr<LoadedScene>& loaded = scenes_[scene];
    if (!loaded) {
        const Scene data = load_scene(scene);
        loaded.reset(new LoadedScene{FrameRenderer(gpu_, data), view_through(data.cameras.front(), view_)});
    }
    RenderedFrame frame = loaded->renderer.render(view_.size, loaded->view,
                                                  {method.method, method.numbers, method.words}, fovea);
    RenderedPicture picture{frame.image.size, std::move(frame.image.rgba), 0};
    picture.hash = hash_of_pixels(picture.rgba);
    return picture;
}

}  // namespace parafovea
