// Light and camera for glTF files that come without.
#pragma once

#include "renderer/scene.h"

namespace parafovea {

// In a scene with lamps and the size of a house a place inside with a wide view, else a view of the whole
// from a little above.
SceneCamera default_camera(const Scene& scene);

// Adds what a file leaves open. Without any light: a sun and a sky; if the first camera stands inside the
// scene, the sun stands where it lights most of what that camera sees, as through windows. With lamps only: a
// dim sky. The exposure follows the light.
void light_by_default(Scene& scene, bool has_sun);

}  // namespace parafovea
