// SPDX-License-Identifier: Apache-2.0
// Gradient noise and sums of its octaves, as in pbrt: Perlin 2002, "Improving Noise"; Pharr et al. 2018, 10.6.
#ifndef RESTAGE_V1_NOISE
#define RESTAGE_V1_NOISE

// Perlin's permutation of 0..255, four per word.
const uint noise_words[64] = uint[](
    0x5b89a097u, 0x0d830f5au, 0x35605fc9u, 0xe107e9c2u, 0x1e67248cu, 0x63088e45u, 0x0a15f025u, 0x9406be17u,
    0x4bea78f7u, 0x3ec51a00u, 0xcbdbfc5eu, 0x200b2375u, 0x5821b139u, 0x573895edu, 0x887d14aeu, 0xaf44a8abu,
    0x8647a54au, 0xa61b308bu, 0xe79e924du, 0x7ae56f53u, 0xe685d33cu, 0x295c69dcu, 0x28f52e37u, 0x368f66f4u,
    0xa13f1941u, 0x4950d801u, 0xbb844cd1u, 0xa91259d0u, 0x8287c4c8u, 0x569fbc74u, 0xc66d64a4u, 0x4003baadu,
    0xfae2d934u, 0xca057b7cu, 0x7e769326u, 0xd45552ffu, 0xe33bcecfu, 0x113a102fu, 0x2a1cbdb6u, 0xd5aab7dfu,
    0x0298f877u, 0x46a39a2cu, 0x9b6599ddu, 0x09ac2ba7u, 0xfd271681u, 0x6e6c6213u, 0xe8e0714fu, 0x6870b9b2u,
    0xe461f6dau, 0xc1f222fbu, 0x0c90d2eeu, 0xf1a2b3bfu, 0xeb913351u, 0x6bef0ef9u, 0x1fd6c031u, 0x9d6ac7b5u,
    0xb0cc54b8u, 0x2d327973u, 0xfe96047fu, 0x5dcdec8au, 0x1d4372deu, 0x8df34818u, 0x424ec380u, 0xb49c3dd7u);

uint noise_permuted(uint i) {
    i &= 255u;
    return noise_words[i >> 2] >> (8u * (i & 3u)) & 255u;
}

float noise_gradient(uint x, uint y, uint z, vec3 d) {
    uint h = noise_permuted(noise_permuted(noise_permuted(x) + y) + z) & 15u;
    float u = h < 8u || h == 12u || h == 13u ? d.x : d.y;
    float v = h < 4u || h == 12u || h == 13u ? d.y : d.z;
    return ((h & 1u) != 0u ? -u : u) + ((h & 2u) != 0u ? -v : v);
}

// Within [-1, 1], 0 at integer points; period 256.
float noise(vec3 p) {
    vec3 base = floor(p), d = p - base;
    uvec3 i = uvec3(ivec3(base - 256.0 * floor(base / 256.0)));
    vec3 w = d * d * d * (d * (d * 6.0 - 15.0) + 10.0);
    float corner[8];
    for (uint k = 0u; k < 8u; ++k) {
        uvec3 o = uvec3(k & 1u, k >> 1 & 1u, k >> 2);
        corner[k] = noise_gradient((i.x + o.x) & 255u, (i.y + o.y) & 255u, (i.z + o.z) & 255u, d - vec3(o));
    }
    float y0 = mix(mix(corner[0], corner[1], w.x), mix(corner[2], corner[3], w.x), w.y);
    float y1 = mix(mix(corner[4], corner[5], w.x), mix(corner[6], corner[7], w.x), w.y);
    return mix(y0, y1, w.z);
}

// Number of octaves no finer than a pixel of width `footprint` in p's space.
float noise_octaves(float footprint, int most) {
    return clamp(-1.0 - log2(max(footprint, 1e-30)), 0.0, float(most));
}

// Fractional Brownian motion: octaves of noise, each `omega` times the previous one.
float noise_fbm(vec3 p, float footprint, float omega, int most) {
    float n = noise_octaves(footprint, most), whole = floor(n);
    float sum = 0.0, lambda = 1.0, o = 1.0;
    for (int i = 0; i < int(whole); ++i) {
        sum += o * noise(lambda * p);
        lambda *= 1.99;
        o *= omega;
    }
    return sum + o * smoothstep(0.3, 0.7, n - whole) * noise(lambda * p);
}

// Likewise of absolute values; omitted octaves count as their mean.
float noise_turbulence(vec3 p, float footprint, float omega, int most) {
    float n = noise_octaves(footprint, most), whole = floor(n);
    float sum = 0.0, lambda = 1.0, o = 1.0;
    for (int i = 0; i < int(whole); ++i) {
        sum += o * abs(noise(lambda * p));
        lambda *= 1.99;
        o *= omega;
    }
    sum += o * mix(0.2, abs(noise(lambda * p)), smoothstep(0.3, 0.7, n - whole));
    for (int i = int(whole); i < most; ++i) {
        sum += o * 0.2;
        o *= omega;
    }
    return sum;
}

#endif
