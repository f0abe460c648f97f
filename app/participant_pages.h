// What the participant sees beside the stimuli: pages of text, the fixation cross, the question, calibration
// targets.
#pragma once

#include "app/text_drawing.h"
#include "study/stage.h"

namespace parafovea {

class ParticipantPages {
  public:
    // Sizes are chosen in degrees of this view, so that they are the same in any headset or window. Throws
    // what Font throws.
    explicit ParticipantPages(const ViewGeometry& view, Font font = Font());

    // Any picture but a stimulus. `progress` is the share of the session that is done; where it is above 0,
    // pages of text show it as a bar.
    Image draw(const Picture& picture, double progress = 0) const;

    // Height of a lower-case x. 0.5 degrees is seven pixels at 14 pixels a degree.
    static constexpr double kXHeightDeg = 0.8;
    // Lines are broken to be read without turning the head.
    static constexpr double kTextWidthDeg = 44;

  private:
    void draw_text(Image& image, const std::string& text) const;
    void draw_cross(Image& image) const;
    void draw_target(Image& image, PointPx at) const;
    void draw_progress(Image& image, double share) const;

    ViewGeometry view_;
    Font font_;
};

}  // namespace parafovea
