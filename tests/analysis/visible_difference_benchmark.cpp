// How long one judgement of a pair takes at the size of one eye's picture.
#include <benchmark/benchmark.h>

#include "analysis/visible_difference.h"
#include "tests/analysis/visible_difference_pictures.h"

namespace parafovea {
namespace {

struct Pair {
    DisplayModel display{1280, 1440, 90, 100, 1000, 0};
    RgbaPicture reference = rgba_from(textured_picture(1280, 1440));
    RgbaPicture test = rgba_from(box_blurred(textured_picture(1280, 1440)));
};

void luminance_pyramid_1280x1440(benchmark::State& state) {
    const Pair pair;
    for (auto _ : state) benchmark::DoNotOptimize(luminance_pyramid(pair.test, pair.display));
}
BENCHMARK(luminance_pyramid_1280x1440)->Unit(benchmark::kMillisecond);

void contrast_bands_1280x1440(benchmark::State& state) {
    const Pair pair;
    const LuminancePyramid test = luminance_pyramid(pair.test, pair.display);
    const LuminancePyramid reference = luminance_pyramid(pair.reference, pair.display);
    for (auto _ : state) benchmark::DoNotOptimize(contrast_bands(test, reference));
}
BENCHMARK(contrast_bands_1280x1440)->Unit(benchmark::kMillisecond);

void compare_1280x1440(benchmark::State& state) {
    const Pair pair;
    const ContrastBands bands = decompose(pair.test, pair.reference, pair.display);
    for (auto _ : state) benchmark::DoNotOptimize(compare(bands, {500, 700}));
}
BENCHMARK(compare_1280x1440)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace parafovea
