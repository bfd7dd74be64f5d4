// SPDX-License-Identifier: Apache-2.0
// The records that every path reads, loaded in 64-bit words.
#ifndef RESTAGE_LIB_RECORDS
#define RESTAGE_LIB_RECORDS
#include "lib/scene.glsl"
#include "lib/spectral.glsl"
#include "lib/words.glsl"
#include "shared/path_data.h"

RayHit load_ray(address rays, uint i) {
    WordPairs w = WordPairs(rays + uint64_t(i) * 80ul);
    vec2 a = floats_at(w, 0u), b = floats_at(w, 1u), c = floats_at(w, 2u), d = floats_at(w, 3u);
    uvec2 e = pair_at(w, 8u), f = pair_at(w, 9u);
    RayHit r;
    r.origin = vec3(a, b.x);
    r.tnear = b.y;
    r.direction = vec3(c, d.x);
    r.tfar = floats_at(w, 4u).x;
    r.receiver = pair_at(w, 5u).x;
    r.u = floats_at(w, 7u).y;
    r.v = uintBitsToFloat(e.x);
    r.prim = e.y;
    r.geom = f.x;
    r.inst = f.y;
    return r;
}

#ifdef RESTAGE_SPECTRAL
#define FOURTH_PAIRS(i) WordPairs(fourths + uint64_t(i) * 16ul)
#endif

// `fourths`: FourthData[]; not read in RGB mode. In spectral mode also begins the path's spectrum.
PathState load_path(SceneData scene, address paths, address fourths, uint i) {
    WordPairs w = WordPairs(paths + uint64_t(i) * 48ul);
    vec2 a = floats_at(w, 0u), b = floats_at(w, 1u), c = floats_at(w, 2u);
    uvec2 d = pair_at(w, 3u), e = pair_at(w, 4u), f = pair_at(w, 5u);
#ifdef RESTAGE_SPECTRAL
    vec2 fourth = floats_at(FOURTH_PAIRS(i), 0u);
    spectral_begin(scene, floats_at(FOURTH_PAIRS(i), 1u).y);
    Spectrum throughput = Spectrum(a, b.x, fourth.x), radiance = Spectrum(c, uintBitsToFloat(d.x), fourth.y);
#else
    Spectrum throughput = Spectrum(a, b.x), radiance = Spectrum(c, uintBitsToFloat(d.x));
#endif
    return PathState(throughput, b.y, radiance, d.y, uintBitsToFloat(e.x), e.y, f.x, f.y);
}

InstanceData load_instance(address instances, uint i) {
    WordPairs w = WordPairs(instances + uint64_t(i) * 184ul);
    vec2 m[12];
    for (uint k = 0u; k < 12u; ++k) m[k] = floats_at(w, k);
    InstanceData r;
    r.object_to_world = mat4x3(m[0], m[1], m[2], m[3], m[4], m[5]);
    r.normal_to_world = mat3(m[6], m[7], m[8], m[9], m[10].x);
    r.emission = vec3(m[10].y, m[11]);
    r.positions = w.at[12];
    r.normals = w.at[13];
    r.uvs = w.at[14];
    r.indices = w.at[15];
    uvec2 a = pair_at(w, 16u), b = pair_at(w, 17u), c = pair_at(w, 18u), d = pair_at(w, 19u);
    r.material = a.x;
    r.light_base = a.y;
    r.flags = b.x;
    r.alpha_texture = b.y;
    r.alpha = uintBitsToFloat(c.x);
    r.interior = c.y;
    r.exterior = d.x;
    r.object_id = d.y;
    r.emission_texture = pair_at(w, 20u).x;
    r.tangents = w.at[21];
    r.uvs2 = w.at[22];
    return r;
}

MaterialData load_material(address materials, uint i) {
    WordPairs w = WordPairs(materials + uint64_t(i) * 32ul);
    uvec2 a = pair_at(w, 0u), b = pair_at(w, 1u), c = pair_at(w, 2u), d = pair_at(w, 3u);
    return MaterialData(a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y);
}

void store(WordPairs words, uint k, uint x, uint y) { words.at[k] = packUint2x32(uvec2(x, y)); }
void store(WordPairs words, uint k, float x, float y) { store(words, k, floatBitsToUint(x), floatBitsToUint(y)); }

// Throughput and radiance.
void store_light(address paths, address fourths, uint i, PathState path) {
    WordPairs out_path = WordPairs(paths + uint64_t(i) * 48ul);
    store(out_path, 0u, path.throughput.x, path.throughput.y);
    store(out_path, 1u, path.throughput.z, path.pdf);
    store(out_path, 2u, path.radiance.x, path.radiance.y);
    store(out_path, 3u, floatBitsToUint(path.radiance.z), path.flags);
#ifdef RESTAGE_SPECTRAL
    store(FOURTH_PAIRS(i), 0u, path.throughput.w, path.radiance.w);
#endif
}
// All but seed and sample_index, which never change.
void store_path(address paths, address fourths, uint i, PathState path) {
    store_light(paths, fourths, i, path);
    store(WordPairs(paths + uint64_t(i) * 48ul), 4u, floatBitsToUint(path.eta_scale), path.medium);
}
// Those, and the wavelengths: by `hero`, or if it is negative the path's own.
void store_begin(address paths, address fourths, uint i, PathState path, float hero) {
    store(WordPairs(paths + uint64_t(i) * 48ul), 5u, path.seed, path.sample_index);
#ifdef RESTAGE_SPECTRAL
    store(FOURTH_PAIRS(i), 1u, 0.0, hero < 0.0 ? hero_number(path.seed, path.sample_index) : hero);
#endif
}

#endif
