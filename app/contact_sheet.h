// Contact sheets: one scene at every setting of a figure, whole and zoomed in at the gaze and in the
// periphery, and where each setting's samples lie.
#pragma once

#include <string>
#include <vector>

#include "renderer/frame_renderer.h"

namespace parafovea {

struct SheetEntry {
    std::string label;
    RenderMethod method;
};

// Meng et al. 2018, Figs. 4, 6 and 7: full resolution; sigma 1.2, 1.8, 2.4 at alpha 4; alpha 1 to 6 at sigma
// 1.8. `more` is added to every method's parameters (for stages such as taa).
std::vector<SheetEntry> kfr_sheet(const RenderMethod& more);

// Every entry with the whole picture at half its size beside a part around the gaze and a part of the
// periphery, both magnified twice. Throws what rendering throws, and std::runtime_error where there is no
// font.
Image contact_sheet(FrameRenderer& renderer, SizePx size, const CameraView& view, PointPx gaze,
                    const std::vector<SheetEntry>& entries);

// Samples for each pixel over the screen (Meng et al. 2018, Fig. 5), at half the screen's size, with a scale
// from 1/64 to 16.
Image density_sheet(FrameRenderer& renderer, SizePx size, PointPx gaze,
                    const std::vector<SheetEntry>& entries);

}  // namespace parafovea
