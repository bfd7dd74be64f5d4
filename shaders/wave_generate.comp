// SPDX-License-Identifier: Apache-2.0
// Wavefront: camera rays of one wave, path state reset.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "path/begin.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    FrameData frame = FrameRef(push.frame).frame;
    if (i >= frame.pixel_count * frame.samples) return;
    uint pixel = frame.first_pixel + i % frame.pixel_count;
    uint sample_index = frame.first_sample + i / frame.pixel_count;
    RayHit r;
    PathState path = path_begin(SceneRef(frame.scene), frame, pixel, sample_index, r.origin, r.direction);
    r.tnear = 0.0;
    r.time = 0.0;
    r.tfar = INFINITE;
    r.mask = 0xffffffffu;
    r.id = 0u;
    r.flags = 0u;
    r.ng = vec3(0);
    r.u = r.v = 0.0;
    r.prim = r.geom = r.inst = NONE;
    RayArray(frame.rays).at[i] = r;
    ShadowArray(frame.shadows).at[i].tfar = -1.0;
    PathArray(frame.paths).at[i] = path;
    if (HAS_GUIDES) GuideArray(frame.guides).at[i] = GuideSample(vec3(0), vec3(0), 0.0, 0u, 0u, path.throughput.x, 0u);
}
