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

struct CasterSphere { // around casters: what photons aim at
    vec3 center;
    float radius;
};

struct PhotonMap {
    address photons; // Photon[], ordered by cell
    address cells; // uint[cell_mask + 2]: of each hash of a cell its first photon
    address roles; // uint[] by instance: ROLE_*
    address deposits; // Photon[], by path of a wave of photons
    address sources; // PhotonSource[source_count]
    address source_cdf; // CdfEntry[source_count]
    address casters; // CasterSphere[caster_count]
    uint cell_mask;
    uint count; // photons; 0: no caustics
    float radius; // of the disk in which they are gathered
    float per_photon; // 1 / paths of photons that were started
    uint source_count, caster_count;
    uint environment; // ROLE_LIGHT if photons start from it
    uint seed, first_path; // of this wave of photons
    vec3 center; // of a sphere around the scene
    float scene_radius;
    float hero; // spectral mode: chooses the wavelengths of photons and of the paths that gather them; < 0: each path
                // its own
};

RESTAGE_INLINE uint photon_cell_hash(int x, int y, int z) {
    return pcg_hash(uint(x) ^ pcg_hash(uint(y) ^ pcg_hash(uint(z))));
}

RESTAGE_SHARED_END
#endif
