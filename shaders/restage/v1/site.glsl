// SPDX-License-Identifier: Apache-2.0
// Site: the shading point, and its object, at which a material is evaluated. Passed to functions of materials with RESTAGE_MATERIAL_SITE,
// after their parameters: for flakes, glints and procedurals. Differences between pixels are those of a camera that sees
// the point directly, whatever path led there (Pharr et al. 2023, sec. 10.1.2).
#ifndef RESTAGE_V1_SITE
#define RESTAGE_V1_SITE

struct Site {
    vec2 uv;             // the first set; barycentrics if the mesh has none
    vec2 duv_dx, duv_dy; // its difference to the next pixel, to the right and downwards
    vec3 position;       // in object space: the pattern moves with the object
    vec3 dp_dx, dp_dy;   // its difference, along the surface
    vec3 world;          // the point in scene space
    vec3 normal;         // there; geometric, unit, on the outside
    float footprint;     // [scene units] the longer side of a pixel projected onto the surface: finer detail is invisible
    uint object;         // a hash that identifies the instance; edits do not change it
};

#endif
