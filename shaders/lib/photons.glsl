// SPDX-License-Identifier: Apache-2.0
// Who carries which light: photons what went from a light, by one or more delta lobes of casters and nothing else, to a
// vertex that scatters otherwise; paths everything else. So nothing counts twice.
#ifndef RESTAGE_LIB_PHOTONS
#define RESTAGE_LIB_PHOTONS
#include "lib/scene.glsl"
#include "shared/path_data.h"
#include "shared/photon_data.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer PhotonMapRef { PhotonMap map; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer PhotonArray { Photon at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer PhotonSourceArray { PhotonSource at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer PhotonRunArray { PhotonRun at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer CasterArray { CasterSphere at[]; };

// The run of this sample's map, and its number of those that are there.
PhotonRun photon_run(PhotonMap map, uint sample_index, out uint nth) {
    nth = sample_index / map.samples_per_map - map.first_map;
    return PhotonRunArray(map.runs).at[nth];
}

// Whether light that a path finds now is not its own to count. role: ROLE_LIGHT if photons start from that light.
bool left_to_photons(uint flags, uint role) {
    const uint through_casters = PATH_CAUSTIC | PATH_SPECULAR;
    return (flags & PATH_PHOTON) != 0u || ((flags & through_casters) == through_casters && (role & ROLE_LIGHT) != 0u);
}

// The PATH_* of this file after a bounce off an instance of this role.
uint photon_flags(uint flags, uint role, bool delta) {
    if ((flags & PATH_PHOTON) != 0u) return PATH_PHOTON;
    if (delta) return (role & ROLE_CASTER) != 0u ? flags & PATH_CAUSTIC : 0u;
    return PATH_CAUSTIC;
}

#endif
