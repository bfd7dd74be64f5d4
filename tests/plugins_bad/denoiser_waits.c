/* SPDX-License-Identifier: Apache-2.0 */
/* A denoiser that runs until it is cancelled, so that a test can reliably cancel it. */
#include <restage/denoiser.h>

static int available(const char** reason) {
    (void)reason;
    return 1;
}

static int run(const RestageDenoiseJob* job, const char** reason) {
    while (job->progress && job->progress(job->progress_ctx, 0.5)) {
    }
    *reason = "stopped";
    return 0;
}

static const RestageDenoiser1 denoiser = {
    .size = sizeof denoiser,
    .type = "waits",
    .label = "Waits to be stopped",
    .available = available,
    .run = run,
};

RESTAGE_PLUGIN("org.example.denoiser.waits", "1.0.0", {RESTAGE_DENOISER1, &denoiser})
