/* SPDX-License-Identifier: Apache-2.0 */
/* Lines of parameter tables that several materials share, so that one thing has one name, range and explanation
 * everywhere. Each fits a function of the shader library: roughness and remap are alpha_from_roughness
 * (microfacet.glsl), the coat is layered_coat_of (layered.glsl). Sugar: a plugin may write its own lines. */
#ifndef RESTAGE_MATERIAL_ROWS_H
#define RESTAGE_MATERIAL_ROWS_H

#include <restage/params.h>
#include <stddef.h>

/* clang-format off */
#define RESTAGE_ROW_ROUGHNESS_U(id, label, value) \
    {id, label, RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {value}, "", NULL, "Along the texture's u direction; 0 is a perfect mirror."}
#define RESTAGE_ROW_ROUGHNESS_V(id, label, value) \
    {id, label, RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {value}, "", NULL, "Along the texture's v direction; 0 is a perfect mirror."}
/* index: 0 = v4, 1 = v3, 2 = none */
#define RESTAGE_ROW_REMAP(index) \
    {"remap", "Roughness scale", RESTAGE_ENUM, RESTAGE_PARAM_ADVANCED, 0, 2, {index}, "", "v4|v3|none", "How roughness becomes the microfacet alpha: pbrt-v4's square root, pbrt-v3's polynomial, or as it is."}
#define RESTAGE_ROW_DISTRIBUTION \
    {"distribution", "Distribution", RESTAGE_ENUM, RESTAGE_PARAM_ADVANCED, 0, 1, {0}, "", "ggx|beckmann", "Shape of the microfacets: GGX has the longer tails."}
/* Defaults: copper. */
#define RESTAGE_ROWS_CONDUCTOR(eta_id, k_id) \
    {eta_id, "Index of refraction", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 10, {0.200438f, 0.924033f, 1.102212f}, "", NULL, "Real part, for red, green and blue."}, \
    {k_id, "Absorption", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 20, {3.912949f, 2.452848f, 2.142188f}, "", NULL, "Imaginary part of the index of refraction."}, \
    {"reflectance", "Reflectance", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.9f, 0.9f, 0.9f}, "", NULL, "Of the metal head on; used in place of the optical constants when the switch below is on."}, \
    {"use_reflectance", "Use reflectance", RESTAGE_BOOL, 0, 0, 1, {0}, "", NULL, "Take the colour, not the optical constants."}
#define RESTAGE_ROWS_COAT(eta_id) \
    {"thickness", "Coat thickness", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 10, {0.01f}, "", NULL, "Of the coat, in mean free paths of what fills it."}, \
    {eta_id, "Coat index of refraction", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 1, 3, {1.5f}, "", NULL, "Of the coat relative to the outside."}, \
    {"g", "Coat anisotropy", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, -0.95f, 0.95f, {0}, "", NULL, "Of the scattering inside the coat: -1 back, 0 even, 1 forward."}, \
    {"albedo", "Coat albedo", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, 0, 1, {0, 0, 0}, "", NULL, "Of the particles inside the coat; black: a clear coat."}, \
    {"max_depth", "Coat bounces", RESTAGE_INT, RESTAGE_PARAM_ADVANCED, 1, 100, {10}, "", NULL, "Most events inside the coat."}, \
    {"n_samples", "Coat samples", RESTAGE_INT, RESTAGE_PARAM_ADVANCED, 1, 16, {1}, "", NULL, "Random walks a look at the coat: less noise, more time."}
/* clang-format on */

#endif
