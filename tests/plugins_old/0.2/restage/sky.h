/* SPDX-License-Identifier: Apache-2.0 */
/* Interface "restage.sky/1": parameters become the picture of all directions, and perhaps suns.
 *
 * The sky has a frame of its own: +z is up (the host turns it to the scene's up), and by custom +y north, +x east. Its
 * picture is a square in the equal-area octahedral map (Clarberg 2008, as in pbrt-v4): every texel has the solid angle
 * 4 pi / width^2. Radiance is RGB, linear sRGB primaries. What is as small as the sun does not belong into the pixels:
 * tell it by `sun`, and the host draws the disk with its exact energy, in a picture fine enough to hold it. */
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
    float radiance[3];    /* finite, not negative; added to the picture's */
    float angular_radius; /* [rad], above 0, at most pi/2; our sun: 0.00465 */
} RestageSkySun;

typedef struct RestageSkyJob1 { /* the host's */
    RESTAGE_SIZE(RestageSkyJob1);
    uint32_t width; /* of the square, at least 1; the host asks for what it needs, and may ask again for more */
    float* pixels;  /* width * width * 3, row 0 first; zeroed. Finite and not negative when make returns */
    void* ctx;
    /* All [worker], on the thread that called make, before it returns. */
    int (*progress)(void* ctx, float done); /* 0..1; returns 0 when it is to stop: then return 0 from make at once */
    void (*sun)(void* ctx, const RestageSkySun*); /* for each sun, 16 at most */
    void (*error)(void* ctx, const char* message); /* why make will return 0; the first one is shown */
} RestageSkyJob1;

typedef struct RestageSky1 {
    RESTAGE_SIZE(RestageSky1);
    uint32_t param_count;
    const char* type;    /* "sunsky": lower_snake, unique over all plugins; what scenes and projects call it */
    const char* label;   /* "Sun and sky" */
    const char* tooltip; /* one sentence */
    const RestageParam* params; /* no TEXTURE, MATERIAL or TABLE, none texturable */
    /* [worker] Several may run at once. Fills the job's pixels; 1 = done, 0 = stopped, or error() has been called.
     * `values`: every parameter of the table, in its order. The same values give the same picture, whenever: scenes
     * keep the values and make the picture again. */
    int (*make)(const RestageValue* values, uint32_t count, const RestageSkyJob1* out);
} RestageSky1;

/* The direction, of length 1, of a point of a picture `width` texels wide: texel (x, y) has its centre at x + 0.5,
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
