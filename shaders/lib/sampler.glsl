// SPDX-License-Identifier: Apache-2.0
// Sampler: Owen-scrambled Sobol (0,2) pairs, padded: each dimension pair has its own shuffle of the sample index and
// its own scramble, decorrelated per pixel by the seed. Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4).
#ifndef RESTAGE_LIB_SAMPLER
#define RESTAGE_LIB_SAMPLER
#include <restage/v1/rng.glsl>

// Laine and Karras 2011 with the constants of Vegdahl 2021: an Owen scramble of bit-reversed numbers.
uint laine_karras(uint x, uint seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Second Sobol dimension of index i with its bits reversed: the Pascal matrix mod 2 in five steps (Ahmed 2024).
uint sobol1_reversed(uint x) {
    x ^= x >> 16;
    x ^= (x & 0xff00ff00u) >> 8;
    x ^= (x & 0xf0f0f0f0u) >> 4;
    x ^= (x & 0xccccccccu) >> 2;
    x ^= (x & 0xaaaaaaaau) >> 1;
    return x;
}

float to_unit(uint x) { return float(x >> 8) * (1.0 / 16777216.0); } // [0, 1)

// Pair number `pair` of sample `index` in a pixel with this seed, 32 bits each.
uvec2 sample_bits(uint seed, uint index, uint pair) {
    uint s = pcg_hash(seed ^ (pair * 0x9e3779b9u));
    index = bitfieldReverse(laine_karras(bitfieldReverse(index), s));
    uint x = bitfieldReverse(laine_karras(index, pcg_hash(s ^ 0x68bc21ebu)));
    uint y = bitfieldReverse(laine_karras(sobol1_reversed(index), pcg_hash(s ^ 0x02e5be93u)));
    return uvec2(x, y);
}
vec2 sample_pair(uint seed, uint index, uint pair) {
    uvec2 bits = sample_bits(seed, index, pair);
    return vec2(to_unit(bits.x), to_unit(bits.y));
}

uint pixel_seed(uint pixel, bool twin, uint seed) { return pcg_hash(pixel ^ pcg_hash(seed ^ (twin ? 0x9d2c5680u : 0xb5297a4du))); }

// The table of a path's pairs: two for the camera, then four per vertex. Who else needs random numbers takes a new row.
const uint PAIR_FILTER = 0u;                                  // a point of the pixel filter
const uint PAIR_LENS = 1u;                                    // a point of the lens
const uint PAIR_WAVELENGTHS = 0xffffffffu;                    // x: the hero wavelength; behind those of all vertices
uint pair_light_pick(uint depth) { return 2u + 4u * depth; }  // x: which emitter, y: Russian roulette
uint pair_light(uint depth) { return 3u + 4u * depth; }       // a point on it
uint pair_bsdf(uint depth) { return 4u + 4u * depth; }        // direction; x first: whether a guide chooses it
uint pair_lobe(uint depth) { return 5u + 4u * depth; }        // x: which lobe; y: not used

#endif
