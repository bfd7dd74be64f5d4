// SPDX-License-Identifier: Apache-2.0
// Sampler: Owen-scrambled Sobol (0,2) pairs, padded: each dimension pair has its own shuffle of the sample index and
// its own scramble. Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4).
//
// The 16 x 16 pixels of a tile share a pair's scramble, and each shifts the points by digits of its own, so
// that the samples of neighbours complete each other and the noise that is left is blue: what a denoiser, or an eye,
// averages over a few pixels is well distributed. Ahmed and Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte
// Carlo Sampling Error via Hierarchical Ordering of Pixels", but for any number of samples.
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

// The shift of each binary digit of a pixel's place in its tile, in Z-order: lowest bits are first digits. Found by
// hill climbing over their bits: the first 2^k samples, k <= 6, of 2^m pixels that are neighbours in Z-order are a
// (t, k + m, 2)-net, where t is 0 or 1 for 50 of the 63 cases, and never above 3.
const uint SHIFT_X[8] = uint[](0x8bffu, 0xbf6au, 0x8acdu, 0x0476u, 0xb84bu, 0xb15du, 0x851bu, 0xaae0u);
const uint SHIFT_Y[8] = uint[](0x047fu, 0x1f95u, 0x1333u, 0x2e52u, 0x526fu, 0x19e0u, 0x9193u, 0xe7f9u);

// Pair number `pair` of sample `index` in a pixel with this seed, 32 bits each. The seed's lowest eight bits are the
// pixel's place in its tile.
uvec2 sample_bits(uint seed, uint index, uint pair) {
    pair *= 0x9e3779b9u;
    uint s = pcg_hash((seed >> 8) ^ pair);
    // Of indices, only those between two powers of two are shuffled with each other: the first 2^k stay what they are.
    uint most = index == 0u ? 0u : 1u << findMSB(index);
    index = bitfieldReverse(laine_karras(bitfieldReverse(index), pcg_hash(seed ^ pair)));
    index = most | (index & (max(most, 1u) - 1u));
    // Places are shuffled, too, or the shifts of one pair would tell those of the others.
    uint place = bitfieldReverse(laine_karras(bitfieldReverse(seed & 255u), s ^ 0x2545f491u));
    uvec2 shift = uvec2(0);
    for (int k = 0; k < 8; ++k)
        shift ^= uint(bitfieldExtract(int(place), k, 1)) & uvec2(SHIFT_X[k], SHIFT_Y[k]); // all ones, or none
    uint x = bitfieldReverse(laine_karras(index ^ shift.x, pcg_hash(s ^ 0x68bc21ebu)));
    uint y = bitfieldReverse(laine_karras(sobol1_reversed(index) ^ shift.y, pcg_hash(s ^ 0x02e5be93u)));
    return uvec2(x, y);
}
vec2 sample_pair(uint seed, uint index, uint pair) {
    uvec2 bits = sample_bits(seed, index, pair);
    return vec2(to_unit(bits.x), to_unit(bits.y));
}

// pixel: of the camera's whole picture.
uint pixel_seed(uvec2 pixel, bool twin, uint seed) {
    uint tile = pcg_hash((pixel.y >> 4) * 65536u + (pixel.x >> 4));
    uvec2 place = pixel & 15u; // its digits, spread
    place = (place | (place << 2)) & 0x33u;
    place = (place | (place << 1)) & 0x55u;
    return (pcg_hash(tile ^ pcg_hash(seed ^ (twin ? 0x9d2c5680u : 0xb5297a4du))) & ~255u) | place.x | (place.y << 1);
}

// The table of a path's pairs: two for the camera, then four per vertex. Who else needs random numbers takes a new row.
const uint PAIR_FILTER = 0u;                                  // a point of the pixel filter
const uint PAIR_LENS = 1u;                                    // a point of the lens
const uint PAIR_WAVELENGTHS = 0xffffffffu;                    // x: the hero wavelength; behind those of all vertices
uint pair_light_pick(uint depth) { return 2u + 4u * depth; }  // x: which emitter, y: Russian roulette
uint pair_light(uint depth) { return 3u + 4u * depth; }       // a point on it
uint pair_bsdf(uint depth) { return 4u + 4u * depth; }        // direction; x first: whether a guide chooses it
uint pair_lobe(uint depth) { return 5u + 4u * depth; }        // x: which lobe; y: not used

#endif
