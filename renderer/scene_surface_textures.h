// All textures of a scene's opaque materials in two arrays and their factors in one buffer, so that shading
// can read them for each sample instead of the G-buffer for each pixel.
#pragma once

#include "renderer/gpu_pipeline.h"
#include "renderer/scene.h"

namespace parafovea {

struct SurfaceTextures {
    GpuImage color;          // 2D array, sRGB: base colour and emission; layer 0 is white
    GpuImage data;           // 2D array, linear: metal and roughness, normals, occlusion; layer 0 is white
    GpuBuffer materials;     // shared::SurfaceMaterial for each material
    std::uint32_t uses = 0;  // bits kUses* of scene_layout.h: what any material has
};

// Whether shading can do it: every texture repeats, is filtered, is moved by no transform, and is as large as
// the largest halved some times; vertices are white; at most 256 materials; the arrays stay below 256 MiB. A
// scene without textures has nothing to gain.
bool can_read_textures_late(const Scene& scene);

// Throws std::runtime_error if memory runs out. The scene must allow it.
SurfaceTextures make_surface_textures(Gpu& gpu, const Scene& scene);

}  // namespace parafovea
