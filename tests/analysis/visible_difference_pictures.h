// Pictures for the tests of the visible difference: grey patterns from a hash of position, the same in any
// language.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "analysis/visible_difference.h"

namespace parafovea {

struct GreyPicture {
    int width = 0, height = 0;
    std::vector<int> code;  // 0 to 255

    int at(int x, int y) const {
        return code[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * width +
                    std::clamp(x, 0, width - 1)];
    }
};

struct RgbaPicture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> bytes;

    operator RgbaView() const { return {bytes, width, height}; }
};

inline RgbaPicture rgba_from(const GreyPicture& grey) {
    RgbaPicture rgba{grey.width, grey.height, {}};
    for (const int code : grey.code) {
        const auto byte = static_cast<std::uint8_t>(std::clamp(code, 0, 255));
        rgba.bytes.insert(rgba.bytes.end(), {byte, byte, byte, 255});
    }
    return rgba;
}

inline GreyPicture flat_picture(int width, int height, int code) {
    return {width, height, std::vector<int>(static_cast<std::size_t>(width) * height, code)};
}

inline std::uint32_t position_hash(std::uint32_t x, std::uint32_t y, std::uint32_t seed) {
    std::uint32_t v = x * 0x9E3779B1u ^ y * 0x85EBCA77u ^ seed * 0xC2B2AE3Du;
    v ^= v >> 15;
    v *= 0x2C1B3C6Du;
    v ^= v >> 12;
    v *= 0x297A2D39u;
    v ^= v >> 15;
    return v;
}

// Adds whole numbers uniform in [-amplitude, amplitude], one for each block of block x block pixels.
inline GreyPicture with_noise(GreyPicture picture, int block, int amplitude, std::uint32_t seed) {
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x)
            picture.code[static_cast<std::size_t>(y) * picture.width + x] +=
                static_cast<int>(position_hash(x / block, y / block, seed) % (2 * amplitude + 1)) - amplitude;
    return picture;
}

// The mean of 3x3 neighbours, rounded down, `times` times.
inline GreyPicture box_blurred(GreyPicture picture, int times = 1) {
    for (; times > 0; --times) {
        GreyPicture out = picture;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) {
                int sum = 0;
                for (int j = -1; j <= 1; ++j)
                    for (int i = -1; i <= 1; ++i) sum += picture.at(x + i, y + j);
                out.code[static_cast<std::size_t>(y) * picture.width + x] = sum / 9;
            }
        picture = out;
    }
    return picture;
}

// Fine and coarse texture about a grey that a 100 cd/m2 display shows at 50 cd/m2.
inline GreyPicture textured_picture(int width, int height) {
    return with_noise(with_noise(flat_picture(width, height, 188), 1, 20, 1), 5, 25, 2);
}

}  // namespace parafovea
