// Asks a method for its spacing all over the screen.
#include "renderer/spacing_grid.h"

#include <algorithm>

namespace parafovea {

SpacingGrid spacing_grid(const FoveationMethod& method, SizePx screen) {
    SpacingGrid grid;
    grid.reserve(std::size_t{shared::kSpacingColumns} * shared::kSpacingRows);
    for (shared::uint j = 0; j < shared::kSpacingRows; ++j) {
        for (shared::uint i = 0; i < shared::kSpacingColumns; ++i) {
            const SampleSpacing spacing =
                method.spacing_at({(i + 0.5) / shared::kSpacingColumns * screen.width,
                                   (j + 0.5) / shared::kSpacingRows * screen.height});
            grid.emplace_back(static_cast<float>(std::max(spacing.radial_px, 1.0)),
                              static_cast<float>(std::max(spacing.tangential_px, 1.0)));
        }
    }
    return grid;
}

}  // namespace parafovea
