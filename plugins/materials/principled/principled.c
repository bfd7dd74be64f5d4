/* SPDX-License-Identifier: Apache-2.0 */
/* Principled: the parameter table; the physics is in principled.glsl, formulas and sources in README.md. */
#include <restage/emission.h>
#include <restage/material.h>
#include <restage/material_rows.h>

/* clang-format off */
static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("base_color", "Base colour", 0, 1, 0.8f, 0.8f, 0.8f, RESTAGE_PARAM_TEXTURABLE, "", "Colour of the matte part, of the metal at normal incidence, and of transmitted light."),
    RESTAGE_FLOAT_PARAM("metallic", "Metallic", 0, 1, 0, RESTAGE_PARAM_TEXTURABLE, "", "0: plastic, wood, stone, glass; 1: metal."),
    RESTAGE_FLOAT_PARAM("roughness", "Roughness", 0, 1, 0.5f, RESTAGE_PARAM_TEXTURABLE, "", "0 is a perfect mirror; its square is the microfacet alpha."),
    RESTAGE_FLOAT_PARAM("ior", "Index of refraction", 1, 3, 1.5f, 0, "", "Of the non-metal part: water 1.33, most things 1.5, diamond 2.4."),
    RESTAGE_FLOAT_PARAM("specular", "Specular", 0, 1, 1, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, "", "Strength of the non-metal reflection; 1 is physical."),
    RESTAGE_COLOR_PARAM("specular_color", "Specular colour", 0, 25, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, "", "Tint of that reflection at normal incidence; white is physical."),
    RESTAGE_FLOAT_PARAM("transmission", "Transmission", 0, 1, 0, RESTAGE_PARAM_TEXTURABLE, "", "How much of the matte part is clear instead: 1 is glass."),
    RESTAGE_BOOL_PARAM("thin", "Thin", 0, 0, "A pane without thickness: transmitted light is not bent."),
    RESTAGE_FLOAT_PARAM("clearcoat", "Clear coat", 0, 1, 0, RESTAGE_PARAM_TEXTURABLE, "", "A layer of varnish over everything."),
    RESTAGE_FLOAT_PARAM("clearcoat_roughness", "Coat roughness", 0, 1, 0, RESTAGE_PARAM_TEXTURABLE, "", "Roughness of the varnish."),
    RESTAGE_COLOR_PARAM("sheen_color", "Sheen", 0, 1, 0, 0, 0, RESTAGE_PARAM_TEXTURABLE, "", "Colour of fibres standing on the surface, as on velvet; black: none."),
    RESTAGE_FLOAT_PARAM("sheen_roughness", "Sheen roughness", 0, 1, 0.3f, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, "", "Low: the fibres show at the rim only; high: everywhere."),
    RESTAGE_FLOAT_PARAM("anisotropy", "Anisotropy", 0, 1, 0, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, "", "Brushed: how much rougher along the texture's u direction."),
    RESTAGE_FLOAT_PARAM("anisotropy_rotation", "Anisotropy rotation", -360, 360, 0, RESTAGE_PARAM_ADVANCED, "deg", "Turns that direction, counter-clockwise."),
    RESTAGE_FLOAT_PARAM("iridescence", "Iridescence", 0, 1, 0, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, "", "A thin film on the surface: soap, oil, beetles."),
    RESTAGE_FLOAT_PARAM("iridescence_ior", "Film index", 1, 3, 1.3f, RESTAGE_PARAM_ADVANCED, "", "Refractive index of that film."),
    RESTAGE_FLOAT_PARAM("iridescence_thickness", "Film thickness", 0, 2000, 400, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, "nm", "Thickness of that film."),
    RESTAGE_COLOR_PARAM("emission_color", "Emission", 0, 1, 0, 0, 0, RESTAGE_PARAM_TEXTURABLE | RESTAGE_PARAM_ADVANCED, "", "Colour of the light it emits; with a picture, a screen or a lit sign; black: none."),
    RESTAGE_FLOAT_PARAM("emission_scale", "Emission brightness", 0, 1000000, 1, RESTAGE_PARAM_ADVANCED, "W/(m²sr)", "Radiance where that colour is 1."),
    RESTAGE_BOOL_PARAM("emission_two_sided", "Emission two-sided", 0, RESTAGE_PARAM_ADVANCED, "Shines from the back of its surface, too."),
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
    .tooltip = "Metal, plastic, varnish and glass by a few parameters, as glTF defines them.",
};

static const RestageEmission1 emission = {
    .size = sizeof(RestageEmission1),
    .type = "principled",
    .radiance = "emission_color",
    .scale = "emission_scale",
    .two_sided = "emission_two_sided",
};

RESTAGE_PLUGIN("org.restage.material.principled", "0.1.0", {RESTAGE_MATERIAL1, &material},
               {RESTAGE_EMISSION1, &emission})
