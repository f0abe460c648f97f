// What is done to the picture of any method after it is drawn: anti-aliasing over time, contrast
// preservation.
#pragma once

#include "renderer/methods/foveation_method.h"

namespace parafovea {

struct FrameStages {
    // A frame's samples take turns at this many places (Halton sequence of bases 2 and 3, Karis 2014); 0: no
    // anti-aliasing over time. A still picture is the mean of that many frames, as a running view shows it
    // when it has stood still for as long.
    int taa = 0;
    double taa_alpha = 0.1;  // the weight of a new frame at least; until 1 / taa_alpha frames all weigh alike
    // f_e of Patney et al. 2016: gain of contrast for each pixel of blur (they use 0.2); 0: left as it is.
    double contrast = 0;

    bool operator==(const FrameStages&) const = default;
};

// Takes the parameters taa (0 to 64), taa_alpha (0.01 to 1) and contrast (0 to 2) out of a method, whatever
// its name. Throws std::runtime_error with one line if one is out of range.
FrameStages take_frame_stages(RenderMethod& method);

// Place `index` (from 0) of the sequence, in [-0.5, 0.5) along both axes.
Jitter halton_jitter(int index);

}  // namespace parafovea
