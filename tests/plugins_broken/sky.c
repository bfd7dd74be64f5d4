/* SPDX-License-Identifier: Apache-2.0 */
/* A sky, correct by itself: grey, brighter upwards, with a sun. A macro SKY_* makes it wrong in one way.
 * tests/scripts/test_check_sky.py gives it manifests. */
#include <restage/sky.h>
#include <stdlib.h>
#include <string.h>

static const RestageParam params[] = {
    RESTAGE_FLOAT_PARAM("level", "Level", 0, 10, 1, 0, "", "Of the zenith."),
    RESTAGE_FLOAT_PARAM("tilt", "Tilt", 0, 1, 0.5f, 0, "", "How much darker the horizon is."),
    RESTAGE_BOOL_PARAM("sun", "Sun", 1, 0, "A sun."),
    RESTAGE_FLOAT_PARAM("height", "Height", -90, 90, 30, 0, "deg", "Of the sun."),
};

static const RestageValue* value(const RestageValue* values, uint32_t count, const char* id) {
    uint32_t i;
    for (i = 0; i < count; ++i)
        if (strcmp(RESTAGE_AT(RestageValue, values, i).id, id) == 0) return &RESTAGE_AT(RestageValue, values, i);
    return NULL;
}

static int make(const RestageValue* values, uint32_t count, const RestageSkyJob1* out) {
    const float level = value(values, count, "level")->v[0];
    double height = value(values, count, "height")->v[0] * 3.14159265358979 / 180;
#if defined(SKY_IDLE)
    const float tilt = 0.5f;
#else
    const float tilt = value(values, count, "tilt")->v[0];
#endif
    uint32_t x, y, k;
#if defined(SKY_VARIES)
    static float drift;
    drift += 1e-3f;
#endif
#if defined(SKY_LEAKS)
    float* lost = malloc(1u << 16);
    if (lost) memset(lost, 1, 1u << 16);
#endif
#if defined(SKY_SILENT)
    if (level > 9) return 0;
#endif
#if defined(SKY_CRASHES)
    static int* volatile nowhere;
    if (out->width == 1) *nowhere = 1;
#endif
    for (y = 0; y < out->width; ++y) {
#if defined(SKY_DEAF)
        out->progress(out->ctx, (float)y / (float)out->width);
#else
        if (!out->progress(out->ctx, (float)y / (float)out->width)) return 0;
#endif
        for (x = 0; x < out->width; ++x) {
            double w[3];
            float light;
            restage_sky_direction(out->width, x + 0.5, y + 0.5, w);
            light = level * (1 - tilt * (float)(1 - w[2]) / 2);
#if defined(SKY_NAN)
            if (w[2] < 0) light = (float)sqrt(w[2]);
#elif defined(SKY_NEGATIVE)
            light = level * (float)w[2];
#elif defined(SKY_VARIES)
            light += drift;
#endif
            for (k = 0; k < 3; ++k)
                out->pixels[3 * (y * out->width + x) + k] = light;
        }
    }
#if defined(SKY_OVERRUNS)
    out->pixels[3 * out->width * out->width] = 1;
#endif
    if (value(values, count, "sun")->i) {
        RestageSkySun sun;
        memset(&sun, 0, sizeof sun);
        sun.size = sizeof sun;
        sun.direction[0] = (float)cos(height), sun.direction[2] = (float)sin(height);
#if defined(SKY_SUN)
        sun.direction[1] = 1;
#endif
        sun.radiance[0] = sun.radiance[1] = sun.radiance[2] = 100;
        sun.angular_radius = 0.01f;
        out->sun(out->ctx, &sun);
    }
    return 1;
}

static const RestageSky1 sky = {
    sizeof(RestageSky1), RESTAGE_COUNT(params), "broken", "Broken", "Grey, with a sun.", params, make};

RESTAGE_PLUGIN("org.example.broken", "1.0.0", {RESTAGE_SKY1, &sky})
