// The parts of the street, each standing at its own origin; fronts look along +z.
#pragma once

#include "renderer/scene_shapes.h"

namespace parafovea {

// Domed stones in staggered rows, `width` along x and `length` along z, each its own surface.
Triangles make_cobbles(float width, float length, std::uint32_t seed);

Triangles make_window_frame(float width, float height);
Triangles make_shutter(float width, float height);      // louvred; hinge at x = 0
Triangles make_balcony_rail(float width, float depth);  // wrought iron
Triangles make_lamp_post(float height);                 // iron; its lantern's middle is at `height`
Triangles make_lantern_panes(float height);
Triangles make_cafe_chair();
Triangles make_cafe_table();
Triangles make_bottle();
Triangles make_wine_glass();
Triangles make_awning(float width, float depth, float drop);
Triangles make_leaves(int count, glm::vec3 reach, float size_m,
                      std::uint32_t seed);  // in an ellipsoid around the origin
Triangles make_trunk(float height, std::uint32_t seed);
Triangles make_tube(const std::function<glm::vec3(float)>& path, float radius, int along, int around);
Triangles make_ball(float radius, int around, int along);

}  // namespace parafovea
