// Rasterises glyphs with stb_truetype and blends them into a picture.
#include "app/text_drawing.h"

#include <stb/stb_truetype.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace parafovea {

namespace {

constexpr char32_t kReplacement = 0xFFFD;

void blend(Image& image, int x, int y, double coverage, std::uint8_t grey) {
    if (x < 0 || y < 0 || x >= image.size.width || y >= image.size.height || coverage <= 0) return;
    const std::size_t at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.size.width) +
                                static_cast<std::size_t>(x));
    for (std::size_t channel = 0; channel < 3; ++channel) {
        std::uint8_t& value = image.rgba[at + channel];
        value = static_cast<std::uint8_t>(std::lround(value + std::min(coverage, 1.0) * (grey - value)));
    }
}

// Length of the common part of [low, high] and pixel [at, at + 1].
double overlap(double low, double high, int at) {
    return std::clamp(std::min(high, at + 1.0) - std::max(low, at + 0.0), 0.0, 1.0);
}

}  // namespace

Image blank_image(SizePx size, std::uint8_t grey) {
    Image image{size,
                std::vector<std::uint8_t>(
                    4 * static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height), grey)};
    for (std::size_t alpha = 3; alpha < image.rgba.size(); alpha += 4) image.rgba[alpha] = 255;
    return image;
}

void fill_rectangle(Image& image, PointPx low, PointPx high, std::uint8_t grey) {
    const int left = std::max(0, static_cast<int>(std::floor(low.x))),
              top = std::max(0, static_cast<int>(std::floor(low.y)));
    for (int y = top; y < high.y && y < image.size.height; ++y)
        for (int x = left; x < high.x && x < image.size.width; ++x)
            blend(image, x, y, overlap(low.x, high.x, x) * overlap(low.y, high.y, y), grey);
}

void fill_disc(Image& image, PointPx centre, double radius_px, std::uint8_t grey) {
    const int reach = static_cast<int>(std::ceil(radius_px)) + 1;
    const int cx = static_cast<int>(std::floor(centre.x)), cy = static_cast<int>(std::floor(centre.y));
    for (int y = cy - reach; y <= cy + reach; ++y)
        for (int x = cx - reach; x <= cx + reach; ++x)
            blend(image, x, y, radius_px + 0.5 - std::hypot(x + 0.5 - centre.x, y + 0.5 - centre.y), grey);
}

std::filesystem::path system_font_file() {
    return "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
}

struct Font::Face {
    std::vector<unsigned char> bytes;
    stbtt_fontinfo info{};
    int x_height = 0;  // in the font's own units

    double scale(double em_px) const {
        return stbtt_ScaleForMappingEmToPixels(&info, static_cast<float>(em_px));
    }

    // Calls with each glyph and the pen's position before it; returns the pen's last position.
    template <typename Visit>
    double walk(std::string_view text, double em_px, Visit visit) const {
        double pen = 0;
        int previous = 0;
        for (const char32_t code_point : code_points(text)) {
            const int glyph = stbtt_FindGlyphIndex(&info, static_cast<int>(code_point));
            pen += scale(em_px) * stbtt_GetGlyphKernAdvance(&info, previous, glyph);
            visit(glyph, pen);
            int advance = 0, bearing = 0;
            stbtt_GetGlyphHMetrics(&info, glyph, &advance, &bearing);
            pen += scale(em_px) * advance;
            previous = glyph;
        }
        return pen;
    }
};

Font::Font(const std::filesystem::path& file) : face_(std::make_unique<Face>()) {
    std::ifstream stream(file, std::ios::binary);
    face_->bytes.assign(std::istreambuf_iterator<char>(stream), {});
    if (face_->bytes.empty())
        throw std::runtime_error("font " + file.string() + ": cannot be read; install fonts-dejavu-core");
    const int offset = stbtt_GetFontOffsetForIndex(face_->bytes.data(), 0);
    int left = 0, bottom = 0, right = 0;
    if (offset < 0 || stbtt_InitFont(&face_->info, face_->bytes.data(), offset) == 0 ||
        stbtt_GetCodepointBox(&face_->info, 'x', &left, &bottom, &right, &face_->x_height) == 0 ||
        face_->x_height <= 0)
        throw std::runtime_error("font " + file.string() +
                                 ": expected a TrueType font with Latin letters; install fonts-dejavu-core");
}

Font::Font(Font&&) noexcept = default;
Font::~Font() = default;

double Font::em_px_for_x_height(double x_height_px) const {
    return x_height_px / (face_->scale(1) * face_->x_height);
}

double Font::line_height_px(double em_px) const {
    int ascent = 0, descent = 0, gap = 0;
    stbtt_GetFontVMetrics(&face_->info, &ascent, &descent, &gap);
    return 1.2 * face_->scale(em_px) * (ascent - descent + gap);
}

double Font::width_px(std::string_view text, double em_px) const {
    return face_->walk(text, em_px, [](int, double) {});
}

void Font::draw(Image& image, std::string_view text, double em_px, PointPx left_on_baseline,
                std::uint8_t grey) const {
    const float scale = static_cast<float>(face_->scale(em_px));
    const int baseline = static_cast<int>(std::lround(left_on_baseline.y));
    std::vector<unsigned char> coverage;
    face_->walk(text, em_px, [&](int glyph, double pen) {
        const double x = left_on_baseline.x + pen;
        const int whole = static_cast<int>(std::floor(x));
        const float part = static_cast<float>(x - whole);
        int left = 0, top = 0, right = 0, bottom = 0;
        stbtt_GetGlyphBitmapBoxSubpixel(&face_->info, glyph, scale, scale, part, 0, &left, &top, &right,
                                        &bottom);
        const int width = right - left, height = bottom - top;
        if (width <= 0 || height <= 0) return;
        coverage.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
        stbtt_MakeGlyphBitmapSubpixel(&face_->info, coverage.data(), width, height, width, scale, scale, part,
                                      0, glyph);
        for (int row = 0; row < height; ++row)
            for (int column = 0; column < width; ++column)
                blend(image, whole + left + column, baseline + top + row,
                      coverage[static_cast<std::size_t>(row * width + column)] / 255.0, grey);
    });
}

std::vector<std::string> broken_into_lines(const Font& font, std::string_view text, double em_px,
                                           double width_px) {
    std::vector<std::string> lines;
    while (true) {
        const std::size_t end = text.find('\n');
        std::string_view rest = text.substr(0, end);
        std::string line;
        while (!rest.empty()) {
            // A word takes the spaces before it along, so that spaces inside a line stay as they are.
            const std::size_t word = std::min(rest.find_first_not_of(' '), rest.size());
            const std::size_t after = std::min(rest.find(' ', word), rest.size());
            const std::string longer = line + std::string(rest.substr(0, after));
            if (!line.empty() && font.width_px(longer, em_px) > width_px) {
                lines.push_back(line);
                line = rest.substr(word, after - word);
            } else {
                line = longer;
            }
            rest.remove_prefix(after);
        }
        lines.push_back(line);
        if (end == std::string_view::npos) return lines;
        text.remove_prefix(end + 1);
    }
}

std::vector<char32_t> code_points(std::string_view utf8) {
    std::vector<char32_t> points;
    for (std::size_t i = 0; i < utf8.size();) {
        const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(utf8[at]); };
        const unsigned char first = byte(i);
        // Length of the sequence, the bits of its first byte, and the least code point that needs so many
        // bytes.
        const std::size_t length = first < 0x80         ? 1
                                   : first >> 5 == 0x6  ? 2
                                   : first >> 4 == 0xE  ? 3
                                   : first >> 3 == 0x1E ? 4
                                                        : 0;
        constexpr char32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
        constexpr unsigned char kFirstBits[] = {0, 0x7F, 0x1F, 0x0F, 0x07};
        bool valid = length > 0 && i + length <= utf8.size();
        char32_t point = valid ? first & kFirstBits[length] : 0u;
        for (std::size_t k = 1; valid && k < length; ++k) {
            valid = byte(i + k) >> 6 == 0x2;
            point = point << 6 | (byte(i + k) & 0x3Fu);
        }
        valid =
            valid && point >= kLeast[length] && point <= 0x10FFFF && !(point >= 0xD800 && point <= 0xDFFF);
        points.push_back(valid ? point : kReplacement);
        i += valid ? length : 1;
    }
    return points;
}

}  // namespace parafovea
