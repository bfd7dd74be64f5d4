/* SPDX-License-Identifier: Apache-2.0 */
/* Interface "restage.denoiser/1": a filter from a noisy HDR picture and its guides to a clean one. */
#ifndef RESTAGE_DENOISER_H
#define RESTAGE_DENOISER_H

#include <restage/plugin.h>

#ifdef __cplusplus
extern "C" {
#endif

#define RESTAGE_DENOISER1 "restage.denoiser/1"

typedef enum RestageDenoiseQuality {
    RESTAGE_DENOISE_FAST = 0,
    RESTAGE_DENOISE_BALANCED = 1,
    RESTAGE_DENOISE_HIGH = 2
} RestageDenoiseQuality;

typedef struct RestageDenoiseJob {
    RESTAGE_SIZE(RestageDenoiseJob);
    uint32_t width, height;
    const float* color;  /* RGB, linear, 3 per pixel, row 0 on top */
    const float* albedo; /* RGB in [0,1], or NULL */
    const float* normal; /* xyz in [-1,1], world space, or NULL */
    float* output;       /* RGB; may be `color` */
    uint32_t quality;    /* RestageDenoiseQuality; HIGH prefilters the guides first */
    uint32_t threads;    /* 0 = the denoiser's choice */
    void* progress_ctx;
    int (*progress)(void* ctx, double done); /* [worker] 0 = stop. May be NULL. */
} RestageDenoiseJob;

typedef struct RestageDenoiser1 {
    RESTAGE_SIZE(RestageDenoiser1);
    const char* type;  /* "oidn" */
    const char* label; /* "Open Image Denoise 2.5" */
    /* [any] 1 = usable; 0 = not, and *reason is a sentence, valid as long as the plugin. */
    int (*available)(const char** reason);
    /* [worker] One job at a time. 1 = done; 0 = failed, and *reason says why (valid until the next call). */
    int (*run)(const RestageDenoiseJob* job, const char** reason);
} RestageDenoiser1;

#ifdef __cplusplus
}
#endif
#endif
