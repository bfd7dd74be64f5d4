// SPDX-License-Identifier: Apache-2.0
// Loads in 64-bit words. On lavapipe a load through an address is a test and a move per lane, whatever its width, and
// most of a kernel's time goes there; other devices merge loads by themselves.
#ifndef RESTAGE_LIB_WORDS
#define RESTAGE_LIB_WORDS
#include "shared/scene_data.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer WordPairs { uint64_t at[]; };

uvec2 pair_at(WordPairs words, uint k) { return unpackUint2x32(words.at[k]); }
vec2 floats_at(WordPairs words, uint k) { return uintBitsToFloat(pair_at(words, k)); }

// Element k of an array of three words each. Two aligned pairs always cover it, and reach up to four bytes beyond it.
uvec3 uvec3_at(address array, uint k) {
    WordPairs w = WordPairs(array);
    uint pair = (3u * k) >> 1;
    uvec2 a = pair_at(w, pair), b = pair_at(w, pair + 1u);
    return (k & 1u) == 0u ? uvec3(a, b.x) : uvec3(a.y, b);
}
vec3 vec3_at(address array, uint k) { return uintBitsToFloat(uvec3_at(array, k)); }
vec2 vec2_at(address array, uint k) { return floats_at(WordPairs(array), k); }

LightData load_light(address lights, uint i) {
    WordPairs w = WordPairs(lights + uint64_t(i) * 72ul);
    vec2 a = floats_at(w, 0u), b = floats_at(w, 2u), c = floats_at(w, 4u), d = floats_at(w, 6u), e = floats_at(w, 7u);
    uvec2 a2 = pair_at(w, 1u), ids = pair_at(w, 8u);
    vec2 b2 = floats_at(w, 3u), c2 = floats_at(w, 5u);
    return LightData(vec3(a, uintBitsToFloat(a2.x)), a2.y, vec3(b, b2.x), b2.y, vec3(c, c2.x), c2.y, vec3(d, e.x), e.y,
                     ids.x, ids.y);
}

#endif
