// Prints what the number format of the reduced buffer costs and what it changes, and what interpolating with
// full weights does: the last table of docs/numerics.md. Usage: renderer_precision [width height [frames]];
// formats take turns frame by frame.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "renderer/methods/kfr_method.h"
#include "tests/renderer/picture_method.h"

namespace parafovea {
namespace {

struct Choice {
    const char* name;
    int bits;  // of a texel
    VkFormat format;
    bool exact_bilinear = false;
};

constexpr Choice kChoices[] = {{"32-bit float", 128, VK_FORMAT_R32G32B32A32_SFLOAT},
                               {"32-bit float, full weights", 128, VK_FORMAT_R32G32B32A32_SFLOAT, true},
                               {"16-bit fixed point (the default)", 64, VK_FORMAT_R16G16B16A16_UNORM},
                               {"16-bit float", 64, VK_FORMAT_R16G16B16A16_SFLOAT},
                               {"11, 11 and 10-bit float", 32, VK_FORMAT_B10G11R11_UFLOAT_PACK32},
                               {"10-bit fixed point", 32, VK_FORMAT_A2B10G10R10_UNORM_PACK32},
                               {"8-bit fixed point, linear", 32, VK_FORMAT_R8G8B8A8_UNORM},
                               {"8-bit fixed point, sRGB curve", 32, VK_FORMAT_R8G8B8A8_SRGB}};

bool can_be_drawn_to(const Gpu& gpu, VkFormat format) {
    VkFormatProperties properties;
    vkGetPhysicalDeviceFormatProperties(gpu.physical_device(), format, &properties);
    const VkFormatFeatureFlags needed =
        VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    return (properties.optimalTilingFeatures & needed) == needed;
}

double pass_ms(const std::vector<PassTimer::Pass>& passes, const char* name) {
    double ms = 0;
    for (const PassTimer::Pass& pass : passes)
        if (pass.name.find(name) != std::string::npos) ms += pass.ms;
    return ms;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

struct Difference {
    int most = 0;      // in steps of 8 bits
    double psnr = 0;   // dB; infinite where equal
    double share = 0;  // of values that differ
};

Difference difference(const Image& a, const Image& b) {
    Difference result;
    double squares = 0, differing = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const int d = std::abs(a.rgba[i] - b.rgba[i]);
        result.most = std::max(result.most, d);
        squares += d * d;
        differing += d > 0 ? 1 : 0;
    }
    const auto n = static_cast<double>(a.rgba.size());
    result.psnr = 10 * std::log10(255.0 * 255.0 / (squares / n));
    result.share = differing / n;
    return result;
}

void report(SizePx size, int frames) {
    Gpu gpu({.validation = false});
    std::printf("Device: %s. %d x %d, sigma 1.8, alpha 4, median of %d frames.\n\n",
                gpu.device_name().c_str(), size.width, size.height, frames);
    std::printf(
        "| reduced buffer | bits a texel | picture | largest difference, steps of 8 bits | values that "
        "differ | PSNR | time "
        "of the frame, share of the default's | all passes, ms |\n|---|---:|---|---:|---:|---:|---:|---:|\n");
    for (const bool noise : {false, true}) {
        const Image picture = noise ? noise_picture(size) : smooth_picture(size);
        std::vector<const Choice*> choices;
        std::vector<std::unique_ptr<PictureMethod>> methods;
        for (const Choice& choice : kChoices) {
            if (!can_be_drawn_to(gpu, choice.format)) continue;
            choices.push_back(&choice);
            methods.push_back(std::make_unique<PictureMethod>(gpu, picture, [&](const ShadingSource& source) {
                return std::make_unique<KfrMethod>(
                    gpu, source,
                    KfrFormats{.reduced = choice.format, .exact_bilinear = choice.exact_bilinear});
            }));
        }
        std::vector<std::vector<double>> times(choices.size());
        std::vector<Image> images(choices.size());
        for (int frame = 0; frame <= frames; ++frame)
            for (std::size_t i = 0; i < choices.size(); ++i) {
                images[i] = methods[i]->draw({"kfr", {}, {}}, centre_of(size));
                if (frame > 0)
                    times[i].push_back(pass_ms(methods[i]->passes(), ""));  // the first builds pipelines
            }
        double usual = 0;
        for (std::size_t i = 0; i < choices.size(); ++i)
            if (choices[i]->format == VK_FORMAT_R16G16B16A16_UNORM) usual = median(times[i]);
        for (std::size_t i = 0; i < choices.size(); ++i) {
            const Difference d = difference(images[i], images[0]);
            std::printf("| %s | %d | %s | %d | %.2f %% | ", choices[i]->name, choices[i]->bits,
                        noise ? "noise" : "slow waves", d.most, 100 * d.share);
            if (d.most == 0)
                std::printf("equal");
            else
                std::printf("%.1f dB", d.psnr);
            std::printf(" | %.2f | %.2f |\n", usual > 0 ? median(times[i]) / usual : 0, median(times[i]));
        }
    }
}

}  // namespace
}  // namespace parafovea

int main(int argc, char** argv) {
    const int width = argc > 2 ? std::atoi(argv[1]) : 1280, height = argc > 2 ? std::atoi(argv[2]) : 720;
    const int frames = argc > 3 ? std::atoi(argv[3]) : 9;
    if (width < 1 || height < 1 || frames < 1) {
        std::fprintf(stderr, "usage: renderer_precision [width height [frames]]\n");
        return 2;
    }
    parafovea::report({width, height}, frames);
}
