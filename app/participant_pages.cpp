// Lays out the participant's pages.
#include "app/participant_pages.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>
#include <vector>

namespace parafovea {

namespace {

// Light grey on black: easy on eyes that are used to the dark of a headset and the black gap.
constexpr std::uint8_t kInk = 205, kDimInk = 110, kTrough = 40;

}  // namespace

ParticipantPages::ParticipantPages(const ViewGeometry& view, Font font)
    : view_(view), font_(std::move(font)) {}

Image ParticipantPages::draw(const Picture& picture, double progress) const {
    assert(picture.kind != PictureKind::stimulus);
    Image image = blank_image(view_.size);
    switch (picture.kind) {
        case PictureKind::fixation:
            draw_cross(image);
            break;
        case PictureKind::target:
            draw_target(image, picture.fovea);
            break;
        case PictureKind::question:
            draw_text(image, picture.text);
            break;
        case PictureKind::text:
            draw_text(image, picture.text);
            if (progress > 0) draw_progress(image, progress);
            break;
        case PictureKind::black:
        case PictureKind::stimulus:
            break;
    }
    return image;
}

void ParticipantPages::draw_text(Image& image, const std::string& text) const {
    const double em_px = font_.em_px_for_x_height(kXHeightDeg * view_.pixels_per_degree());
    const double widest_px = std::min(kTextWidthDeg * view_.pixels_per_degree(), 0.9 * view_.size.width);
    // Line ends at the end of a text are habits of whoever typed it.
    const std::string trimmed = text.substr(0, text.find_last_not_of("\n ") + 1);
    const std::vector<std::string> lines = broken_into_lines(font_, trimmed, em_px, widest_px);

    // Lines begin at one left edge, so that answers stand in a column; the block as a whole is centred.
    double block_px = 0;
    for (const std::string& line : lines) block_px = std::max(block_px, font_.width_px(line, em_px));
    const double line_px = font_.line_height_px(em_px);
    PointPx pen = {(view_.size.width - block_px) / 2,
                   (view_.size.height - line_px * static_cast<double>(lines.size())) / 2 + 0.75 * line_px};
    for (const std::string& line : lines) {
        font_.draw(image, line, em_px, pen, kInk);
        pen.y += line_px;
    }
}

void ParticipantPages::draw_cross(Image& image) const {
    const double arm = 0.5 * view_.pixels_per_degree(), half = 0.06 * view_.pixels_per_degree();
    const PointPx c = centre_of(view_.size);
    fill_rectangle(image, {c.x - arm, c.y - half}, {c.x + arm, c.y + half}, kInk);
    fill_rectangle(image, {c.x - half, c.y - arm}, {c.x + half, c.y + arm}, kInk);
}

void ParticipantPages::draw_target(Image& image, PointPx at) const {
    // A disc with a dark bull's eye holds the eye better than a plain disc.
    const double px = view_.pixels_per_degree();
    fill_disc(image, at, 0.6 * px, kInk);
    fill_disc(image, at, 0.15 * px, 0);
}

void ParticipantPages::draw_progress(Image& image, double share) const {
    const double px = view_.pixels_per_degree();
    const PointPx c = centre_of(view_.size);
    const double left = c.x - 10 * px, right = c.x + 10 * px;
    const double top = c.y + std::min(16 * px, 0.4 * view_.size.height), bottom = top + 0.4 * px;
    fill_rectangle(image, {left, top}, {right, bottom}, kTrough);
    fill_rectangle(image, {left, top}, {left + std::min(share, 1.0) * (right - left), bottom}, kDimInk);
}

}  // namespace parafovea
