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
    PathState path = load_path(push.paths, i);
    InstanceData inst = load_instance(push.instances, ray.inst);
    MaterialData material = load_material(push.materials, ray.geom);

    StepRay shadow, next;
    vec3 contribution;
    GuideSample guide;
    bool first = (path.flags & PATH_DEPTH_MASK) == 0u, guided = (path.flags & PATH_GUIDED) != 0u;
    bool ok = path_step(scene, inst, material, ray.prim, vec2(ray.u, ray.v), ray.tfar,
                        StepRay(ray.origin, ray.direction, ray.tfar, ray.tnear, 0u, ray.receiver), path, shadow, contribution, next, guide);
    if (!ok) {
        path.radiance = vec3(0);
        path.throughput = vec3(0);
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
    }
    WordPairs out_ray = WordPairs(push.rays + uint64_t(i) * 80ul);
    store(out_ray, 4u, floatBitsToUint(next.tmax), ~0u);
    if (next.tmax > 0.0) {
        store(out_ray, 0u, next.origin.x, next.origin.y);
        store(out_ray, 1u, next.origin.z, next.tmin);
        store(out_ray, 2u, next.direction.x, next.direction.y);
        store(out_ray, 3u, next.direction.z, 0.0);
        if (LIGHT_ROOTS > 1u) store(out_ray, 5u, next.receiver, 0u);
    }
    WordPairs out_path = WordPairs(push.paths + uint64_t(i) * 48ul);
    store(out_path, 0u, path.throughput.x, path.throughput.y);
    store(out_path, 1u, path.throughput.z, path.pdf);
    store(out_path, 2u, path.radiance.x, path.radiance.y);
    store(out_path, 3u, floatBitsToUint(path.radiance.z), path.flags);
    store(out_path, 4u, floatBitsToUint(path.eta_scale), path.medium);
}
