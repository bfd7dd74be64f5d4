// SPDX-License-Identifier: Apache-2.0
// Photons in the path step: where they stop, and their density around a vertex. Jensen 1996, "Global Illumination using
// Photon Maps"; Knaus and Zwicker 2011, "Progressive Photon Mapping: A Probabilistic Approach".
#ifndef RESTAGE_PATH_PHOTONS
#define RESTAGE_PATH_PHOTONS
#include "lib/photons.glsl"
#include "lib/spectral.glsl"
#include "path/surface.glsl"
#include "shared/octahedral.h"

PhotonMap photon_map;
uint photon_role; // of the instance hit
Photon photon_deposit; // where a photon met a surface that scatters

void photons_begin(address map, uint instance) {
    photon_map = PhotonMapRef(map).map;
    photon_role = UintArray(photon_map.roles).at[instance];
    photon_deposit = Photon(vec3(0), 0u, vec4(-1), 0u);
}

// Distance of a photon's plane from the vertex, in radii, and the least cosine between their normals: others are on another
// surface, around a corner.
const float GATHER_HEIGHT = 0.5, GATHER_COSINE = 0.5;

// Whether the material scatters by more than delta lobes, on either side.
bool scatters(Material m, vec3 wo, BsdfSample b, inout Rng rng) {
    if (b.flags != 0u && (b.flags & BSDF_DELTA) == 0u) return true;
    float density = 0.0;
    for (uint side = 0u; side < 2u; ++side)
        density += material_pdf(m, wo, side == 0u ? vec3(wo.xy, abs(wo.z)) : vec3(wo.xy, -abs(wo.z)), rng);
    return density > 0.0;
}

void photon_stop(Surface s, vec3 wo_world, Spectrum power) {
    vec3 n = dot(wo_world, s.ng) < 0.0 ? -s.ng : s.ng;
#ifdef RESTAGE_SPECTRAL
    vec4 stored = power;
#else
    vec4 stored = vec4(power, 0.0);
#endif
    photon_deposit = Photon(s.p, packSnorm2x16(direction_to_octahedral(wo_world) * 2.0 - 1.0), stored,
                            packSnorm2x16(direction_to_octahedral(n) * 2.0 - 1.0));
}

// Of particles, at an interpolated normal: Veach 1997, eq. 5.19.
float shading_correction(Surface s, vec3 wo, vec3 wi) {
    return abs(dot(wo, s.ns) * dot(wi, s.ng)) / max(abs(dot(wo, s.ng) * dot(wi, s.ns)), 1e-6);
}

// Radiance towards wo of the photons around the vertex.
Spectrum gather_photons(Material m, Surface s, vec3 wo_world, uint sample_index, inout Rng rng) {
    vec3 wo = to_local(s, wo_world);
    uint nth;
    float r = photon_run(photon_map, sample_index, nth).radius, r2 = r * r, per_cell = 0.5 / r;
    ivec3 first = ivec3(floor((s.p - r) * per_cell));
    PhotonArray photons = PhotonArray(photon_map.photons);
    UintArray cells = UintArray(photon_map.cells);
    Spectrum sum = Spectrum(0);
    for (int k = 0; k < 8; ++k) {
        ivec3 cell = first + ivec3(k & 1, k >> 1 & 1, k >> 2);
        uint bucket = nth * (photon_map.cell_mask + 1u) + (photon_cell_hash(cell.x, cell.y, cell.z) & photon_map.cell_mask);
        for (uint i = cells.at[bucket]; i < cells.at[bucket + 1u]; ++i) {
            vec3 p = photons.at[i].p, d = p - s.p;
            if (dot(d, d) > r2 || abs(dot(d, s.ng)) > GATHER_HEIGHT * r || ivec3(floor(p * per_cell)) != cell) continue;
            vec3 wi_world = octahedral_to_direction(unpackSnorm2x16(photons.at[i].direction) * 0.5 + 0.5);
            vec3 n = octahedral_to_direction(unpackSnorm2x16(photons.at[i].normal) * 0.5 + 0.5);
            bool same_side = dot(wi_world, s.ng) * dot(wo_world, s.ng) > 0.0;
            float arriving = abs(dot(wi_world, s.ng));
            if (abs(dot(n, s.ng)) < GATHER_COSINE || arriving < 1e-4) continue;
            vec3 wi = to_local(s, wi_world);
            if (same_side == same_hemisphere(wo, wi))
                sum += material_eval(m, wo, wi, rng) * Spectrum(photons.at[i].power) / arriving;
        }
    }
    return sum * (photon_map.per_photon * INV_PI / r2);
}

#endif
