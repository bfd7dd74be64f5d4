/* SPDX-License-Identifier: Apache-2.0 */
/* Principled: the parameter table; the physics is in principled.glsl, formulas and sources in README.md. */
#include <restage/material_plugin.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    {"base_color", "Base colour", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.8f, 0.8f, 0.8f}, "", NULL, "Of the matte part, of the metal seen head on, and of what shines through."},
    {"metallic", "Metallic", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "0: plastic, wood, stone, glass; 1: metal."},
    {"roughness", "Roughness", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0.5f}, "", NULL, "0 is a perfect mirror; its square is the microfacet alpha."},
    {"ior", "Index of refraction", RESTAGE_FLOAT, 0, 1, 3, {1.5f}, "", NULL, "Of what is not metal: water 1.33, most things 1.5, diamond 2.4."},
    {"specular", "Specular", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, 0, 1, {1}, "", NULL, "Strength of the reflection of what is not metal; 1 is physical."},
    {"specular_color", "Specular colour", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, 0, 25, {1, 1, 1}, "", NULL, "Tint of that reflection seen head on; white is physical."},
    {"transmission", "Transmission", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "How much of the matte part is clear instead: 1 is glass."},
    {"thin", "Thin", RESTAGE_BOOL, 0, 0, 1, {0}, "", NULL, "A pane without thickness: what shines through is not bent."},
    {"clearcoat", "Clear coat", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "A layer of varnish over everything."},
    {"clearcoat_roughness", "Coat roughness", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0}, "", NULL, "Of the varnish."},
    {"sheen_color", "Sheen", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE, 0, 1, {0, 0, 0}, "", NULL, "Of fibres that stand on the surface, as on velvet; black: none."},
    {"sheen_roughness", "Sheen roughness", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, 0, 1, {0.3f}, "", NULL, "Low: the fibres shine at the rim only; high: everywhere."},
    {"anisotropy", "Anisotropy", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, 0, 1, {0}, "", NULL, "Brushed: how much rougher along the texture's u direction."},
    {"anisotropy_rotation", "Anisotropy rotation", RESTAGE_FLOAT, RESTAGE_PARAM_ADVANCED, -360, 360, {0}, "deg", NULL, "Turns that direction, counter-clockwise."},
    {"iridescence", "Iridescence", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, 0, 1, {0}, "", NULL, "A thin film on the surface: soap, oil, beetles."},
    {"iridescence_ior", "Film index", RESTAGE_FLOAT, RESTAGE_PARAM_ADVANCED, 1, 3, {1.3f}, "", NULL, "Of refraction, of that film."},
    {"iridescence_thickness", "Film thickness", RESTAGE_FLOAT, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, 0, 2000, {400}, "nm", NULL, "Of that film."},
    {"emission_color", "Emission", RESTAGE_COLOR, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, 0, 1, {0, 0, 0}, "", NULL, "Colour of the light it gives off by itself; a picture makes a screen or a lit sign of it; black: none."},
    {"emission_scale", "Emission brightness", RESTAGE_FLOAT, RESTAGE_PARAM_ADVANCED, 0, 1000000, {1}, "W/(m²sr)", NULL, "Radiance where that colour is 1."},
    {"emission_two_sided", "Emission two-sided", RESTAGE_BOOL, RESTAGE_PARAM_ADVANCED, 0, 1, {0}, "", NULL, "Shines from the back of its surface, too."},
    RESTAGE_ROW_MULTISCATTER,
};
/* clang-format on */

static const RestageMaterial1 material = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_TRANSMISSIVE | RESTAGE_MATERIAL_TANGENT,
    .type = "principled",
    .label = "Principled (glTF)",
    .prefix = "principled",
    .glsl_file = "principled.glsl",
    .params = params,
    .param_count = RESTAGE_COUNT(params),
    .tooltip = "Metal, plastic, varnish and glass by a few dials, as glTF defines them.",
};

static const RestageEmission1 emission = {
    .size = sizeof(RestageEmission1),
    .type = "principled",
    .radiance = "emission_color",
    .scale = "emission_scale",
    .two_sided = "emission_two_sided",
};

RESTAGE_MATERIAL_PLUGIN_EMISSION("org.restage.material.principled", "0.1.0", material, emission)
