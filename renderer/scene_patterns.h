// Procedural textures: periodic noise, and materials painted from a function of position. Deterministic.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "renderer/scene_tangents.h"

namespace parafovea {

// A repeatable number in [0, 1) for each lattice point.
float lattice_noise(int x, int y, std::uint32_t seed);

// Smooth noise in [0, 1) on a lattice of `period` cells that wraps around.
float value_noise(float x, float y, int period, std::uint32_t seed);

// Octaves of value_noise, each twice as fine and half as strong; in [0, 1).
float fractal_noise(float x, float y, int period, int octaves, std::uint32_t seed);

// Noise whose cells have a centre each: the distance to the nearest and to the second nearest centre.
struct CellDistance {
    float nearest = 0;
    float second = 0;
    int cell_x = 0;
    int cell_y = 0;
};
CellDistance cellular_noise(float x, float y, int period, std::uint32_t seed);

// What a painted surface is like at a point of its texture.
struct Paint {
    glm::vec3 color{0.5f};  // linear
    float height_m = 0;
    float roughness = 0.7f;
    float metallic = 0;
};

struct PaintedMaterial {
    int material = 0;
    float repeats_per_m = 1;  // multiplies texture coordinates in metres
};

// Paints size x size texels, u right and v down in [0, 1), of a pattern that repeats every `extent_m`, and
// adds base colour, normal and metallic-roughness textures and a material that uses them.
PaintedMaterial add_painted_material(Scene& scene, const std::string& name, int size, float extent_m,
                                     const std::function<Paint(float u, float v)>& paint);

// Adds a mesh whose texture coordinates are metres.
int append_painted(Scene& scene, Triangles mesh, const PaintedMaterial& paint);

std::uint8_t srgb_byte(float linear);

}  // namespace parafovea
