// SPDX-License-Identifier: Apache-2.0
// Path state, rays and film, shared by kernels and the CPU pass. RayHit has the layout of Embree's RTCRayHit and
// ShadowRay starts with RTCRay, so Embree works on the kernels' memory in place.
#ifndef RESTAGE_SHARED_PATH_DATA_H
#define RESTAGE_SHARED_PATH_DATA_H
#include "shared/address.h"
#include "shared/types.h"
#ifdef __cplusplus
#define RESTAGE_CARRIED vec3
#else
#include <restage/v1/spectrum.glsl>
#define RESTAGE_CARRIED Spectrum
#endif

RESTAGE_CONSTANTS_BEGIN
RESTAGE_UINT(PATH_SPECULAR, 0x10000u); // the last bounce was a delta lobe (or the camera)
RESTAGE_UINT(PATH_GUIDED, 0x20000u); // the denoiser's guide is still ahead: only delta bounces so far
RESTAGE_UINT(PATH_HERO, 0x40000u); // only the hero wavelength is left: it went through something dispersive
RESTAGE_UINT(PATH_CAUSTIC, 0x80000u); // since a scattering vertex, it met only casters: photons carry what it finds so
RESTAGE_UINT(PATH_PHOTON, 0x100000u); // it started at a light; `radiance` is its power at the start
RESTAGE_UINT(PATH_CAUGHT, 0x200000u); // its camera ray met a shadow catcher: path/catcher.glsl
RESTAGE_UINT(PATH_DEPTH_MASK, 0xffffu);
RESTAGE_UINT(COUNTER_MAX_TYPES, 64u);
RESTAGE_UINT(COUNTER_RAYS, 64u);
RESTAGE_UINT(COUNTER_SHADOW_RAYS, 65u);
RESTAGE_UINT(COUNTER_FILM, 66u); // samples rejected by the film
RESTAGE_UINT(COUNTER_COUNT, 67u);
RESTAGE_CONSTANTS_END

RESTAGE_SHARED_BEGIN

struct RayHit { // 80 bytes
    vec3 origin;
    float tnear;
    vec3 direction;
    float time;
    float tfar; // in: infinity, or negative for a dead path; out: hit distance
    uint mask;
    uint receiver; // receiver_bits at its origin (lib/light_tree.glsl); Embree's id
    uint flags;
    vec3 ng; // Embree's. Kernels: (sum of the light that a path meets, the density of light sampling there, 0)
    float u, v;
    uint prim;
    uint geom; // out: NONE = missed; else the CPU pass writes the resolved material here
    uint inst; // out: InstanceData index
};

struct ShadowRay { // 64 bytes
    vec3 origin;
    float tnear;
    vec3 direction;
    float time;
    float tfar; // <= 0: no shadow ray. After Embree: -inf = occluded
    uint mask;
    uint id;
    uint flags;
    vec3 contribution; // added to the path's radiance if the light is visible
    uint medium; // at its origin; only where HAS_BORDERS
};

// 48 bytes. A Spectrum of four has its last number in a FourthData, so that records are those of RGB.
struct PathState {
    RESTAGE_CARRIED throughput;
    float pdf; // of the last BSDF sample, solid angle
    RESTAGE_CARRIED radiance;
    uint flags; // depth | PATH_*
    float
        eta_scale; // of throughput in Russian roulette: product of eta^2 on transmissions, and what path guiding takes
    uint medium;
    uint seed; // of the pixel's random numbers
    uint sample_index;
};

struct FourthData { // 16 bytes, of a path in spectral mode
    float throughput, radiance;
    float contribution; // of its ShadowRay
    float hero; // [0, 1): the number that chose its wavelengths; shared/spectral.h
};

struct GuideSample { // 68 bytes, of the first hit; albedo and normal: of the first that is not a mirror or smooth glass
    vec3 albedo;
    vec3 normal; // world space, shading
    float depth; // distance along the ray; 0 = nothing hit
    uint instance_id, material_id;
    float weight; // of the filter
    float coverage; // 1 = it hit something
    vec3 without, backdrop; // where HAS_CATCHERS, at a catcher: its light without objects, and what is behind it
};

struct FilmPixel { // 60 bytes; what the sums have in excess is subtracted when they are read
    vec3 sum; // of radiance
    float count;
    vec3 sum_sq; // of each channel
    float sum_sq_luminance;
    vec3 excess, excess_sq;
    float excess_sq_luminance;
};
struct GuidePixel {
    vec3 albedo;
    float count;
    vec3 normal;
    float depth;
    uint instance_id, material_id; // of the first sample
    float coverage;
    float caught; // samples that met a catcher first; sums of these follow
    vec3 shade, without, backdrop; // shade: light with objects less that without
};

struct SamplePick { // a sample to take
    uint pixel; // of the film, row by row, and of its twins
    uint sample_index;
};
struct SampleRun { // samples of one pixel: paths [first, first + count) of a wave
    uint pixel, first, count;
};

// Counted by kernels: non-finite samples, by material type; and rays, if the device traces them.

struct FrameData { // behind the push constant
    address scene; // SceneData
    address rays; // RayHit[]
    address shadows; // ShadowRay[]
    address paths; // PathState[]
    address fourths; // FourthData[], or 0 in RGB mode
    address guides; // GuideSample[] or 0
    address queue; // uint[]: path indices, grouped by type
    address film; // FilmPixel[]
    address film_guides; // GuidePixel[]
    address counters; // uint[COUNTER_COUNT]
    address photons; // PhotonMap, where HAS_CAUSTICS
    address picks; // SamplePick[], of each path; 0: the ray-tracing pipeline takes a rectangle
    address runs; // SampleRun[run_count], in a wave
    address guiding; // GuidingData, where paths are guided (HAS_GUIDING)
    uint run_count;
    uint samples, first_sample; // of each pixel of a rectangle; samples: or the number of picks of the pipeline
    uint pad1;
    uint crop_x, crop_y, crop_width, crop_height; // the film has rows of twins below these (shared/twins.h)
    uint seed, pad0;
};

struct TracePush { // of the ray-tracing pipeline: one sample per pixel of a rectangle of the film
    address frame;
    address tlas;
    uint x, y; // the rectangle's first pixel, in the crop window
    uint sample_index; // after FrameData.first_sample
    uint pad0;
};

RESTAGE_SHARED_END
#endif
