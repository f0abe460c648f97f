// Remembers decomposed pairs of pictures and judges them.
#include "app/picture_pair_judge.h"

#include <algorithm>
#include <utility>

namespace parafovea {
namespace {

std::size_t bytes_of(const ContrastBands& bands) {
    std::size_t bytes = 0;
    for (const auto& band : bands.bands)
        bytes += band.difference.size() * (2 * sizeof(float) + sizeof(std::uint16_t));
    return bytes;
}

RgbaView view_of(const PictureOnDisplay& picture) {
    return {picture.rgba, picture.size.width, picture.size.height};
}

}  // namespace

DisplayModel display_model(const ViewGeometry& view, double peak_luminance_cd_m2) {
    return {view.size.width, view.size.height, view.horizontal_fov_deg, peak_luminance_cd_m2, 1000, 0};
}

PicturePairJudge::PicturePairJudge(const DisplayModel& display, std::size_t memory_bytes)
    : display_(display), capacity_(memory_bytes) {}

std::list<PicturePairJudge::Pair>::iterator PicturePairJudge::find(std::uint64_t first_hash,
                                                                   std::uint64_t second_hash) {
    return std::find_if(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
        return pair.first_hash == first_hash && pair.second_hash == second_hash;
    });
}

void PicturePairJudge::forget_beyond_capacity() {
    std::size_t bytes = 0;
    for (auto pair = pairs_.begin(); pair != pairs_.end();) {
        bytes += bytes_of(pair->bands);
        if (bytes > capacity_ && pair->readers == 0)
            pair = pairs_.erase(pair);
        else
            ++pair;
    }
}

double PicturePairJudge::jod(const PictureOnDisplay& a, const PictureOnDisplay& b, PointPx gaze,
                             double sensitivity) {
    if (a.hash == b.hash) return jod_from_q(0);
    // The order by hash makes the answer the same to the last bit whichever came first.
    const PictureOnDisplay &first = a.hash <= b.hash ? a : b, &second = a.hash <= b.hash ? b : a;

    std::unique_lock lock(mutex_);
    auto pair = find(first.hash, second.hash);
    if (pair == pairs_.end()) {
        lock.unlock();
        ContrastBands bands =
            decompose(view_of(second), view_of(first), display_, ContrastBackground::mean_of_both);
        lock.lock();
        ++decompositions_;
        // Another thread may have been faster.
        pair = find(first.hash, second.hash);
        if (pair == pairs_.end())
            pair = pairs_.insert(pairs_.begin(), Pair{first.hash, second.hash, std::move(bands), 0});
    }
    pairs_.splice(pairs_.begin(), pairs_, pair);
    ++pair->readers;
    lock.unlock();

    const double judged = compare(pair->bands, {gaze.x, gaze.y}, sensitivity).jod;

    lock.lock();
    --pair->readers;
    forget_beyond_capacity();
    return judged;
}

std::int64_t PicturePairJudge::decompositions() const {
    const std::lock_guard lock(mutex_);
    return decompositions_;
}

}  // namespace parafovea
