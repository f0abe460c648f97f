// Where shaders find the scene: bindings of descriptor set 0, specialization constants, and the lighting
// block.
#ifndef PARAFOVEA_SCENE_LAYOUT_H
#define PARAFOVEA_SCENE_LAYOUT_H

#include "bridge.h"

SHARED_BEGIN

// Bindings of set 0, the scene as shade_sample() reads it. Ray-marched scenes have the first two only.
const uint kBindCamera = 0u;    // uniform, Camera
const uint kBindLighting = 1u;  // uniform, Lighting
const uint kBindGBuffer = 2u;   // usampler2D, see surface_packing.glsl
const uint kBindDepth = 3u;     // sampler2D, reversed depth
const uint kBindShadow = 4u;    // sampler2DShadow, the sun's map
const uint kBindBlended = 5u;   // usampler2D, the nearest blended surface
const uint kBindBlendedDepth = 6u;
const uint kBindIrradiance = 7u;  // sampler2DArray, the irradiance volume: layer = colour * depth + z
const uint kBindLightGrid = 8u;   // usampler2D, which lights reach a cell seen from above, a bit each
const uint kBindLampShadow = 9u;  // sampler2DArrayShadow, a layer for each lamp that casts shadows
const uint kBindSurfaces = 10u;   // buffer, SurfaceMaterial[]: textures are read for each sample
const uint kBindColors = 11u;     // sampler2DArray, their textures of colour
const uint kBindData = 12u;       // sampler2DArray, and those of numbers

// Specialization constants of the shading shaders. Ids below 64 are free for the methods. What a scene does
// not have is never asked of a uniform: lavapipe works branches on uniforms into the shader anew at every
// draw, which takes milliseconds.
const uint kConstSunShadow = 64u;   // 1: the sun casts shadows
const uint kConstBlend = 65u;       // 1: there are blended surfaces
const uint kConstEmission = 66u;    // 1: the G-buffer's third and fourth words are there
const uint kConstLights = 67u;      // number of punctual lights
const uint kConstIrradiance = 68u;  // 1: ambient light varies over the scene
const uint kConstFootprint = 69u;   // 1: filter over spacing_px, 0: over one pixel
const uint kConstSamples = 70u;     // ray-marched: samples of one shade_sample()
const uint kConstLampShadow = 71u;  // 1: some lamps cast shadows
const uint kConstLate = 72u;        // 1: textures are read for each sample
const uint kConstLateUses = 73u;    // which textures any material has: bit n - 1 for kBind* n of set 1
const uint kConstSun = 74u;         // 1: there is a sun

// Material of a G-buffer or depth pipeline: set 1.
const uint kBindMaterial = 0u;  // uniform, MaterialBlock
const uint kBindBaseColor = 1u;
const uint kBindMetallicRoughness = 2u;
const uint kBindNormal = 3u;
const uint kBindOcclusion = 4u;
const uint kBindEmissive = 5u;
const uint kMaterialTextures = 5u;

// Specialization constants of the geometry shaders: what a material uses.
const uint kConstBaseColorTexture = 0u;
const uint kConstMetallicRoughnessTexture = 1u;
const uint kConstNormalTexture = 2u;
const uint kConstOcclusionTexture = 3u;
const uint kConstEmissiveTexture = 4u;
const uint kConstMask = 5u;
const uint kConstTextureTransforms = 6u;
const uint kConstVertexColors = 7u;
const uint kConstBlendedLayer = 8u;
const uint kGeometryConstants = 9u;

// The length with which a left-handed tangent leaves the G-buffer's vertex shader; a right-handed one has 1.
const float kLeftHandedLength = 64.0f;

// What the G-buffer's vertex shader needs of an instance: attributes from kInstanceLocation on, one vec4 or
// column at each.
const uint kInstanceLocation = 5u;

struct InstanceRecord {
    mat4 clip_from_mesh;
    vec4 normal_x;  // columns of the matrix that takes normals to the world; w of the first: -1 when it
                    // mirrors
    vec4 normal_y;
    vec4 normal_z;
};

// Uniform block; std140.
struct MaterialBlock {
    vec4 base_color;
    vec4 emissive;        // w: normal scale
    vec4 factors;         // metallic, roughness, occlusion strength, alpha cutoff
    vec4 glass;           // transmission, index of refraction, number of the material
    vec4 transforms[10];  // two rows for each texture: looked up at (row.xy . uv + row.z)
};

// A material whose textures are read for each sample; std430.
struct SurfaceMaterial {
    vec4 base_color;    // w: log2 of the arrays' size
    vec4 emissive;      // w: normal scale, 0 without a normal map
    vec4 factors;       // metallic, roughness, occlusion strength (0 without a map)
    vec4 layers;        // base colour, metal and roughness, normal, emission
    vec4 least_levels;  // of each: below it lies no more detail
    vec4 occlusion;     // layer, least level
};

const uint kMaxLights = 64u;
const uint kMaxLampShadows = 16u;

// A point or spot light.
struct LightRecord {
    vec4 position;   // w: 1 / range^2, 0 when unlimited
    vec4 intensity;  // w: 1 for a spot
    vec4 direction;  // w: cosine offset of the cone, with spot falloff = (cos * scale + offset)^2
    vec4 cone;       // x: scale; y: layer of its shadow map, -1 for none
};

// Uniform block; std140.
struct Lighting {
    mat4 shadow_from_world;  // the sun's map: xy texture position, z depth
    vec4 sun_direction;      // towards the sun; w: exposure
    vec4 sun_irradiance;     // w: shadow map texel, metres
    vec4 sky_zenith;
    vec4 sky_horizon;
    vec4 sky_ground;
    vec4 ambient[9];     // irradiance / pi over the normal, spherical harmonics of degree 2
    vec4 volume_origin;  // the irradiance volume's lower corner; w: how far off a surface to look, metres
    vec4 volume_scale;   // 1 / extent; w: layers of one colour
    vec4 light_grid;     // lower corner x, z; cells per metre along x, z
    LightRecord lights[64];
    mat4 lamp_from_world[16];  // of each layer of the lamps' shadow maps: clip space
};

SHARED_END

#endif
