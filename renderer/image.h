// Pictures in memory and in PNG and JPEG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "devices/geometry.h"

namespace parafovea {

// Rows from the top, 4 bytes a pixel: red, green, blue, alpha, sRGB encoded.
struct Image {
    SizePx size;
    std::vector<std::uint8_t> rgba;

    bool operator==(const Image&) const = default;
};

// Reads a PNG or JPEG file; grey and palette pictures become RGBA, 16-bit ones lose their low bytes. Throws
// std::runtime_error with one line if the file is missing, is something else or is broken.
Image load_image(const std::filesystem::path& path);

// Writes an 8-bit RGB PNG file (alpha is not kept). Throws std::runtime_error with one line if that is not
// possible.
void save_png(const Image& image, const std::filesystem::path& path);

}  // namespace parafovea
