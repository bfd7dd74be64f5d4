/* @LABEL@: each pixel becomes a weighted mean of its neighbours; neighbours whose albedo or normal differ count less,
 * so that edges stay. (A cross-bilateral filter, Eisemann and Durand 2004, Petschnigg et al. 2004.)
 * <restage/denoiser.h> states the requirements; `restage check` tests them. */
#include <float.h>
#include <restage/denoiser.h>
#include <stdlib.h>

static int is_finite(float x) { return x - x == 0.0f; }

/* The squared distance of two pixels of a guide; 0 if there is no guide, or if it is non-finite. */
static float distance2(const float* guide, size_t a, size_t b) {
    float sum = 0;
    int c;
    for (c = 0; guide && c < 3; ++c) {
        const float d = guide[3 * a + c] - guide[3 * b + c];
        if (is_finite(d)) sum += d * d;
    }
    return sum;
}

static void filter_pixel(const RestageDenoiseJob* job, const float* color, int x, int y, int radius) {
    const int width = (int)job->width, height = (int)job->height;
    const size_t here = (size_t)y * job->width + (size_t)x;
    double sum[3] = {0, 0, 0}, weights = 0;
    int i, j, c;
    for (j = y - radius; j <= y + radius; ++j)
        for (i = x - radius; i <= x + radius; ++i) {
            const size_t there = (size_t)j * job->width + (size_t)i;
            const float* rgb = color + 3 * there;
            double weight;
            if (i < 0 || j < 0 || i >= width || j >= height) continue;
            if (!is_finite(rgb[0]) || !is_finite(rgb[1]) || !is_finite(rgb[2]))
                continue; /* a non-finite pixel does not spread */
            weight = 1.0 / ((1.0 + 200.0 * distance2(job->albedo, here, there)) *
                            (1.0 + 50.0 * distance2(job->normal, here, there)));
            for (c = 0; c < 3; ++c)
                sum[c] += weight * rgb[c];
            weights += weight;
        }
    for (c = 0; c < 3; ++c) {
        const double mean = weights > 0 ? sum[c] / weights : 0;
        job->output[3 * here + c] = mean <= 0 ? 0 : mean < FLT_MAX ? (float)mean : FLT_MAX;
    }
}

/* [any] A denoiser that needs a device or a driver checks for it here. */
static int available(const char** reason) {
    *reason = "";
    return 1;
}

/* [worker] */
static int run(const RestageDenoiseJob* job, const char** reason) {
    const int radius = 3;
    const size_t bytes = (size_t)job->width * job->height * 3 * sizeof(float);
    float* color = (float*)malloc(bytes); /* the output may be the same memory as the picture */
    uint32_t x, y;
    if (!color) {
        *reason = "out of memory";
        return 0;
    }
    memcpy(color, job->color, bytes);
    for (y = 0; y < job->height; ++y) {
        if (job->progress && !job->progress(job->progress_ctx, (double)y / job->height)) {
            *reason = "stopped";
            free(color);
            return 0;
        }
        for (x = 0; x < job->width; ++x)
            filter_pixel(job, color, (int)x, (int)y, radius);
    }
    free(color);
    return 1;
}

static const RestageDenoiser1 denoiser = {
    .size = sizeof(RestageDenoiser1),
    .type = "@NAME@",
    .label = "@LABEL@",
    .available = available,
    .run = run,
};

RESTAGE_PLUGIN("@ID@", "0.1.0", {RESTAGE_DENOISER1, &denoiser})
