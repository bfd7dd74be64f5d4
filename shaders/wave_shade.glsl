// SPDX-License-Identifier: Apache-2.0
// Wavefront: one path step for the queued hits of one material type. Composed: the material precedes this file.
#include "wave_common.glsl"
#include "path/step.glsl"

void main() {
    if (gl_GlobalInvocationID.x >= push.queue_count) return;
    uint i = UintArray(push.queue).at[push.queue_first + gl_GlobalInvocationID.x];
    SceneData scene = wave_scene();
    RayHit ray = RayArray(push.rays).at[i];
    PathState path = PathArray(push.paths).at[i];
    InstanceData inst = InstanceArray(scene.instances).at[ray.inst];
    MaterialData material = MaterialArray(scene.materials).at[ray.geom];

    StepRay shadow, next;
    vec3 contribution;
    GuideSample guide;
    bool first = (path.flags & PATH_DEPTH_MASK) == 0u, guided = (path.flags & PATH_GUIDED) != 0u;
    bool ok = path_step(scene, inst, material, ray.prim, vec2(ray.u, ray.v), ray.tfar,
                        StepRay(ray.origin, ray.direction, ray.tfar, ray.tnear, 0u), path, shadow, contribution, next, guide);
    if (!ok) {
        path.radiance = vec3(0);
        path.throughput = vec3(0);
        next.tmax = -1.0;
        atomicAdd(CounterArray(FrameRef(push.frame).frame.counters).at[min(material.type, uint(COUNTER_MAX_TYPES - 1))], 1u);
    }
    if (HAS_GUIDES && first)
        guide_write(GuideArray(push.guides), i, guide);
    else if (HAS_GUIDES && guided)
        guide_write_behind(GuideArray(push.guides), i, guide);
    // Only changes are written, the rest stays as the tracer and wave_generate set it.
    ShadowArray shadows = ShadowArray(push.shadows);
    shadows.at[i].tfar = shadow.tmax;
    if (shadow.tmax > 0.0) {
        shadows.at[i].origin = shadow.origin;
        shadows.at[i].direction = shadow.direction;
        shadows.at[i].contribution = contribution;
        if (HAS_BORDERS) shadows.at[i].medium = shadow.medium;
    }
    RayArray rays = RayArray(push.rays);
    rays.at[i].tfar = next.tmax;
    if (HAS_GLOW) rays.at[i].tnear = next.tmin;
    if (next.tmax > 0.0) {
        rays.at[i].origin = next.origin;
        rays.at[i].direction = next.direction;
    }
    PathArray paths = PathArray(push.paths);
    paths.at[i].throughput = path.throughput;
    paths.at[i].pdf = path.pdf;
    paths.at[i].radiance = path.radiance;
    paths.at[i].flags = path.flags;
    paths.at[i].eta_scale = path.eta_scale;
    if (HAS_MEDIA) paths.at[i].medium = path.medium;
}
