// A street of cafés and shops at night, in the wet, built and painted by rule.
#pragma once

#include "renderer/scene.h"

namespace parafovea {

// At least 1,000,000 triangles, dozens of lamps, glass; the same to the last bit on every call.
Scene make_street_scene();

}  // namespace parafovea
