// SPDX-License-Identifier: Apache-2.0
// Device addresses as typed arrays, and the root record of every kernel.
#ifndef RESTAGE_LIB_SCENE
#define RESTAGE_LIB_SCENE
#include "shared/scene_data.h"

#define ARRAY_OF(NAME, TYPE)                                                                                           \
    layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer NAME { TYPE at[]; }

ARRAY_OF(FloatArray, float);
ARRAY_OF(UintArray, uint);
ARRAY_OF(Vec2Array, vec2);
ARRAY_OF(Vec3Array, vec3);
ARRAY_OF(Vec4Array, vec4);
ARRAY_OF(Uvec2Array, uvec2);
ARRAY_OF(Uvec3Array, uvec3);
ARRAY_OF(MaterialArray, MaterialData);
ARRAY_OF(TextureArray, TextureProgram);
ARRAY_OF(CdfArray, CdfEntry);
ARRAY_OF(LightNodeArray, LightNode);
ARRAY_OF(LightArray, LightData);
ARRAY_OF(MediumArray, MediumData);
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer InstanceArray { InstanceData at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ImageArray { ImageData at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer SceneRef { SceneData scene; };

// Features the scene does not use are free: fixed at pipeline creation.
layout(constant_id = 0) const bool HAS_ENVIRONMENT = true;
layout(constant_id = 1) const bool HAS_TEXTURES = true;
layout(constant_id = 2) const bool HAS_BUMP = true;    // bump or normal maps
layout(constant_id = 3) const bool HAS_LENS = true;
layout(constant_id = 4) const bool HAS_MEDIA = true;
layout(constant_id = 5) const bool HAS_GUIDES = true;
layout(constant_id = 6) const int STRATEGY = 0;        // 0 MIS, 1 light sampling only, 2 BSDF sampling only
layout(constant_id = 7) const bool HAS_TANGENTS = true; // anisotropic materials or bump: dp/du is needed
layout(constant_id = 8) const bool HAS_FILTER_TABLE = true;
layout(constant_id = 10) const bool HAS_BORDERS = false; // media end at surfaces that rays pass; the tracer absorbs
layout(constant_id = 11) const bool HAS_EMISSION_TEXTURES = false;
layout(constant_id = 12) const bool HAS_LIGHT_ALPHA = false; // some lamp has alpha below 1
layout(constant_id = 13) const bool HAS_GLOW = false;        // some lamp has no surface: INSTANCE_PASSES
layout(constant_id = 15) const bool HAS_QUADRICS = false;
layout(constant_id = 16) const uint LIGHT_KINDS = 31u;   // LIGHTS_*
layout(constant_id = 17) const uint LIGHT_ROOTS = 9u;    // children of the light tree's root: 0, 1, 2, 4, 8; 9 = a deeper tree
const bool HAS_LAMP_SURFACES = (LIGHT_KINDS & LIGHTS_SURFACES) != 0u;
const bool HAS_LAMPS = (LIGHT_KINDS & LIGHTS_LAMPS) != 0u;
const bool HAS_LAMP_MESHES = (LIGHT_KINDS & LIGHTS_MESHES) != 0u;
const bool HAS_LAMP_RECTANGLES = (LIGHT_KINDS & LIGHTS_RECTANGLES) != 0u;
const bool HAS_LAMP_TRIANGLES = (LIGHT_KINDS & LIGHTS_TRIANGLES) != 0u;
layout(constant_id = 18) const bool HAS_CURVES = false; // spectral mode: measured spectra, of the material or of lights
layout(constant_id = 19) const bool HAS_CAUSTICS = false; // photon maps: path/photons.glsl
layout(constant_id = 20) const bool HAS_GUIDING = false; // directions are chosen by path guiding, too
layout(constant_id = 21) const bool HAS_CATCHERS = false; // shadow catchers: path/catcher.glsl
layout(constant_id = 14) const uint CAMERA_KIND = 0u;        // CAMERA_*

// The second set of uv if the mesh has one, else the first.
vec2 second_uv(InstanceData inst, uvec3 tri, vec2 bary, vec2 first) {
    if (inst.uvs2 == uint64_t(0)) return first;
    Vec2Array uvs = Vec2Array(inst.uvs2);
    return (1.0 - bary.x - bary.y) * uvs.at[tri.x] + bary.x * uvs.at[tri.y] + bary.y * uvs.at[tri.z];
}

// The uv of textures at a hit: the mesh's, or barycentrics if it has none; both sets.
vec4 hit_uv(InstanceData inst, uint prim, vec2 bary) {
    vec2 uv = bary;
    if ((inst.flags & INSTANCE_HAS_UVS) == 0u && inst.uvs2 == uint64_t(0)) return uv.xyxy; // quadrics have no indices
    uvec3 tri = Uvec3Array(inst.indices).at[prim];
    if ((inst.flags & INSTANCE_HAS_UVS) != 0u) {
        Vec2Array uvs = Vec2Array(inst.uvs);
        uv = (1.0 - bary.x - bary.y) * uvs.at[tri.x] + bary.x * uvs.at[tri.y] + bary.y * uvs.at[tri.z];
    }
    return vec4(uv, second_uv(inst, tri, bary, uv));
}

#endif
