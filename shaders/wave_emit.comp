// SPDX-License-Identifier: Apache-2.0
// Wavefront: hits of surfaces that emit. Few paths hit one, but a shading kernel would do this for all of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "lib/records.glsl"
#include "lib/photons.glsl"
#include "path/emission.glsl"

void main() {
    uint i = UintArray(push.queue).at[push.queue_first + gl_GlobalInvocationID.x];
    SceneData scene = wave_scene();
    RayHit ray = load_ray(push.rays, i);
    address fourths = wave_fourths();
    PathState path = load_path(scene, push.paths, fourths, i);
    InstanceData inst = load_instance(push.instances, ray.inst);
    MaterialData material = load_material(push.materials, ray.geom);
    StepRay from = StepRay(ray.origin, ray.direction, ray.tfar, ray.tnear, 0u, ray.receiver);
    Surface s = surface_at(scene, inst, material, ray.prim, vec2(ray.u, ray.v), ray.tfar, from);
    if (HAS_MEDIA) path.throughput *= absorb_to_hit(scene, path.medium, ray.tfar, from);
    bool counts = true;
    if (HAS_CAUSTICS) counts = !left_to_photons(path.flags, UintArray(PhotonMapRef(FrameRef(push.frame).frame.photons).map.roles).at[ray.inst]);
    Spectrum before = path.radiance;
    float pdf_light = 0.0;
    if (counts) path.radiance += surface_emission(scene, inst, ray.prim, vec2(ray.u, ray.v), s, ray.tfar, from, path, pdf_light);
    note_light(i, path.radiance - before, path.pdf, pdf_light);
    if (!finite(path.radiance)) {
        path.radiance = path.throughput = Spectrum(0);
        count_not_finite(material.type, i);
    }
    store_light(push.paths, fourths, i, path);
}
