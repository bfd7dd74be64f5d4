// SPDX-License-Identifier: Apache-2.0
// Wavefront: camera rays of one wave, path state reset.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "lib/photons.glsl"
#include "lib/records.glsl"
#include "path/begin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    FrameData frame = FrameRef(push.frame).frame;
    SamplePick pick = PickArray(frame.picks).at[i];
    vec3 origin, direction;
    PathState path = path_begin(SceneRef(frame.scene), frame, pick.pixel, pick.sample_index, origin, direction);
    RayArray rays = RayArray(frame.rays); // a ray's other fields never change, or Embree writes them
    rays.at[i].origin = origin;
    rays.at[i].direction = direction;
    rays.at[i].tfar = INFINITE;
    rays.at[i].tnear = 0.0;
    ShadowArray(frame.shadows).at[i].tfar = -1.0;
    store_path(frame.paths, frame.fourths, i, path);
    float hero = -1.0;
    uint nth;
    if (HAS_CAUSTICS) hero = photon_run(PhotonMapRef(frame.photons).map, pick.sample_index, nth).hero;
    store_begin(frame.paths, frame.fourths, i, path, hero);
    if (HAS_GUIDES) GuideArray(frame.guides).at[i] = guide_nothing(path.throughput.x);
}
