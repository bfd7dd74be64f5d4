// SPDX-License-Identifier: Apache-2.0
// Wavefront: paths that left the scene see the environment.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "lib/records.glsl"
#include "lib/photons.glsl"
#include "path/escape.glsl"

void main() {
    uint i = UintArray(push.queue).at[push.queue_first + gl_GlobalInvocationID.x];
    SceneData scene = wave_scene();
    address fourths = wave_fourths();
    RayArray rays = RayArray(push.rays);
    PathState path = load_path(scene, push.paths, fourths, i);
    bool counts = true;
    if (HAS_CAUSTICS) counts = !left_to_photons(path.flags, PhotonMapRef(FrameRef(push.frame).frame.photons).map.environment);
    Spectrum before = path.radiance;
    float pdf_light = 0.0;
    if (counts) path_escape(scene, receiver_at(rays.at[i].origin, rays.at[i].receiver), rays.at[i].direction, path, pdf_light);
    note_light(i, path.radiance - before, path.pdf, pdf_light);
    store_light(push.paths, fourths, i, path);
    RayArray(push.rays).at[i].tfar = -1.0;
}
