// The painted materials of the columned hall.
#pragma once

#include "renderer/scene_patterns.h"

namespace parafovea {

struct AtriumMaterials {
    PaintedMaterial paving;
    PaintedMaterial brick;
    PaintedMaterial stone;   // columns, arches, cornices
    PaintedMaterial frieze;  // carved band
    PaintedMaterial wood;
    PaintedMaterial glazed;  // vases
    PaintedMaterial bronze;
    PaintedMaterial cloth[3];
};

AtriumMaterials add_atrium_materials(Scene& scene);

// Paints that other scenes use too.
Paint paint_brick(float u, float v);
Paint paint_stone(float u, float v);
Paint paint_wood(float u, float v);

}  // namespace parafovea
