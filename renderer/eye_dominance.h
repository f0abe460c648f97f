// Two eyes, two degrees of foveation: the eye that does not lead may be drawn coarser.
//
// Source: Meng, Du, Varshney 2020, "Eye-dominance-guided Foveated Rendering" (IEEE TVCG 26(5)).
#pragma once

#include "renderer/methods/foveation_method.h"

namespace parafovea {

enum class Eye { left, right };

// The method for one eye of two. Parameters, of any method that has sigma: `sigma_other_eye`, the sigma of
// the eye that is not dominant (at least that of the dominant one; absent: both are drawn alike), and
// the word `dominant_eye`, "left" or "right" (the default). Throws std::runtime_error with one line if one of
// them is out of range.
RenderMethod method_for_eye(const RenderMethod& method, Eye eye);

// The method for a picture that is meant for both eyes, or for one that is not told which it is: as for the
// dominant eye.
RenderMethod method_for_dominant_eye(const RenderMethod& method);

}  // namespace parafovea
