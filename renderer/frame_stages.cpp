// Reads what is done to every method's picture.
#include "renderer/frame_stages.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

namespace parafovea {
namespace {

double take(RenderMethod& method, const std::string& name, double otherwise, double low, double high) {
    const auto found = method.numbers.find(name);
    if (found == method.numbers.end()) return otherwise;
    const double value = found->second;
    method.numbers.erase(found);
    if (value >= low && value <= high) return value;
    char text[96];
    std::snprintf(text, sizeof text, " = %g is not in %g to %g", value, low, high);
    throw std::runtime_error("method " + method.name + ": " + name + text);
}

// The digits of a number in a base, mirrored at the point; in [0, 1).
float radical_inverse(int index, int base) {
    double value = 0, digit = 1;
    for (; index > 0; index /= base) {
        digit /= base;
        value += digit * (index % base);
    }
    return static_cast<float>(value);
}

}  // namespace

FrameStages take_frame_stages(RenderMethod& method) {
    FrameStages stages;
    const double frames = take(method, "taa", stages.taa, 0, 64);
    stages.taa = static_cast<int>(frames);
    if (stages.taa != frames)
        throw std::runtime_error("method " + method.name + ": taa is a number of frames, 0 to 64");
    stages.taa_alpha = take(method, "taa_alpha", stages.taa_alpha, 0.01, 1);
    stages.contrast = take(method, "contrast", stages.contrast, 0, 2);
    return stages;
}

Jitter halton_jitter(int index) {
    return {radical_inverse(index + 1, 2) - 0.5f, radical_inverse(index + 1, 3) - 0.5f};
}

}  // namespace parafovea
