// Reads and writes picture files.
#include "renderer/image.h"

#include <png.h>
#include <stb/stb_image.h>

#include <array>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

namespace parafovea {

Image load_image(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path)) {
        throw std::runtime_error("cannot open the picture " + path.string() + ": " +
                                 (file ? "it is a folder" : std::strerror(errno)));
    }
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const std::string start(bytes.data(), std::min<std::size_t>(bytes.size(), 4));
    if (start != "\x89PNG" && !start.starts_with("\xff\xd8\xff")) {
        throw std::runtime_error("the picture " + path.string() + " is neither a PNG nor a JPEG file");
    }
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        throw std::runtime_error("the picture " + path.string() + " is larger than 2 GiB");
    }
    Image image;
    int channels = 0;
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(bytes.data()), static_cast<int>(bytes.size()),
                              &image.size.width, &image.size.height, &channels, 4),
        stbi_image_free);
    if (!pixels) {
        const char* reason = stbi_failure_reason();
        throw std::runtime_error("the picture " + path.string() + " is broken (" +
                                 (reason ? reason : "unreadable") + ")");
    }
    const std::size_t size =
        static_cast<std::size_t>(image.size.width) * static_cast<std::size_t>(image.size.height) * 4;
    image.rgba.assign(pixels.get(), pixels.get() + size);
    return image;
}

void save_png(const Image& image, const std::filesystem::path& path) {
    assert(image.rgba.size() ==
           static_cast<std::size_t>(image.size.width) * static_cast<std::size_t>(image.size.height) * 4);
    const auto fail = [&](const std::string& why) {
        throw std::runtime_error("cannot write the picture " + path.string() + ": " + why);
    };
    // libpng's simple interface wants the rows as they will be: RGB.
    std::vector<std::uint8_t> rgb;
    rgb.reserve(image.rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        rgb.insert(rgb.end(), {image.rgba[i], image.rgba[i + 1], image.rgba[i + 2]});
    }
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.size.width);
    png.height = static_cast<png_uint_32>(image.size.height);
    png.format = PNG_FORMAT_RGB;
    png.flags = PNG_IMAGE_FLAG_FAST;
    const std::unique_ptr<std::FILE, decltype(&std::fclose)> file(std::fopen(path.c_str(), "wb"),
                                                                  std::fclose);
    if (!file) fail(std::strerror(errno));
    if (png_image_write_to_stdio(&png, file.get(), 0, rgb.data(), 0, nullptr) == 0) fail(png.message);
    if (std::fflush(file.get()) != 0) fail(std::strerror(errno));
}

}  // namespace parafovea
