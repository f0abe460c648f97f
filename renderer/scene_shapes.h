// Parametric shapes for built-in scenes, added to triangles in the making. All face outwards,
// counter-clockwise.
#pragma once

#include <functional>
#include <span>

#include "renderer/scene_tangents.h"

namespace parafovea {

// A point of a surface and its texture coordinates, for u and v in [0, 1]. Normals follow from neighbouring
// points: cross(d/du, d/dv) is outside.
struct SurfacePoint {
    glm::vec3 position{0};
    glm::vec2 uv{0};
};
using Surface = std::function<SurfacePoint(float u, float v)>;

// columns x rows quadrilaterals over the unit square; 2 columns rows triangles.
void add_surface(Triangles& mesh, int columns, int rows, const Surface& surface);

// A flat quadrilateral from `corner` along two edges; texture metres along them, v up. 2 triangles a cell.
void add_panel(Triangles& mesh, glm::vec3 corner, glm::vec3 edge_u, glm::vec3 edge_v, int cells_u = 1,
               int cells_v = 1);

// An axis-aligned box, textured in metres; 12 triangles.
void add_box(Triangles& mesh, glm::vec3 low, glm::vec3 high);

// A profile of (radius, height) points turned around the y axis, from bottom to top. `smooth`: normals run
// through the profile's corners.
void add_lathe(Triangles& mesh, std::span<const glm::vec2> profile, int segments, bool smooth);

// A profile of (out, up) points swept from z = 0 to `length` along z, `out` along +x; from bottom to top.
// Flat between its corners.
void add_moulding(Triangles& mesh, std::span<const glm::vec2> profile, float length, int cells);

// The same triangles elsewhere. The matrix must not mirror.
void add_transformed(Triangles& mesh, const Triangles& part, const glm::mat4& matrix);

}  // namespace parafovea
