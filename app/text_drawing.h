// Text and simple shapes drawn into a picture, with a TrueType font of the system.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "devices/geometry.h"
#include "renderer/image.h"

namespace parafovea {

// All of one grey, opaque.
Image blank_image(SizePx size, std::uint8_t grey = 0);

// Shapes with smooth edges; what lies outside the picture is cut off.
void fill_rectangle(Image& image, PointPx low, PointPx high, std::uint8_t grey);
void fill_disc(Image& image, PointPx centre, double radius_px, std::uint8_t grey);

// Where Debian's fonts-dejavu-core puts DejaVu Sans.
std::filesystem::path system_font_file();

// One face of a TrueType file. Text is UTF-8; what is not valid UTF-8 is drawn as U+FFFD.
class Font {
  public:
    // Throws std::runtime_error with one line where the file is missing or is no font.
    explicit Font(const std::filesystem::path& file = system_font_file());
    Font(Font&&) noexcept;
    ~Font();

    // The em size at which a lower-case x is so high.
    double em_px_for_x_height(double x_height_px) const;
    double line_height_px(double em_px) const;
    double width_px(std::string_view text, double em_px) const;

    // Draws one line of text beginning at `left` on the baseline.
    void draw(Image& image, std::string_view text, double em_px, PointPx left_on_baseline,
              std::uint8_t grey) const;

  private:
    struct Face;
    std::unique_ptr<Face> face_;
};

// Breaks text at its line ends and, where a line is wider than `width_px`, between words. A word that is
// wider has a line of its own.
std::vector<std::string> broken_into_lines(const Font& font, std::string_view text, double em_px,
                                           double width_px);

// The code points of UTF-8; U+FFFD for each byte that is not part of a valid sequence.
std::vector<char32_t> code_points(std::string_view utf8);

}  // namespace parafovea
