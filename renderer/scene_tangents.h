// Meshes in the making: normals and tangents where there are none, and the way into a scene.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/scene.h"

namespace parafovea {

// Triangles of a mesh being built; indices count from 0.
struct Triangles {
    std::vector<SceneVertex> vertices;
    std::vector<std::uint32_t> indices;
};

// Gives every triangle its own vertices and its plane's normal (glTF 2.0, 3.7.2.1: "flat normals").
void make_flat_normals(Triangles& mesh);

// Tangents along the texture's u direction: each corner's share weighted by its angle and projected on the
// plane of the normal, as MikkTSpace does (Mikkelsen 2008). A vertex between mirrored halves of a texture is
// doubled.
void make_tangents(Triangles& mesh);

// Adds the triangles to a scene as a mesh of its own; returns its number. They must not be empty.
int append_mesh(Scene& scene, const Triangles& mesh, int material);

}  // namespace parafovea
