// The parts of the columned hall, each standing at its own origin.
#pragma once

#include "renderer/scene_shapes.h"

namespace parafovea {

// A fluted column on a moulded base, with a leaf capital and a square slab on top; y from 0 to `height`.
Triangles make_column(float height, float radius, int flutes);

// One bay of an arcade, in the plane z = 0 and `thickness` deep, centred on x = 0: the wall around a round
// arch that springs at y = 0 and is pierced up to `rise`. Faces and soffit.
struct ArchBay {
    Triangles wall;
    Triangles trim;  // the arch's ring and soffit
};
ArchBay make_arch_bay(float width, float radius, float rise, float thickness);

// A cloth hung from a rod at y = 0 down to -`drop`, `width` wide along x, in folds. Two-sided by its
// material.
Triangles make_hanging(float width, float drop, float phase);

Triangles make_vase(int shape);
Triangles make_baluster();
Triangles make_pedestal();

// A lamp of hammered bronze on a chain of links, hanging from y = 0.
Triangles make_hanging_lamp(float chain_m);

}  // namespace parafovea
