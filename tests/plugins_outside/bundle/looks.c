/* SPDX-License-Identifier: Apache-2.0 */
/* Appearance: a material, a texture, a sky. */
#include "bundle.h"

#include <math.h>

static const RestageParam chalk_params[] = {
    RESTAGE_COLOR_PARAM("tint", "Tint", 0, 1, 0.8f, 0.8f, 0.7f, RESTAGE_PARAM_TEXTURABLE, "",
                        "Fraction of light that is reflected."),
};
const RestageMaterial1 chalk = {
    .size = sizeof(RestageMaterial1),
    .flags = RESTAGE_MATERIAL_LOSSLESS,
    .type = "chalk",
    .label = "Chalk",
    .prefix = "chalk",
    .glsl_file = "chalk.glsl",
    .params = chalk_params,
    .param_count = RESTAGE_COUNT(chalk_params),
    .tooltip = "Lambert's law.",
};

static const RestageParam stripes_params[] = {
    RESTAGE_COLOR_PARAM("first", "First", 0, 1, 1, 1, 1, RESTAGE_PARAM_TEXTURABLE, "", "The stripe at the left edge."),
    RESTAGE_COLOR_PARAM("second", "Second", 0, 1, 0, 0, 0, RESTAGE_PARAM_TEXTURABLE, "", "After it."),
    RESTAGE_FLOAT_PARAM("count", "Count", 1, 64, 4, 0, "", "Pairs of stripes per unit of u."),
};
static void stripes_eval(const RestageTextureAt1* at, float rgb[3]) {
    const float x = at->uv[0] * at->values[8];
    memcpy(rgb, at->values + (x - floorf(x) < 0.5f ? 0 : 4), 3 * sizeof(float));
}
const RestageTexture1 stripes = {
    .size = sizeof(RestageTexture1),
    .flags = RESTAGE_TEXTURE_MAPPED,
    .type = "stripes",
    .label = "Stripes",
    .prefix = "stripes",
    .glsl_file = "stripes.glsl",
    .params = stripes_params,
    .param_count = RESTAGE_COUNT(stripes_params),
    .tooltip = "Stripes across u.",
    .eval = stripes_eval,
};

static const RestageParam dusk_params[] = {
    RESTAGE_FLOAT_PARAM("brightness", "Brightness", 0, 10, 1, 0, "", "Radiance at the zenith."),
    RESTAGE_FLOAT_PARAM("elevation", "Elevation", 0, 90, 10, 0, "deg", "Of the sun above the horizon, in the east."),
};
static int dusk_make(const RestageValue* values, uint32_t count, const RestageSkyJob1* out) {
    const float brightness = RESTAGE_AT(RestageValue, values, 0).v[0];
    const double elevation = (double)RESTAGE_AT(RestageValue, values, 1).v[0] * 3.14159265358979 / 180;
    RestageSkySun sun = {.size = sizeof sun, .radiance = {20, 10, 5}, .angular_radius = 0.02f};
    uint32_t x, y;
    (void)count;
    for (y = 0; y < out->width; ++y) {
        if (!out->progress(out->ctx, (float)y / (float)out->width)) return 0;
        for (x = 0; x < out->width; ++x) {
            float* rgb = out->pixels + 3 * ((size_t)y * out->width + x);
            double w[3];
            restage_sky_direction(out->width, x + 0.5, y + 0.5, w);
            rgb[0] = brightness * (w[2] > 0 ? 1 : 0.25f);
            rgb[1] = rgb[0] * 0.8f;
            rgb[2] = rgb[0] * (w[2] > 0 ? 0.5f + 0.5f * (float)w[2] : 0.5f);
        }
    }
    sun.direction[0] = (float)cos(elevation);
    sun.direction[2] = (float)sin(elevation);
    out->sun(out->ctx, &sun);
    return 1;
}
const RestageSky1 dusk = {
    .size = sizeof(RestageSky1),
    .param_count = RESTAGE_COUNT(dusk_params),
    .type = "dusk",
    .label = "Dusk",
    .tooltip = "A grey sky with a warm horizon.",
    .params = dusk_params,
    .make = dusk_make,
};
