// Renders stimuli, each distinct picture once for as long as it is remembered.
#pragma once

#include <cstdint>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "devices/geometry.h"
#include "renderer/frame_renderer.h"
#include "renderer/gpu.h"
#include "study/method_setting.h"

namespace parafovea {

// 8-bit sRGB, 4 bytes a pixel, rows from the top.
struct RenderedPicture {
    SizePx size;
    std::vector<std::uint8_t> rgba;
    std::uint64_t hash = 0;  // of the pixels
};

// FNV-1a over 64-bit words, then the odd bytes.
std::uint64_t hash_of_pixels(const std::vector<std::uint8_t>& rgba);

// May be used by several threads; one renders at a time.
class PictureSource {
  public:
    // Remembers as many of the pictures last asked for as fit into `memory_bytes`.
    explicit PictureSource(const ViewGeometry& view, std::size_t memory_bytes = std::size_t{1} << 30);
    ~PictureSource();

    // A scene drawn by a method with its fovea at a place. Throws what loading and rendering throw.
    RenderedPicture picture(const std::string& scene, const MethodSetting& method, PointPx fovea);

    // What renders, for the log.
    const std::string& device_name() const { return gpu_.device_name(); }
    const std::string& driver_name() const { return gpu_.driver_name(); }

  private:
    struct Remembered;
    struct LoadedScene;

    RenderedPicture render(const std::string& scene, const MethodSetting& method, PointPx fovea);

    ViewGeometry view_;
    std::size_t capacity_;
    std::mutex mutex_;
    Gpu gpu_;
    std::map<std::string, std::unique_ptr<LoadedScene>> scenes_;
    std::list<Remembered> remembered_;  // the last one used in front
};

}  // namespace parafovea
