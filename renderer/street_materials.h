// The painted materials of the street at night.
#pragma once

#include "renderer/scene_patterns.h"

namespace parafovea {

struct StreetMaterials {
    PaintedMaterial cobble;  // wet
    PaintedMaterial slabs;   // wet pavement
    PaintedMaterial brick;
    PaintedMaterial stone;
    PaintedMaterial plaster[3];
    PaintedMaterial wood;
    PaintedMaterial iron;
    PaintedMaterial leaf;
    PaintedMaterial awning[2];
    PaintedMaterial lit_window[2];  // shines
    PaintedMaterial dark_window;
    PaintedMaterial goods;   // what stands on the shops' shelves
    PaintedMaterial bulb;    // shines
    PaintedMaterial glass;   // blended
    PaintedMaterial bottle;  // transmits
};

StreetMaterials add_street_materials(Scene& scene);

}  // namespace parafovea
