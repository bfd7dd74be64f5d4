/* SPDX-License-Identifier: Apache-2.0 */
/* Interface "restage.sky/1": generates an environment image, and optionally suns, from parameters.
 *
 * In the sky's frame +z is up (the host rotates it to the scene's up) and, by convention, +y north and +x east. The
 * image is a square in the equal-area octahedral map (Clarberg 2008, as in pbrt-v4): every texel has the solid angle
 * 4 pi / width^2. Radiance is RGB, linear sRGB primaries. Do not paint anything as small as the sun into the pixels:
 * pass it to `sun`, and the host draws the disk with its exact energy, at a resolution that is sufficient for it. */
#ifndef RESTAGE_SKY_H
#define RESTAGE_SKY_H

#include <math.h>
#include <restage/params.h>
#include <restage/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RESTAGE_SKY1 "restage.sky/1"

typedef struct RestageSkySun { /* a disk of constant radiance */
    RESTAGE_SIZE(RestageSkySun);
    float direction[3];   /* towards it, in the sky's frame, of length 1 */
    float radiance[3];    /* finite, not negative; added to the image's */
    float angular_radius; /* [rad], above 0, at most pi/2; the Sun: 0.00465 */
} RestageSkySun;

typedef struct RestageSkyJob1 { /* the host's */
    RESTAGE_SIZE(RestageSkyJob1);
    uint32_t width; /* of the square, at least 1; the host chooses it, and may call again with a larger one */
    float* pixels;  /* width * width * 3, row 0 first; zeroed. Finite and not negative when make returns */
    void* ctx;
    /* All [worker], on the thread that called make, before it returns. */
    int (*progress)(void* ctx,
                    float done); /* 0..1; returns 0 if the user wants to stop: then return 0 from make at once */
    void (*sun)(void* ctx, const RestageSkySun*); /* once per sun, at most 16 */
    void (*error)(void* ctx, const char* message); /* why make will return 0; only the first call is shown */
} RestageSkyJob1;

typedef struct RestageSky1 {
    RESTAGE_SIZE(RestageSky1);
    uint32_t param_count;
    const char* type;    /* "sunsky": lower_snake, unique over all plugins; its name in scenes and projects */
    const char* label;   /* "Sun and sky" */
    const char* tooltip; /* one sentence */
    const RestageParam* params; /* no TEXTURE, MATERIAL or TABLE, none texturable */
    /* [worker] Several may run at once. Fills the job's pixels; 1 = done, 0 = stopped, or error() has been called.
     * `values`: every parameter of the table, in its order. The same values must always give the same image: scenes
     * store the values and regenerate the image. */
    int (*make)(const RestageValue* values, uint32_t count, const RestageSkyJob1* out);
} RestageSky1;

/* The unit direction of a point of an image `width` texels wide: texel (x, y) has its centre at x + 0.5,
 * y + 0.5, and begins at pixels[3 * (y * width + x)]. */
static inline void restage_sky_direction(uint32_t width, double x, double y, double direction[3]) {
    const double u = 2 * x / width - 1, v = 2 * y / width - 1, au = fabs(u), av = fabs(v);
    const double d = 1 - (au + av), r = 1 - fabs(d);
    const double phi = (r == 0 ? 1 : (av - au) / r + 1) * 0.78539816339744830962;
    const double s = r * sqrt(2 - r * r);
    direction[0] = copysign(cos(phi) * s, u);
    direction[1] = copysign(sin(phi) * s, v);
    direction[2] = copysign(1 - r * r, d);
}

#ifdef __cplusplus
}
#endif
#endif
