// SPDX-License-Identifier: Apache-2.0
// Wavefront: one path step for the queued hits of one material type. Composed: the material precedes this file.
#include "wave_common.glsl"
#include "lib/records.glsl"
#define EMISSION_APART 1 // by wave_emit.comp
#include "path/step.glsl"

void main() {
    uint i = UintArray(push.queue).at[push.queue_first + gl_GlobalInvocationID.x];
    SceneData scene = wave_scene();
    RayHit ray = load_ray(push.rays, i);
    address fourths = wave_fourths();
    PathState path = load_path(scene, push.paths, fourths, i);
    InstanceData inst = load_instance(push.instances, ray.inst);
    MaterialData material = load_material(push.materials, ray.geom);

    if (HAS_CAUSTICS) photons_begin(FrameRef(push.frame).frame.photons, ray.inst);

    StepRay shadow, next;
    Spectrum contribution;
    GuideSample guide;
    bool first = (path.flags & PATH_DEPTH_MASK) == 0u, guided = (path.flags & PATH_GUIDED) != 0u;
    bool ok = path_step(scene, inst, material, ray.prim, vec2(ray.u, ray.v), ray.tfar,
                        StepRay(ray.origin, ray.direction, ray.tfar, ray.tnear, 0u, ray.receiver), path, shadow, contribution, next, guide);
    if (!ok) {
        path.radiance = path.throughput = Spectrum(0);
        next.tmax = -1.0;
        count_not_finite(material.type, i);
    }
    if (HAS_GUIDES && first)
        guide_write(GuideArray(push.guides), i, guide);
    else if (HAS_GUIDES && guided)
        guide_write_behind(GuideArray(push.guides), i, guide);
    // Only changes are written, and their neighbours in a word; the rest stays as the tracer and wave_generate set it.
    WordPairs out_shadow = WordPairs(push.shadows + uint64_t(i) * 64ul);
    store(out_shadow, 4u, floatBitsToUint(shadow.tmax), ~0u);
    if (shadow.tmax > 0.0) {
        store(out_shadow, 0u, shadow.origin.x, shadow.origin.y);
        store(out_shadow, 1u, shadow.origin.z, 0.0);
        store(out_shadow, 2u, shadow.direction.x, shadow.direction.y);
        store(out_shadow, 3u, shadow.direction.z, 0.0);
        store(out_shadow, 6u, contribution.x, contribution.y);
        store(out_shadow, 7u, floatBitsToUint(contribution.z), shadow.medium);
#ifdef RESTAGE_SPECTRAL
        store(FOURTH_PAIRS(i), 1u, contribution.w, path_hero);
#endif
    }
    WordPairs out_ray = WordPairs(push.rays + uint64_t(i) * 80ul);
    store(out_ray, 4u, floatBitsToUint(next.tmax), ~0u);
    if (next.tmax > 0.0) {
        store(out_ray, 0u, next.origin.x, next.origin.y);
        store(out_ray, 1u, next.origin.z, next.tmin);
        store(out_ray, 2u, next.direction.x, next.direction.y);
        store(out_ray, 3u, next.direction.z, 0.0);
        store(out_ray, 5u, next.receiver, 0u);
    }
    if (HAS_CAUSTICS && (path.flags & PATH_PHOTON) != 0u) PhotonArray(photon_map.deposits).at[i] = photon_deposit;
    store_path(push.paths, fourths, i, path);
}
