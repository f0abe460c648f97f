// FLIP: against its authors' program, by hand, and how it must behave.
#include "analysis/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/analysis/visible_difference_pictures.h"

namespace parafovea {
namespace {

RgbaPicture from_channels(const GreyPicture& red, const GreyPicture& green, const GreyPicture& blue) {
    RgbaPicture out = rgba_from(red);
    for (std::size_t i = 0; i < green.code.size(); ++i) {
        out.bytes[4 * i + 1] = static_cast<std::uint8_t>(green.code[i]);
        out.bytes[4 * i + 2] = static_cast<std::uint8_t>(blue.code[i]);
    }
    return out;
}

// Means by the authors' LDR-FLIP (PyTorch, 2024) of the same pictures of 200x160 pixels.
TEST(Flip, AgreesWithTheAuthorsProgram) {
    const GreyPicture flat = flat_picture(200, 160, 188), texture = textured_picture(200, 160);
    const GreyPicture grey = flat_picture(200, 160, 128);
    struct Row {
        const char* what;
        RgbaPicture test, reference;
        double at_67, at_14, at_5;  // pixels per degree 67.0206, 14.11, 5
    };
    const Row rows[] = {
        {"fine noise", rgba_from(with_noise(flat, 1, 8, 3)), rgba_from(flat), 0.038011, 0.115683, 0.125813},
        {"coarse noise", rgba_from(with_noise(flat, 8, 6, 4)), rgba_from(flat), 0.077322, 0.072186, 0.071157},
        {"blur", rgba_from(box_blurred(texture)), rgba_from(texture), 0.048236, 0.222726, 0.245435},
        {"on texture", rgba_from(with_noise(texture, 2, 6, 5)), rgba_from(texture), 0.047461, 0.087184,
         0.089693},
        {"colour",
         from_channels(with_noise(grey, 4, 60, 6), with_noise(grey, 4, 60, 7), with_noise(grey, 4, 60, 8)),
         from_channels(with_noise(grey, 4, 60, 6), with_noise(grey, 4, 50, 7), with_noise(grey, 4, 60, 9)),
         0.481322, 0.617617, 0.633771},
        {"black and white", rgba_from(flat_picture(200, 160, 0)), rgba_from(flat_picture(200, 160, 255)),
         0.967388, 0.967388, 0.967382},
    };
    for (const Row& row : rows) {
        EXPECT_NEAR(flip_mean(flip_map(row.test, row.reference, 67.0206)), row.at_67, 5e-5) << row.what;
        EXPECT_NEAR(flip_mean(flip_map(row.test, row.reference, 14.11)), row.at_14, 5e-5) << row.what;
        EXPECT_NEAR(flip_mean(flip_map(row.test, row.reference, 5)), row.at_5, 5e-5) << row.what;
    }
}

TEST(Flip, EqualPicturesDoNotDiffer) {
    const RgbaPicture p = rgba_from(textured_picture(40, 30));
    for (const float value : flip_map(p, p, 20)) EXPECT_EQ(value, 0);
}

TEST(Flip, IsSymmetric) {
    const RgbaPicture a = rgba_from(textured_picture(40, 30)),
                      b = rgba_from(box_blurred(textured_picture(40, 30)));
    EXPECT_EQ(flip_map(a, b, 20), flip_map(b, a, 20));
}

TEST(Flip, StaysBetweenNoneAndOneAtEveryExtreme) {
    for (const auto& [w, h] : {std::pair{1, 1}, {2, 1}, {1, 7}, {33, 5}})
        for (const double ppd : {1e-3, 1.0, 30.0, 300.0}) {
            const RgbaPicture noise = rgba_from(with_noise(flat_picture(w, h, 128), 1, 127, 3));
            for (const int code : {0, 255})
                for (const float value : flip_map(noise, rgba_from(flat_picture(w, h, code)), ppd)) {
                    EXPECT_GE(value, 0);
                    EXPECT_LE(value, 1);
                }
        }
}

TEST(Flip, GrowsWithNoiseAndWithCloserViewing) {
    const GreyPicture clean = textured_picture(60, 50);
    double before = 0;
    for (int amplitude = 1; amplitude <= 32; amplitude *= 2) {
        const double now =
            flip_mean(flip_map(rgba_from(with_noise(clean, 1, amplitude, 5)), rgba_from(clean), 20));
        EXPECT_GT(now, before);
        before = now;
    }
    const RgbaPicture noisy = rgba_from(with_noise(clean, 1, 8, 5));
    EXPECT_GT(flip_mean(flip_map(noisy, rgba_from(clean), 15)),
              flip_mean(flip_map(noisy, rgba_from(clean), 60)));
}

TEST(Flip, UnreasonableInputIsRefused) {
    const RgbaPicture p = rgba_from(flat_picture(8, 8, 100)), q = rgba_from(flat_picture(8, 9, 100));
    EXPECT_THROW(flip_map(p, q, 20), std::runtime_error);
    EXPECT_THROW(flip_map(p, p, 0), std::runtime_error);
    EXPECT_THROW(flip_map(p, p, std::nan("")), std::runtime_error);
    EXPECT_THROW(flip_map({}, {}, 20), std::runtime_error);
    EXPECT_EQ(flip_mean({}), 0);
}

}  // namespace
}  // namespace parafovea
