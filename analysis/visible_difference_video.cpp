// Filters two videos over time and judges both channels of every frame.
#include "analysis/visible_difference_video.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "analysis/visible_difference_parameters.h"
#include "analysis/visible_difference_pyramid.h"

namespace parafovea {
namespace {

constexpr double kFilterSeconds = 0.25;
constexpr double kSustainedPeakSeconds = 0.06, kSustainedSpread = 0.5, kLeastSeconds = 1e-4;
constexpr double kTransientScale = 0.062170507756932;
constexpr double kTransientWeight = 0.25;
constexpr double kChannelPower = 0.666092;

PARAFOVEA_VECTORISED
void add_scaled(const float* in, float weight, std::size_t count, float* sum) {
    for (std::size_t i = 0; i < count; ++i) sum[i] += weight * in[i];
}

}  // namespace

TemporalFilters temporal_filters(double frames_per_second) {
    if (!(frames_per_second > 0 && frames_per_second <= 1000))
        throw std::runtime_error("visible difference: the frame rate must be above 0 and at most 1000 Hz");
    const auto taps = static_cast<std::size_t>(std::ceil(kFilterSeconds * frames_per_second));
    const double step = static_cast<double>(taps) / static_cast<double>(std::max<std::size_t>(taps - 1, 1)) /
                        frames_per_second;
    TemporalFilters filters;
    for (std::size_t k = 0; k < taps; ++k) {
        const double z =
            std::log(static_cast<double>(k) * step + kLeastSeconds) - std::log(kSustainedPeakSeconds);
        filters.sustained.push_back(std::exp(-z * z / (2 * kSustainedSpread * kSustainedSpread)));
    }
    const double sum = std::accumulate(filters.sustained.begin(), filters.sustained.end(), 0.0);
    for (double& weight : filters.sustained) weight /= sum;
    for (std::size_t k = 0; k + 1 < taps; ++k)
        filters.transient.push_back(kTransientScale * (filters.sustained[k + 1] - filters.sustained[k]) /
                                    step);
    filters.transient.push_back(0);
    return filters;
}

VideoVisibleDifference::VideoVisibleDifference(const DisplayModel& display, double frames_per_second)
    : display_(display), filters_(temporal_filters(frames_per_second)) {}

LuminancePyramid VideoVisibleDifference::filtered(const std::vector<double>& weights,
                                                  LuminancePyramid::Level Frame::*which) const {
    const LuminancePyramid::Level& newest = history_.front().*which;
    LuminancePyramid::Level sum{newest.width, newest.height,
                                std::vector<float>(newest.luminance_cd_m2.size())};
    // The oldest frame stands for all before it.
    for (std::size_t k = 0; k < history_.size(); ++k) {
        double weight = weights[k];
        if (k + 1 == history_.size())
            weight = std::accumulate(weights.begin() + static_cast<std::ptrdiff_t>(k), weights.end(), 0.0);
        add_scaled((history_[k].*which).luminance_cd_m2.data(), static_cast<float>(weight),
                   sum.luminance_cd_m2.size(), sum.luminance_cd_m2.data());
    }
    return pyramid_over(std::move(sum), display_);
}

FrameDifference VideoVisibleDifference::add_frame(RgbaView test, RgbaView reference, GazePx gaze) {
    history_.push_front({luminance_plane(test, display_), luminance_plane(reference, display_)});
    if (history_.size() > filters_.sustained.size()) history_.pop_back();

    const LuminancePyramid steady_test = filtered(filters_.sustained, &Frame::test);
    const LuminancePyramid steady_reference = filtered(filters_.sustained, &Frame::reference);
    FrameDifference frame;
    frame.sustained = compare(contrast_bands(steady_test, steady_reference), gaze);
    frame.transient = compare(
        relative_contrast(filtered(filters_.transient, &Frame::test),
                          filtered(filters_.transient, &Frame::reference), steady_test, steady_reference,
                          ContrastBackground::reference, TemporalChannel::transient),
        gaze);
    frame.q = std::pow(std::pow(frame.sustained.q, kChannelPower) +
                           std::pow(kTransientWeight * frame.transient.q, kChannelPower),
                       1 / kChannelPower);
    q_.push_back(frame.q);
    return frame;
}

double VideoVisibleDifference::q() const {
    return q_.empty() ? 0 : std::accumulate(q_.begin(), q_.end(), 0.0) / static_cast<double>(q_.size());
}

}  // namespace parafovea
