// How far apart a method's samples lie all over the screen, as stages after it read it: a coarse grid of
// spacings.
#ifndef PARAFOVEA_SPACING_H
#define PARAFOVEA_SPACING_H

#include "bridge.h"

SHARED_BEGIN

// Cell (i, j) is about the screen position ((i + 0.5) / columns, (j + 0.5) / rows) of its width and height;
// cells lie row by row.
const uint kSpacingColumns = 64u;
const uint kSpacingRows = 36u;

SHARED_END

#endif
