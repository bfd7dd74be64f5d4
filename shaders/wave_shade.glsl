// SPDX-License-Identifier: Apache-2.0
// Wavefront: one path step for the queued hits of one material type. Composed: the material stands before this file.
#include "wave_common.glsl"
#include "path/step.glsl"

void main() {
    if (gl_GlobalInvocationID.x >= push.queue_count) return;
    FrameData frame = FrameRef(push.frame).frame;
    uint i = UintArray(frame.queue).at[push.queue_first + gl_GlobalInvocationID.x];
    SceneData scene = SceneRef(frame.scene).scene;
    RayHit ray = RayArray(frame.rays).at[i];
    PathState path = PathArray(frame.paths).at[i];
    InstanceData inst = InstanceArray(scene.instances).at[ray.inst];
    MaterialData material = MaterialArray(scene.materials).at[ray.geom];

    StepRay shadow, next;
    vec3 contribution;
    GuideSample guide;
    bool first = (path.flags & PATH_DEPTH_MASK) == 0u;
    bool ok = path_step(scene, inst, material, ray.prim, vec2(ray.u, ray.v), ray.tfar, ray.direction, path, shadow,
                        contribution, next, guide);
    if (!ok) {
        path.radiance = vec3(0);
        path.throughput = vec3(0);
        next.tmax = -1.0;
        atomicAdd(CounterArray(frame.counters).at[min(material.type, uint(COUNTER_MAX_TYPES - 1))], 1u);
    }
    if (HAS_GUIDES && first) {
        guide.weight = GuideArray(frame.guides).at[i].weight;
        guide.pad0 = 0u;
        GuideArray(frame.guides).at[i] = guide;
    }
    ShadowArray shadows = ShadowArray(frame.shadows);
    shadows.at[i].tfar = shadow.tmax;
    if (shadow.tmax > 0.0) {
        shadows.at[i].origin = shadow.origin;
        shadows.at[i].tnear = 0.0;
        shadows.at[i].direction = shadow.direction;
        shadows.at[i].time = 0.0;
        shadows.at[i].mask = 0xffffffffu;
        shadows.at[i].flags = 0u;
        shadows.at[i].contribution = contribution;
    }
    RayArray rays = RayArray(frame.rays);
    rays.at[i].tfar = next.tmax;
    if (next.tmax > 0.0) {
        rays.at[i].origin = next.origin;
        rays.at[i].direction = next.direction;
        rays.at[i].geom = NONE;
        rays.at[i].inst = NONE;
    }
    PathArray(frame.paths).at[i] = path;
}
