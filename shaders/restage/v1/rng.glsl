// SPDX-License-Identifier: Apache-2.0
// Rng: a small pseudo-random stream for consumers of an unknown number of values (layered random walks).
// PCG-RXS-M-XS 32 (O'Neill 2014; as a hash, Jarzynski and Olano 2020). The path's own dimensions come from sampler.glsl.
#ifndef RESTAGE_V1_RNG
#define RESTAGE_V1_RNG
#include "shared/hash.h"

struct Rng {
    uint state;
};

// [0, 1)
float rng_next(inout Rng rng) {
    rng.state = rng.state * 747796405u + 2891336453u;
    uint w = ((rng.state >> ((rng.state >> 28u) + 4u)) ^ rng.state) * 277803737u;
    return float(((w >> 22u) ^ w) >> 8) * (1.0 / 16777216.0);
}
vec2 rng_next2(inout Rng rng) {
    float a = rng_next(rng);
    return vec2(a, rng_next(rng));
}
vec3 rng_next3(inout Rng rng) {
    vec2 a = rng_next2(rng);
    return vec3(a, rng_next(rng));
}

#endif
