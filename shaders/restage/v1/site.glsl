// SPDX-License-Identifier: Apache-2.0
// Site: where, and on which object, a material is asked. Given to the functions of materials with RESTAGE_MATERIAL_SITE,
// after their parameters: for flakes, glints and procedurals. Changes from pixel to pixel are those of a camera that sees
// the point directly, whatever path has led there (Pharr et al. 2023, sec. 10.1.2).
#ifndef RESTAGE_V1_SITE
#define RESTAGE_V1_SITE

struct Site {
    vec2 uv;             // the first set; of a mesh without one, barycentrics
    vec2 duv_dx, duv_dy; // its change from one pixel to the next, to the right and downwards
    vec3 position;       // in the object's space: moving the object moves the pattern along
    vec3 dp_dx, dp_dy;   // its change, along the surface
    vec3 world;          // the point in the scene's space
    vec3 normal;         // there; geometric, unit, on the outside
    float footprint;     // [scene units] the longer side of a pixel's image on the surface: what is finer is not seen
    uint object;         // a hash that tells instances apart; edits of them do not change it
};

#endif
