// Visible differences of pairs of pictures, each pair taken apart once for as long as it is remembered.
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <mutex>
#include <span>

#include "analysis/visible_difference.h"
#include "devices/geometry.h"

namespace parafovea {

// A picture as it reaches an eye: 8-bit sRGB, 4 bytes a pixel, rows from the top, and a hash of those bytes
// by which the same picture is recognised.
struct PictureOnDisplay {
    std::span<const std::uint8_t> rgba;
    SizePx size;
    std::uint64_t hash = 0;
};

// The display of a view, at a contrast of 1000:1 in a dark surround, as inside a headset.
DisplayModel display_model(const ViewGeometry& view, double peak_luminance_cd_m2);

// May be used by several threads. Which pair is remembered never changes an answer.
class PicturePairJudge {
  public:
    // Remembers as many of the pairs last judged as fit into `memory_bytes` (one pair of 1280x1440 takes 20
    // MB).
    explicit PicturePairJudge(const DisplayModel& display, std::size_t memory_bytes = std::size_t{1} << 30);

    // How visible the difference of two pictures is at a gaze, on the JOD scale (10: not at all); the order
    // of the two does not matter, and pictures of equal hash do not differ. Throws what visible_difference.h
    // throws for pictures of another size.
    double jod(const PictureOnDisplay& a, const PictureOnDisplay& b, PointPx gaze, double sensitivity = 1);

    const DisplayModel& display() const { return display_; }

    // How many pairs have been taken apart so far.
    std::int64_t decompositions() const;

  private:
    struct Pair {
        std::uint64_t first_hash = 0, second_hash = 0;
        ContrastBands bands;
        int readers = 0;  // threads reading it now; it is kept as long
    };

    std::list<Pair>::iterator find(std::uint64_t first_hash, std::uint64_t second_hash);
    void forget_beyond_capacity();

    DisplayModel display_;
    std::size_t capacity_;
    mutable std::mutex mutex_;
    std::list<Pair> pairs_;  // the last one used in front
    std::int64_t decompositions_ = 0;
};

}  // namespace parafovea
