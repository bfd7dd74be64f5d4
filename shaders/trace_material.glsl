// SPDX-License-Identifier: Apache-2.0
// Ray-tracing pipeline: one path step at a hit of one material type, as a callable. Composed: the material precedes
// this file.
#include "trace_common.glsl"
#include "path/step.glsl"

layout(location = 1) callableDataInEXT StepPayload io;

void main() {
    FrameData frame = FrameRef(push.frame).frame;
    SceneData scene = SceneRef(frame.scene).scene;
    InstanceData inst = InstanceArray(scene.instances).at[io.instance];
    MaterialData material = MaterialArray(scene.materials).at[io.material];
    StepRay shadow, next;
    Spectrum contribution;
    GuideSample guide;
    PathState path = io.path;
#ifdef RESTAGE_SPECTRAL
    spectral_begin(scene, hero_number(path.seed, path.sample_index));
#endif
    bool first = (path.flags & PATH_DEPTH_MASK) == 0u, guided = (path.flags & PATH_GUIDED) != 0u;
    bool ok = path_step(scene, inst, material, io.prim, io.bary, io.t,
                        StepRay(io.origin, io.direction, io.t, io.tmin, 0u, io.receiver), path, shadow, contribution, next, guide);
    if (!ok) {
        path.radiance = path.throughput = Spectrum(0);
        next.tmax = -1.0;
        atomicAdd(CounterArray(frame.counters).at[min(material.type, uint(COUNTER_MAX_TYPES - 1))], 1u);
    }
    if (HAS_GUIDES && guided && !(HAS_GLOW && guide.weight < 0.0)) { // here, to keep albedo and normal out of the payload
        uint pixel = launch_pick(frame).pixel;
        GuidePixel g = GuidePixelArray(frame.film_guides).at[pixel];
        if (first) guide_add(g, guide);
        else guide_add_behind(g, guide);
        GuidePixelArray(frame.film_guides).at[pixel] = g;
    }
    io.path = path;
    io.t = next.tmax;
    io.tmin = next.tmin;
    io.receiver = next.receiver;
    io.origin = next.origin;
    io.direction = next.direction;
    io.shadow_origin = shadow.origin;
    io.shadow_direction = shadow.direction;
    io.shadow_tmax = shadow.tmax;
    io.shadow_contribution = contribution;
    if (HAS_BORDERS) io.shadow_medium = shadow.medium;
}
