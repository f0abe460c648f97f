// Judges pictures and videos.
#include "app/tradeoff_judgement.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

#include "analysis/visible_difference_video.h"
#include "analysis/zone_psnr.h"
#include "app/simulated_participant.h"

namespace parafovea {
namespace {

RgbaView view_of(const Image& image) {
    return {image.rgba, image.size.width, image.size.height};
}

double psnr_of(double mean_squared_error) {
    return 10 * std::log10(255.0 * 255.0 / mean_squared_error);
}

// Errors by zone, added up over frames.
class ErrorSum {
  public:
    void add(const ZoneErrors& errors) {
        ++frames_;
        whole_ += errors.whole.mean_squared_error;
        flip_ += errors.whole.flip;
        for (std::size_t z = 0; z < kEccentricityZones; ++z) {
            const PictureError& zone = errors.zones[z];
            share_[z] += zone.share;
            zone_[z] += zone.share * zone.mean_squared_error;
            zone_flip_[z] += zone.share * zone.flip;
        }
    }

    // A zone without a pixel has no error.
    void write_to(TradeoffRow& row) const {
        row.psnr_whole_db = psnr_of(whole_ / frames_);
        row.flip = flip_ / frames_;
        for (std::size_t z = 0; z < kEccentricityZones; ++z) {
            row.psnr_db[z] = psnr_of(share_[z] > 0 ? zone_[z] / share_[z] : 0);
            row.flip_zone[z] = share_[z] > 0 ? zone_flip_[z] / share_[z] : 0;
        }
    }

  private:
    int frames_ = 0;
    double whole_ = 0, flip_ = 0;
    std::array<double, kEccentricityZones> share_{}, zone_{}, zone_flip_{};
};

void judge_still(const TradeoffReference& reference, const Image& picture, TradeoffRow& row) {
    const LuminancePyramid luminance = luminance_pyramid(view_of(picture), reference.display);
    const GazePx gaze = reference.gazes.front();
    const VisibleDifference difference = compare(contrast_bands(luminance, reference.full_luminance), gaze);
    row.jod = difference.jod;
    for (std::size_t z = 0; z < kEccentricityZones; ++z) row.jod_zone[z] = difference.zones[z].jod;
    row.jod_supersampled = compare(contrast_bands(luminance, reference.super_sampled_luminance), gaze).jod;
    const ContrastBands pair =
        contrast_bands(luminance, reference.full_luminance, ContrastBackground::mean_of_both);
    row.predicted_p_identical =
        expected_share_identical([&](double sensitivity) { return compare(pair, gaze, sensitivity).jod; });
    ErrorSum errors;
    errors.add(zone_errors(view_of(picture), view_of(reference.full.front()), reference.display, gaze));
    errors.write_to(row);
}

// The mean change of the difference between two frames, over red, green and blue.
double change_of_difference(const Image& before, const Image& before_full, const Image& now,
                            const Image& now_full) {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < now.rgba.size(); ++i) {
        if (i % 4 == 3) continue;
        const int was = before.rgba[i] - before_full.rgba[i], is = now.rgba[i] - now_full.rgba[i];
        sum += std::abs(is - was);
    }
    return static_cast<double>(sum) / (static_cast<double>(now.rgba.size()) * 0.75);
}

void judge_video(const TradeoffReference& reference, const std::vector<Image>& pictures, TradeoffRow& row) {
    ErrorSum errors;
    VideoVisibleDifference video(reference.display, reference.refresh_hz);
    VideoVisibleDifference super_sampled(reference.display, reference.refresh_hz);
    std::array<double, kEccentricityZones> zone_q{};
    double transient_q = 0, change = 0;
    const std::size_t frames = pictures.size();
    for (std::size_t f = 0; f < frames; ++f) {
        const GazePx gaze = reference.gazes[f];
        const Image &picture = pictures[f], &full = reference.full[f];
        const FrameDifference frame = video.add_frame(view_of(picture), view_of(full), gaze);
        super_sampled.add_frame(view_of(picture), view_of(reference.super_sampled[f]), gaze);
        for (std::size_t z = 0; z < kEccentricityZones; ++z) zone_q[z] += frame.sustained.zones[z].q;
        transient_q += frame.transient.q;
        errors.add(zone_errors(view_of(picture), view_of(full), reference.display, gaze));
        if (f > 0) change += change_of_difference(pictures[f - 1], reference.full[f - 1], picture, full);
    }
    const auto count = static_cast<double>(frames);
    row.jod = video.jod();
    row.jod_supersampled = super_sampled.jod();
    row.jod_transient = jod_from_q(transient_q / count);
    for (std::size_t z = 0; z < kEccentricityZones; ++z) row.jod_zone[z] = jod_from_q(zone_q[z] / count);
    row.flicker = change / (count - 1);
    errors.write_to(row);

    const ContrastBands pair = decompose(view_of(pictures.back()), view_of(reference.full.back()),
                                         reference.display, ContrastBackground::mean_of_both);
    const double average = compare(pair, reference.gazes.back()).q;
    row.predicted_p_identical = expected_share_identical([&](double sensitivity) {
        const double relative =
            average > 0 ? compare(pair, reference.gazes.back(), sensitivity).q / average : 1;
        return jod_from_q(video.q() * relative);
    });
}

}  // namespace

void prepare(TradeoffReference& reference) {
    assert(!reference.full.empty() && reference.full.size() == reference.super_sampled.size() &&
           reference.full.size() == reference.gazes.size());
    if (reference.full.size() > 1) return;
    reference.full_luminance = luminance_pyramid(view_of(reference.full.front()), reference.display);
    reference.super_sampled_luminance =
        luminance_pyramid(view_of(reference.super_sampled.front()), reference.display);
}

void judge(const TradeoffReference& reference, const std::vector<Image>& pictures, TradeoffRow& row) {
    assert(pictures.size() == reference.full.size());
    if (pictures.size() == 1)
        judge_still(reference, pictures.front(), row);
    else
        judge_video(reference, pictures, row);
}

}  // namespace parafovea
