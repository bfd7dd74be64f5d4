/* SPDX-License-Identifier: Apache-2.0 */
/* Parameter table lines that several materials share, so that a parameter has the same name, range and tooltip
 * everywhere. Each matches a function of the shader library: roughness and remap are alpha_from_roughness
 * (microfacet.glsl), multiscatter is multiscatter.glsl, the coat is layered_coat_of (layered.glsl). A convenience: a
 * plugin may write its own lines. */
#ifndef RESTAGE_MATERIAL_ROWS_H
#define RESTAGE_MATERIAL_ROWS_H

#include <restage/params.h>
#include <stddef.h>

/* clang-format off */
#define RESTAGE_ROW_ROUGHNESS_U(id, label, value) \
    RESTAGE_FLOAT_PARAM(id, label, 0, 1, value, RESTAGE_PARAM_TEXTURABLE, "", "Along the texture's u direction; 0 is a perfect mirror.")
#define RESTAGE_ROW_ROUGHNESS_V(id, label, value) \
    RESTAGE_FLOAT_PARAM(id, label, 0, 1, value, RESTAGE_PARAM_TEXTURABLE, "", "Along the texture's v direction; 0 is a perfect mirror.")
/* index: 0 = v4, 1 = v3, 2 = none */
#define RESTAGE_ROW_REMAP(index) \
    RESTAGE_ENUM_PARAM("remap", "Roughness scale", "v4|v3|none", index, RESTAGE_PARAM_ADVANCED, "How roughness maps to the microfacet alpha: pbrt-v4's square root, pbrt-v3's polynomial, or as given.")
#define RESTAGE_ROW_DISTRIBUTION \
    RESTAGE_ENUM_PARAM("distribution", "Distribution", "ggx|beckmann", 0, RESTAGE_PARAM_ADVANCED, "Shape of the microfacets: GGX has the longer tails.")
#define RESTAGE_ROW_MULTISCATTER \
    RESTAGE_BOOL_PARAM("multiscatter", "Multiple scattering", 0, RESTAGE_PARAM_ADVANCED, "Restore the energy that rough microfacets scatter among themselves; pbrt leaves it out.")
/* Defaults: copper. */
#define RESTAGE_ROWS_CONDUCTOR(eta_id, k_id) \
    RESTAGE_COLOR_PARAM(eta_id, "Index of refraction", 0, 10, 0.200438f, 0.924033f, 1.102212f, RESTAGE_PARAM_TEXTURABLE, "", "Real part, for red, green and blue."), \
    RESTAGE_COLOR_PARAM(k_id, "Absorption", 0, 20, 3.912949f, 2.452848f, 2.142188f, RESTAGE_PARAM_TEXTURABLE, "", "Imaginary part of the index of refraction."), \
    RESTAGE_COLOR_PARAM("reflectance", "Reflectance", 0, 1, 0.9f, 0.9f, 0.9f, RESTAGE_PARAM_TEXTURABLE, "", "Of the metal at normal incidence; used instead of the optical constants when the switch below is on."), \
    RESTAGE_BOOL_PARAM("use_reflectance", "Use reflectance", 0, 0, "Use the colour instead of the optical constants.")
#define RESTAGE_ROWS_COAT(eta_id) \
    RESTAGE_FLOAT_PARAM("thickness", "Coat thickness", 0, 10, 0.01f, RESTAGE_PARAM_TEXTURABLE, "", "Of the coat, in mean free paths of its medium."), \
    RESTAGE_FLOAT_PARAM(eta_id, "Coat index of refraction", 1, 3, 1.5f, RESTAGE_PARAM_TEXTURABLE, "", "Of the coat relative to the outside."), \
    RESTAGE_FLOAT_PARAM("g", "Coat anisotropy", -0.95f, 0.95f, 0, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, "", "Of the scattering inside the coat: -1 backward, 0 isotropic, 1 forward."), \
    RESTAGE_COLOR_PARAM("albedo", "Coat albedo", 0, 1, 0, 0, 0, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, "", "Of the particles inside the coat; black: a clear coat."), \
    RESTAGE_INT_PARAM("max_depth", "Coat bounces", 1, 100, 10, RESTAGE_PARAM_ADVANCED, "", "Maximum number of events inside the coat."), \
    RESTAGE_INT_PARAM("n_samples", "Coat samples", 1, 16, 1, RESTAGE_PARAM_ADVANCED, "", "Random walks per evaluation of the coat: less noise, more time.")
/* clang-format on */

#endif
