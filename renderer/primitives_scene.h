// The ray-marched court with sixteen solids; its shapes stand in shaders/primitives_field.glsl.
#pragma once

#include "renderer/scene.h"

namespace parafovea {

Scene make_primitives_scene();

}  // namespace parafovea
