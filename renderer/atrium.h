// A columned hall open to the sky, built and painted by rule: two storeys of arcades, brick, marble, cloth,
// vases.
#pragma once

#include "renderer/scene.h"

namespace parafovea {

// At least 250,000 triangles, normal-mapped; the same to the last bit on every call.
Scene make_atrium_scene();

}  // namespace parafovea
