// SPDX-License-Identifier: Apache-2.0
// Wavefront: paths that left the scene see the environment.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "path/escape.glsl"

void main() {
    uint i = UintArray(push.queue).at[push.queue_first + gl_GlobalInvocationID.x];
    PathState path = PathArray(push.paths).at[i];
    RayArray rays = RayArray(push.rays);
    path_escape(wave_scene(), receiver_at(rays.at[i].origin, rays.at[i].receiver), rays.at[i].direction, path);
    PathArray(push.paths).at[i].radiance = path.radiance;
    RayArray(push.rays).at[i].tfar = -1.0;
}
