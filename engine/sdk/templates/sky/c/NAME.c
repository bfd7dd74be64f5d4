/* @LABEL@: a colour at the zenith, one at the horizon, one below it, and a sun. */
#include <restage/sky.h>
#include <string.h>

static const RestageParam params[] = {
    RESTAGE_COLOR_PARAM("zenith", "Zenith", 0, 10, 0.15f, 0.3f, 0.8f, 0, "", "Radiance from the zenith."),
    RESTAGE_COLOR_PARAM("horizon", "Horizon", 0, 10, 0.7f, 0.75f, 0.8f, 0, "", "Radiance from the horizon."),
    RESTAGE_COLOR_PARAM("ground", "Ground", 0, 10, 0.1f, 0.09f, 0.08f, 0, "", "Radiance from below the horizon."),
    RESTAGE_FLOAT_PARAM("elevation", "Elevation", 0, 90, 40, 0, "deg", "Of the sun above the horizon."),
    RESTAGE_FLOAT_PARAM("strength", "Sun", 0, 10, 2, 0, "", "Irradiance of a surface that faces the sun."),
};

static const RestageValue* value(const RestageValue* values, uint32_t count, const char* id) {
    uint32_t i;
    for (i = 0; i < count; ++i)
        if (strcmp(RESTAGE_AT(RestageValue, values, i).id, id) == 0) return &RESTAGE_AT(RestageValue, values, i);
    return NULL; /* the host passes every line of the table */
}

static int make(const RestageValue* values, uint32_t count, const RestageSkyJob1* out) {
    const float* zenith = value(values, count, "zenith")->v;
    const float* horizon = value(values, count, "horizon")->v;
    const float* ground = value(values, count, "ground")->v;
    const double elevation = value(values, count, "elevation")->v[0] * 3.14159265358979 / 180;
    const float strength = value(values, count, "strength")->v[0];
    uint32_t x, y, k;
    for (y = 0; y < out->width; ++y) {
        if (!out->progress(out->ctx, (float)y / (float)out->width)) return 0;
        for (x = 0; x < out->width; ++x) {
            double w[3]; /* z is up */
            float* pixel = out->pixels + 3 * ((size_t)y * out->width + x);
            restage_sky_direction(out->width, x + 0.5, y + 0.5, w);
            for (k = 0; k < 3; ++k)
                pixel[k] = w[2] < 0 ? ground[k] : horizon[k] + (zenith[k] - horizon[k]) * (float)sqrt(w[2]);
        }
    }
    if (strength > 0) {
        RestageSkySun sun = {.size = sizeof sun, .angular_radius = 0.00465f}; /* [rad] */
        sun.direction[1] = (float)cos(elevation); /* north */
        sun.direction[2] = (float)sin(elevation);
        for (k = 0; k < 3; ++k)
            sun.radiance[k] = strength / (3.14159265f * sun.angular_radius * sun.angular_radius);
        out->sun(out->ctx, &sun);
    }
    return 1;
}

static const RestageSky1 sky = {
    .size = sizeof(RestageSky1),
    .param_count = RESTAGE_COUNT(params),
    .type = "@NAME@",
    .label = "@LABEL@",
    .tooltip = "One sentence for users who are choosing a sky.",
    .params = params,
    .make = make,
};

RESTAGE_PLUGIN("@ID@", "0.1.0", {RESTAGE_SKY1, &sky})
