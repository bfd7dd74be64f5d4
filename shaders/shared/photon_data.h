// SPDX-License-Identifier: Apache-2.0
// Photon maps of caustics: light that went through glass or off mirrors before it met anything else.
// render/photon_map.hpp.
#ifndef RESTAGE_SHARED_PHOTON_DATA_H
#define RESTAGE_SHARED_PHOTON_DATA_H
#include "shared/address.h"
#include "shared/hash.h"
#include "shared/types.h"

RESTAGE_CONSTANTS_BEGIN
RESTAGE_UINT(CASTERS_MOST, 16u);
// Of an instance in caustics
RESTAGE_UINT(ROLE_CASTER, 1u); // photons pass its delta lobes
RESTAGE_UINT(ROLE_LIGHT, 2u); // it emits, and photons start from it
RESTAGE_CONSTANTS_END

RESTAGE_SHARED_BEGIN

struct Photon { // 36 bytes
    vec3 p;
    uint direction; // to where it came from; octahedral, 16 bits each
    vec4 power; // [W], of all photons together as many times as there are; RGB, or of the map's wavelengths. A deposit
                // with x < 0: none
    uint normal; // of the surface it met, on the side it came from
};

struct PhotonSource { // of light
    uint light; // LightData
    float pmf; // of being chosen
};

struct PhotonRun { // the photons of one map
    uint seed;
    float radius; // of the disk in which they are gathered
    float hero; // spectral mode: chooses the wavelengths of photons and of the paths that gather them; < 0: each path
                // its own
};

struct CasterSphere { // around casters: what photons aim at
    vec3 center;
    float radius;
};

struct PhotonMap { // several maps, each for some samples
    address photons; // Photon[], ordered by map and cell
    address cells; // uint[maps * (cell_mask + 1) + 1]: of each map and hash of a cell its first photon
    address roles; // uint[] by instance: ROLE_*
    address deposits; // Photon[], by path of a wave of photons
    address sources; // PhotonSource[source_count]
    address source_cdf; // CdfEntry[source_count]
    address casters; // CasterSphere[caster_count]
    address starts; // CdfEntry[start_rows * start_side^2]: cells of the numbers that choose a photon's start, see
                    // wave_photons.comp
    address runs; // PhotonRun[], by map
    uint cell_mask;
    uint count; // photons; 0: no caustics
    uint first_map, samples_per_map;
    float per_photon; // 1 / paths of photons that were started
    uint source_count, caster_count;
    uint environment; // ROLE_LIGHT if photons start from it
    uint start_rows, start_side;
    uint paths, first_path; // of photons: of each map; the first of this wave, of all maps
    vec3 center; // of a sphere around the scene
    float scene_radius;
};

RESTAGE_INLINE uint photon_cell_hash(int x, int y, int z) {
    return pcg_hash(uint(x) ^ pcg_hash(uint(y) ^ pcg_hash(uint(z))));
}

RESTAGE_SHARED_END
#endif
