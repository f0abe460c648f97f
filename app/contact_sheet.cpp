// Renders and lays out contact sheets.
#include "app/contact_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "app/text_drawing.h"

namespace parafovea {
namespace {

constexpr int kColumns = 2, kGapPx = 8, kLabelPx = 26;
constexpr double kTextPx = 16;
constexpr std::uint8_t kPaper = 24, kInk = 235;

std::size_t index_of(const Image& image, int x, int y) {
    return static_cast<std::size_t>(y * image.size.width + x) * 4;
}

void paste(Image& sheet, const Image& picture, int left, int top) {
    for (int y = 0; y < picture.size.height; ++y) {
        std::copy_n(&picture.rgba[index_of(picture, 0, y)], static_cast<std::size_t>(picture.size.width) * 4,
                    &sheet.rgba[index_of(sheet, left, top + y)]);
    }
}

// The mean of every 2 x 2 pixels.
Image halved(const Image& image) {
    Image half = blank_image({std::max(image.size.width / 2, 1), std::max(image.size.height / 2, 1)});
    for (int y = 0; y < half.size.height; ++y) {
        for (int x = 0; x < half.size.width; ++x) {
            const int right = std::min(2 * x + 1, image.size.width - 1);
            const int below = std::min(2 * y + 1, image.size.height - 1);
            for (std::size_t c = 0; c < 4; ++c) {
                const int sum = image.rgba[index_of(image, 2 * x, 2 * y) + c] +
                                image.rgba[index_of(image, right, 2 * y) + c] +
                                image.rgba[index_of(image, 2 * x, below) + c] +
                                image.rgba[index_of(image, right, below) + c];
                half.rgba[index_of(half, x, y) + c] = static_cast<std::uint8_t>((sum + 2) / 4);
            }
        }
    }
    return half;
}

// A square of the picture with each pixel drawn twice as large; kept within the picture.
Image magnified(const Image& image, PointPx centre, int side) {
    Image part = blank_image({2 * side, 2 * side});
    const int left = std::clamp(static_cast<int>(centre.x) - side / 2, 0, image.size.width - side);
    const int top = std::clamp(static_cast<int>(centre.y) - side / 2, 0, image.size.height - side);
    for (int y = 0; y < part.size.height; ++y) {
        for (int x = 0; x < part.size.width; ++x) {
            std::copy_n(&image.rgba[index_of(image, left + x / 2, top + y / 2)], 4,
                        &part.rgba[index_of(part, x, y)]);
        }
    }
    return part;
}

// Dark blue for few samples, through teal and yellow, to white for many; ever lighter.
std::array<std::uint8_t, 3> colour_of(double share) {
    constexpr std::array<std::array<double, 3>, 5> kStops{
        {{12, 8, 58}, {28, 72, 150}, {26, 152, 142}, {222, 208, 60}, {255, 255, 255}}};
    const double at = std::clamp(share, 0.0, 1.0) * (kStops.size() - 1);
    const auto low = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
    std::array<std::uint8_t, 3> colour{};
    for (std::size_t c = 0; c < 3; ++c) {
        colour[c] = static_cast<std::uint8_t>(
            std::lround(std::lerp(kStops[low][c], kStops[low + 1][c], at - static_cast<double>(low))));
    }
    return colour;
}

void colour_pixel(Image& image, int x, int y, double share) {
    const auto colour = colour_of(share);
    std::copy_n(colour.begin(), 3, &image.rgba[index_of(image, x, y)]);
}

constexpr double kFewest = -6, kMost = 4;  // powers of two

double share_of_scale(double samples_per_pixel) {
    return (std::log2(samples_per_pixel) - kFewest) / (kMost - kFewest);
}

// Cells of one size in columns, each with its label above; `extra_px` rows below all of them.
class Sheet {
  public:
    Sheet(SizePx cell, std::size_t cells, int extra_px)
        : cell_(cell), rows_((static_cast<int>(cells) + kColumns - 1) / kColumns) {
        image_ = blank_image(
            {kGapPx + kColumns * (cell.width + kGapPx), rows_ * row_px() + kGapPx + extra_px}, kPaper);
    }

    // Writes the next cell's label; the pictures' top left corner.
    std::pair<int, int> next(const std::string& label) {
        const int left = kGapPx + (count_ % kColumns) * (cell_.width + kGapPx);
        const int top = (count_ / kColumns) * row_px() + kLabelPx;
        ++count_;
        text(label, left, top - 7);
        return {left, top};
    }
    void text(const std::string& words, double left, double baseline) {
        font_.draw(image_, words, kTextPx, {left, baseline}, kInk);
    }
    Image& image() { return image_; }
    int end_of_cells() const { return rows_ * row_px() + kGapPx; }

  private:
    int row_px() const { return kLabelPx + cell_.height + kGapPx; }

    SizePx cell_;
    int rows_;
    int count_ = 0;
    Image image_;
    Font font_;
};

void draw_scale(Sheet& sheet) {
    constexpr int kBarPx = 16;
    const int top = sheet.end_of_cells() + 4, width = sheet.image().size.width - 2 * kGapPx - 150;
    for (int y = 0; y < kBarPx; ++y) {
        for (int x = 0; x < width; ++x)
            colour_pixel(sheet.image(), kGapPx + x, top + y, static_cast<double>(x) / (width - 1));
    }
    for (int power = static_cast<int>(kFewest); power <= static_cast<int>(kMost); power += 2) {
        const double x = kGapPx + (power - kFewest) / (kMost - kFewest) * width;
        const std::string words = power < 0 ? "1/" + std::to_string(1 << -power) : std::to_string(1 << power);
        sheet.text(words, x, top + kBarPx + 17);
    }
    sheet.text("samples per pixel", kGapPx + width + 8, top + 13);
}

}  // namespace

std::vector<SheetEntry> kfr_sheet(const RenderMethod& more) {
    const auto entry = [&](const std::string& label, RenderMethod method) {
        for (const auto& [name, value] : more.numbers) method.numbers.try_emplace(name, value);
        return SheetEntry{label, std::move(method)};
    };
    std::vector<SheetEntry> entries{entry("full resolution", {"full", {}, {}})};
    char label[64];
    for (const double sigma : {1.2, 1.8, 2.4}) {
        std::snprintf(label, sizeof label, "KFR \u03c3 = %.1f, \u03b1 = 4", sigma);
        entries.push_back(entry(label, {"kfr", {{"sigma", sigma}, {"alpha", 4}}, {}}));
    }
    for (int alpha = 1; alpha <= 6; ++alpha) {
        std::snprintf(label, sizeof label, "KFR \u03c3 = 1.8, \u03b1 = %d", alpha);
        entries.push_back(entry(label, {"kfr", {{"sigma", 1.8}, {"alpha", static_cast<double>(alpha)}}, {}}));
    }
    return entries;
}

Image contact_sheet(FrameRenderer& renderer, SizePx size, const CameraView& view, PointPx gaze,
                    const std::vector<SheetEntry>& entries) {
    const int side = std::max(std::min({size.height / 4, size.width, size.height}), 1);
    const SizePx whole{size.width / 2, size.height / 2};
    // The periphery is the corner farthest from the gaze, a little inside.
    const PointPx far{size.width * (gaze.x < 0.5 * size.width ? 0.9 : 0.1),
                      size.height * (gaze.y < 0.5 * size.height ? 0.85 : 0.15)};
    Sheet sheet({whole.width + 2 * (2 * side + kGapPx / 2), std::max(whole.height, 2 * side)}, entries.size(),
                0);
    for (const SheetEntry& entry : entries) {
        const RenderedFrame frame = renderer.render(size, view, entry.method, gaze);
        char cost[64];
        std::snprintf(cost, sizeof cost, ": %.1f %% of the pixels shaded",
                      100 * static_cast<double>(frame.statistics.shaded_samples) /
                          static_cast<double>(frame.statistics.screen_pixels));
        const auto [left, top] = sheet.next(entry.label + cost);
        paste(sheet.image(), halved(frame.image), left, top);
        int at = left + whole.width + kGapPx / 2;
        for (const PointPx& centre : {gaze, far}) {
            paste(sheet.image(), magnified(frame.image, centre, side), at, top);
            at += 2 * side + kGapPx / 2;
        }
    }
    return std::move(sheet.image());
}

Image density_sheet(FrameRenderer& renderer, SizePx size, PointPx gaze,
                    const std::vector<SheetEntry>& entries) {
    const SizePx half{std::max(size.width / 2, 1), std::max(size.height / 2, 1)};
    constexpr int kScalePx = 44;
    Sheet sheet(half, entries.size(), kScalePx);
    for (const SheetEntry& entry : entries) {
        const std::vector<double> density = renderer.sample_density(size, entry.method, gaze);
        const auto [left, top] = sheet.next(entry.label);
        for (int y = 0; y < half.height; ++y) {
            for (int x = 0; x < half.width; ++x) {
                const auto at = static_cast<std::size_t>(2 * y * size.width + 2 * x);
                colour_pixel(sheet.image(), left + x, top + y, share_of_scale(density[at]));
            }
        }
    }
    draw_scale(sheet);
    return std::move(sheet.image());
}

}  // namespace parafovea
