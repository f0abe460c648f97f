// How far apart a method's samples lie over the whole screen, for the stages that come after it.
#pragma once

#include <vector>

#include "renderer/methods/foveation_method.h"
#include "renderer/shared/spacing.h"

namespace parafovea {

// Radial and tangential spacings in pixels, each at least 1, of the cells of renderer/shared/spacing.h.
using SpacingGrid = std::vector<shared::vec2>;

// Of what the method's last prepare() was for.
SpacingGrid spacing_grid(const FoveationMethod& method, SizePx screen);

}  // namespace parafovea
