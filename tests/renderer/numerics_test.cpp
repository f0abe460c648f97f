// The extremes of the maps keep their bounds; every picture of any method with any gaze is whole; elementary
// functions keep their stated errors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "devices/random.h"
#include "renderer/shared/elementary.h"
#include "tests/renderer/numerics_rows.h"
#include "tests/renderer/picture_method.h"

namespace parafovea {
namespace {

void expect_within(const NumericsTable& table) {
    EXPECT_FALSE(table.rows.empty());
    for (const NumericsRow& row : table.rows)
        EXPECT_TRUE(row.within()) << table.title << ": " << row.what << ", " << row.values.front() << ": "
                                  << row.measured << " beyond " << row.bound;
}

TEST(Numerics, round_trips_keep_their_bounds) {
    expect_within(round_trip_table(60));
}

TEST(Numerics, round_trips_on_the_worst_legal_device_keep_the_same_bounds) {
    expect_within(worst_device_table(60));
}

TEST(Numerics, buffer_positions_keep_their_bounds) {
    expect_within(texel_table(60));
}

TEST(Numerics, maps_along_an_axis_keep_their_bounds) {
    expect_within(axis_maps_table(300));
}

TEST(Numerics, gaze_axes_seam_and_tiny_screens_are_as_stated) {
    expect_within(special_places_table());
}

TEST(Numerics, no_result_of_ten_thousand_random_maps_is_no_number_or_outside_the_buffer) {
    const RandomMapCount count = random_maps(10'000, 4);
    EXPECT_EQ(count.bad_here, 0) << count.first_bad;
    EXPECT_EQ(count.bad_on_worst, 0) << count.first_bad;
}

TEST(Numerics, written_with_built_in_functions_the_map_would_miss_by_pixels) {
    // Otherwise the emulation of the worst device would prove nothing.
    double most = 0;
    for (const NumericsRow& row : worst_device_table(60).rows)
        if (row.bound < 0) most = std::fmax(most, row.measured);
    EXPECT_GT(most, 20) << "in units of the bound";
}

TEST(Elementary, logarithm_exponential_and_root_keep_their_stated_errors) {
    Random random(3);
    for (int i = 0; i < 100'000; ++i) {
        const auto x = static_cast<float>(std::exp(random.uniform(-80, 80)));
        const double log = std::log(static_cast<double>(x));
        ASSERT_NEAR(shared::natural_log(x), log, 1e-7 * std::fmax(1.0, std::abs(log))) << x;
        const auto near_one = static_cast<float>(1 + random.uniform(-0.01, 0.01));
        ASSERT_NEAR(shared::natural_log(near_one), std::log(static_cast<double>(near_one)), 4e-9) << near_one;
        ASSERT_NEAR(shared::root_of(x) / std::sqrt(static_cast<double>(x)), 1, 1e-7) << x;
        const auto y = static_cast<float>(random.uniform(-86, 87));
        ASSERT_NEAR(shared::natural_exp(y) / std::exp(static_cast<double>(y)), 1, 1e-7) << y;
    }
    EXPECT_EQ(shared::natural_log(1), 0);
    EXPECT_EQ(shared::natural_exp(0), 1);
    EXPECT_EQ(shared::root_of(0), 0);
    for (const float x : {0.0f, -1.0f, 1e-45f, 1e-38f}) EXPECT_NEAR(shared::natural_log(x), -85.2, 0.1) << x;
    for (const float x : {-1e30f, -1000.0f}) EXPECT_LT(shared::natural_exp(x), 1e-37f);
    for (const float x : {1e30f, 1000.0f}) EXPECT_TRUE(std::isfinite(shared::natural_exp(x)));
}

// Any setting that a method takes, extremes included.
RenderMethod random_setting(const std::string& name, Random& random) {
    RenderMethod setting{name, {}, {}};
    auto& numbers = setting.numbers;
    const auto flag = [&](const char* parameter) { numbers[parameter] = random.chance(0.5) ? 1 : 0; };
    const auto falloff = [&](double least_slope, double most_start) {
        numbers["mar_slope"] = least_slope * std::pow(200 / least_slope, random.uniform());
        numbers["mar_start"] = random.chance(0.3) ? 0 : random.uniform(0, most_start);
    };
    if (name == "kfr") {
        numbers["sigma"] = std::exp2(random.uniform(0, 5));
        numbers["alpha"] = std::exp2(random.uniform(-4, 4));
        numbers["inset"] = random.chance(0.5) ? 0 : random.uniform(0, 0.9);
        flag("as_printed");
    } else if (name == "rings") {
        falloff(0.5, 0.7);
        flag("adaptive");
        numbers["detail"] = random.uniform();
    } else if (name == "log_polar" || name == "rmfr" || name == "log_rectilinear") {
        numbers["sigma"] = std::exp2(random.uniform(0.1, 5));
        if (name == "rmfr" && random.chance(0.5)) numbers["focus"] = random.uniform(0, 10);
    } else if (name == "f3d") {
        numbers["fov_deg"] = random.uniform(1, 170);
        numbers["mar_slope"] = std::pow(10, random.uniform(-3, 0));
        numbers["mar_start"] = std::pow(10, random.uniform(-3, 0));
    } else if (name == "quad_views" || name == "swafford_resolution") {
        numbers["density"] = random.uniform(0.02, 1);
        numbers["blend"] = random.uniform(0.01, 1);
        for (const char* side : {"focus_width", "focus_height"})
            if (name == "quad_views") numbers[side] = random.uniform(0.01, 1);
        if (name == "swafford_resolution") numbers["radius"] = random.uniform(0.01, 2);
    } else if (name == "swafford_occlusion" || name == "swafford_steps") {
        falloff(0.1, 1);
        numbers["least"] = random.uniform(0.05, 1);
    } else if (name != "full") {
        falloff(0.1, 1);
        if (name == "mrs") numbers["detail"] = random.uniform();
        if (name != "ais") flag("interpolate");
    }
    return setting;
}

// White through every method stays white: a pixel that is no number, or that no sample reaches, would be
// black. PARAFOVEA_RANDOM_SETTINGS: how many settings of each method on each screen, instead of 12.
TEST(Numerics, white_stays_white_through_every_method_wherever_the_gaze) {
    Gpu gpu({.validation = true});
    const double nan = std::nan("");
    const char* wanted = std::getenv("PARAFOVEA_RANDOM_SETTINGS");
    const int settings = wanted != nullptr ? std::atoi(wanted) : 12;
    for (const SizePx size : {SizePx{48, 32}, SizePx{7, 29}, SizePx{1, 1}}) {
        Image white{size, {}};
        white.rgba.assign(static_cast<std::size_t>(size.width * size.height) * 4, 255);
        for (const MethodName& method : method_names()) {
            PictureMethod picture(gpu, white, method.name);
            Random random(17);
            for (int i = 0; i < (size.width > 1 ? settings : 4); ++i) {
                RenderMethod setting{method.name, {}, {}};
                if (i > 0) setting = random_setting(method.name, random);
                check(setting);
                Jitter jitter;
                if (i % 2 == 1)
                    jitter = {static_cast<float>(random.uniform(-0.5, 0.5)),
                              static_cast<float>(random.uniform(-0.5, 0.5))};
                PointPx gaze{random.uniform(-0.3, 1.3) * size.width, random.uniform(-0.3, 1.3) * size.height};
                if (i == 0) gaze = {nan, 3};
                if (i == 1) gaze = {0, 0};
                if (i == 2) gaze = {1e6, -1e6};
                if (i == 3) gaze = {size.width / 2 + 0.5, size.height / 2 + 0.5};
                const Image drawn = picture.draw(setting, gaze, jitter);
                const std::uint8_t darkest = *std::min_element(drawn.rgba.begin(), drawn.rgba.end());
                EXPECT_GE(darkest, 254) << method.name << ' ' << size.width << " x " << size.height
                                        << ", gaze " << gaze.x << ", " << gaze.y;
            }
        }
    }
    EXPECT_TRUE(gpu.validation_messages().empty());
}

}  // namespace
}  // namespace parafovea
