// SPDX-License-Identifier: Apache-2.0
// The scene for shaders: flat records behind device addresses. World space is translated by GpuScene::origin so
// that floats are precise near the camera (pbrt 4ed, 5.1.1, "camera-world" rendering space).
#ifndef RESTAGE_SHARED_SCENE_DATA_H
#define RESTAGE_SHARED_SCENE_DATA_H
#include "shared/address.h"
#include "shared/types.h"

RESTAGE_CONSTANTS_BEGIN
RESTAGE_UINT(NONE, 0xffffffffu);
// InstanceData::flags
RESTAGE_UINT(INSTANCE_FLIP_NORMAL, 1u); // reverse_orientation
RESTAGE_UINT(INSTANCE_EMITS, 2u);
RESTAGE_UINT(INSTANCE_TWO_SIDED, 4u);
RESTAGE_UINT(INSTANCE_HAS_NORMALS, 8u);
RESTAGE_UINT(INSTANCE_HAS_UVS, 16u);
RESTAGE_UINT(INSTANCE_HAS_ALPHA, 32u);
RESTAGE_UINT(INSTANCE_HAS_MEDIA, 64u);
RESTAGE_UINT(INSTANCE_HAS_GAPS, 128u); // its material is a mix with a null component: rays pass there
RESTAGE_UINT(INSTANCE_ALPHA_MASK, 256u); // alpha above 0 stops every ray
RESTAGE_UINT(INSTANCE_EMITS_UNSEEN, 512u); // emits even where alpha lets rays pass
RESTAGE_UINT(INSTANCE_PASSES, 1024u); // no surface, but it emits: rays see its light and continue
RESTAGE_UINT(INSTANCE_QUADRIC, 2048u); // `positions` is the address of a QuadricData; prim is 0, bary is pbrt's (u, v)
RESTAGE_UINT(INSTANCE_CATCHES, 4096u); // a shadow catcher: camera rays end there, all others pass (PASSES is set, too)
RESTAGE_UINT(MATERIAL_NOTHING, 0xfffffffeu); // instead of a MaterialData index: no surface, rays pass
RESTAGE_UINT(MATERIAL_MIX, 1u);
// The first word of an operation of a texture's program
RESTAGE_UINT(TEXTURE_KIND, 255u); // mask: the type's index in this scene + 1
RESTAGE_UINT(TEXTURE_LITERAL, 0u); // the kind of a constant: three words follow
RESTAGE_UINT(TEXTURE_OP_DATA, 256u); // its value is used as a number
RESTAGE_UINT(TEXTURE_OP_SECOND_UV, 512u);
RESTAGE_UINT(TEXTURE_OP_FIRST_OPERAND, 65536u); // this bit and the bits above: a texturable parameter is on the stack
RESTAGE_UINT(WRAP_REPEAT, 0u);
RESTAGE_UINT(WRAP_BLACK, 1u);
RESTAGE_UINT(WRAP_CLAMP, 2u);
RESTAGE_UINT(TEXEL_HALF4, 0u);
RESTAGE_UINT(TEXEL_FLOAT4, 1u);
RESTAGE_UINT(LIGHT_TRIANGLE, 0u); // a = p0, b = p1-p0, c = p2-p0
RESTAGE_UINT(LIGHT_ENVIRONMENT, 1u);
RESTAGE_UINT(LIGHT_QUADRIC, 2u); // of `instance`; area is in object space
RESTAGE_UINT(LIGHT_LAMP, 16u); // and on, plus LAMP_*: a = position, b = axis, c = cone (shared/lamps.h)
RESTAGE_UINT(LIGHT_TWO_SIDED, 256u);
RESTAGE_UINT(LIGHT_PAIR, 1024u); // with the next one a parallelogram: b and c of that one are -b and -c of this one
RESTAGE_UINT(LIGHT_PAIR_END, 2048u); // with the one before
RESTAGE_UINT(LIGHT_SWAPPED, 512u); // b = p2-p0, c = p1-p0, so that their cross product is the emitting side
RESTAGE_UINT(LIGHT_RECTANGLE, 4096u); // of a pair: its edges are at right angles
RESTAGE_UINT(LIGHT_BY_ANGLE, 16384u); // a triangle that is sampled by solid angle
RESTAGE_UINT(LIGHT_PIECES, 8192u); // of a LightNode: an emitter of more than a triangle or a pair
// Kinds of lights in a scene
RESTAGE_UINT(LIGHTS_SURFACES, 1u); // triangles, quadrics
RESTAGE_UINT(LIGHTS_LAMPS, 2u); // LIGHT_LAMP and on
RESTAGE_UINT(LIGHTS_MESHES, 4u); // emitters of LIGHT_PIECES
RESTAGE_UINT(LIGHTS_RECTANGLES, 8u); // LIGHT_RECTANGLE
RESTAGE_UINT(LIGHTS_TRIANGLES, 16u); // LIGHT_BY_ANGLE
RESTAGE_UINT(CDF_TOTAL, 0xffffffffu);
RESTAGE_UINT(ENV_CONSTANT, 0u);
RESTAGE_UINT(ENV_EQUIRECT, 1u);
RESTAGE_UINT(ENV_OCTAHEDRAL, 2u);
RESTAGE_UINT(QUADRIC_SPHERE, 0u);
RESTAGE_UINT(QUADRIC_DISK, 1u);
RESTAGE_UINT(QUADRIC_CYLINDER, 2u);
RESTAGE_UINT(CAMERA_PERSPECTIVE, 0u);
RESTAGE_UINT(CAMERA_ORTHOGRAPHIC, 1u);
RESTAGE_UINT(CAMERA_SPHERICAL, 2u); // equirectangular, +y up
RESTAGE_UINT(CAMERA_EQUAL_AREA, 3u); // the sphere by the octahedral map
RESTAGE_UINT(FILTER_BOX, 0u);
RESTAGE_UINT(FILTER_TRIANGLE, 1u);
RESTAGE_UINT(FILTER_TABLE, 2u);
RESTAGE_CONSTANTS_END

RESTAGE_SHARED_BEGIN

struct InstanceData { // 184 bytes
    mat4x3 object_to_world;
    mat3 normal_to_world; // inverse transpose of the linear part, no sign changes
    vec3 emission; // radiance, stored (shared/spectral.h); with emission_texture RGB, to be multiplied
    address positions; // vec3[]
    address normals; // vec3[] or 0
    address uvs; // vec2[] or 0
    address indices; // uvec3[]
    uint material;
    uint light_base; // index of the light of triangle 0, or NONE
    uint flags;
    uint alpha_texture; // 0 = `alpha`
    float alpha;
    uint interior, exterior; // media, 0 = vacuum
    uint object_id; // Id<Instance>
    uint emission_texture; // 0 = none
    uint pad0;
    address tangents; // vec4[] or 0; w: sign of the bitangent
    address uvs2; // vec2[] or 0: the second set
};

struct QuadricData { // 40 bytes; scene/quadric.hpp
    uint kind;
    uint whole; // 1: a sphere without zmin, zmax, phimax
    float radius;
    float z_min, z_max; // equal for a disk: its height
    float inner;
    float phi_max; // [rad]
    float theta_min, theta_max; // of a sphere, at z_min and z_max
    float area; // in object space
};

struct MaterialData { // 32 bytes
    uint type; // index of the material type in this scene
    uint params; // first word in SceneData.params; before it, three for its stand-in colour
    uint bump; // texture or 0
    uint normal_map; // texture or 0
    uint id; // Id<Material>
    uint mix_first,
        mix_second; // MaterialData indices or MATERIAL_NOTHING if the type is a mix; its first parameter is `amount`
    uint flags;
};

// A texture is a short postfix program, in words; render/texture_types.hpp.
struct TextureProgram { // index = texture; 0 = none
    uint first, count; // word; operations
};

struct ImageData { // 24 bytes
    address texels; // uvec2[] (4 halves) or vec4[], row 0 on top
    uint width, height;
    uint format;
    uint pad0;
};

struct LightData { // 72 bytes
    vec3 a;
    uint kind; // LIGHT_* | LIGHT_TWO_SIDED | LIGHT_SWAPPED | condition << 16 (of a triangle's place, in sixteenths; see
               // light_offset)
    vec3 b;
    float pmf; // of being chosen from its emitter
    vec3 c;
    float area; // of both triangles of a pair
    vec3 value; // radiance, intensity or irradiance; stored
    float offset; // of a triangle: the part of light_offset that does not depend on the ray
    uint instance; // of a quadric, or of a triangle with an emission texture or alpha; else NONE
    uint node; // LightNode of its emitter
};

struct CdfEntry { // render/cdf_table.hpp
    uint start; // of the numbers, below CDF_TOTAL, that draw this index
    uint guide; // entry k: the index that k / count of all numbers draws
};

// A node of the tree of emitters; render/light_tree.hpp. A mesh that shines is one emitter, however many triangles.
struct LightNode { // 60 bytes
    vec3 center; // of a sphere around it
    float radius; // < 0: infinitely far
    vec3 axis; // unit; the normals of its emitting sides are within an angle of `cos_spread` around it
    float cos_spread;
    float cos_reach; // it sends light up to this angle away from its normals; < 0: everywhere
    float intensity; // luminance * area, or intensity; infinitely far: irradiance
    uint first, count; // its children; of an emitter (count = 0) its first light
    uint lights; // of an emitter; 0 = inner node
    uint parent; // NONE at the root
    uint flags; // LIGHT_TWO_SIDED | LIGHT_PIECES
};

struct EnvironmentData {
    mat3 env_from_world;
    mat3 world_from_env;
    vec3 scale; // of a constant environment its radiance, stored
    uint mapping;
    address texels; // vec4[]: rgb, and the density with which light sampling chooses a point of the image
    address rows; // CdfEntry[height + 1]: cells between the rows' middles; render/environment_map.hpp
    address columns; // CdfEntry[width + 1] for each row of cells
    uint width, height;
    uint light; // its index in the lights, or NONE
    uint hidden; // 1: black for camera rays
};

struct CameraData {
    mat4x3 camera_to_world;
    // Of the whole film, min is the top left corner: at z = 1; orthographic: where rays start
    vec2 screen_min, screen_max;
    float lens_radius, focal_distance;
    uint width, height; // of the whole film
};

struct FilterData {
    vec2 radius;
    uint kind;
    uint table_size; // entries per axis
    address table; // float cdf_x[n+1], cdf_y[n+1], sign_x[n], sign_y[n] of |f|
    vec2 weight; // integral of |f| / integral of f, per axis
};

struct MediumData {
    vec3 sigma_a; // stored
};

struct SceneData {
    address instances, materials, params, textures, texture_words, images, lights, light_nodes, light_cdf, media;
    EnvironmentData environment;
    CameraData camera;
    FilterData filter_;
    // Of spectral mode, else 0; shared/spectral.h
    address spectral_coefficients; // uvec2[3][SPECTRAL_CELLS]^3: packed, of the RGB cube
    address spectral_curves; // vec2[][SPECTRAL_CURVE]: measured spectra
    address spectral_film; // vec4[SPECTRAL_BINS]: RGB of light at the wavelengths of a bin
    address guiding; // GuidingData; the tracer's (FrameData), 0 in the stored scene
    uint max_depth;
    uint russian_roulette;
    uint camera_medium;
    float clamp_direct, clamp_indirect; // 0 = off
    float ray_epsilon; // 0 = error bounds
    float world_copies; // 1: rays meet copies of the triangles in world space; the tracer's (WavePush), 0 in the stored
                        // scene
    vec3 world_origin; // of the kernels' world space, in scene space
};

RESTAGE_SHARED_END
#endif
