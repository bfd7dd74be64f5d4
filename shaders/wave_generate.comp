// SPDX-License-Identifier: Apache-2.0
// Wavefront: camera rays of one wave, path state reset.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "lib/camera.glsl"
#include "lib/sampler.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    FrameData frame = FrameRef(push.frame).frame;
    if (i >= frame.pixel_count * frame.samples) return;
    uint pixel = frame.first_pixel + i % frame.pixel_count;
    uint sample_index = frame.first_sample + i / frame.pixel_count;
    uvec2 xy = uvec2(frame.crop_x + pixel % frame.crop_width, frame.crop_y + pixel / frame.crop_width);
    SceneRef scene = SceneRef(frame.scene);
    uint seed = pixel_seed(xy.y * scene.scene.camera.width + xy.x, frame.seed);

    float weight;
    vec2 offset = filter_sample(scene.scene.filter_, sample_pair(seed, sample_index, PAIR_FILTER), weight);
    vec3 o, d;
    camera_ray(scene.scene.camera, vec2(xy) + 0.5 + offset, HAS_LENS ? sample_pair(seed, sample_index, PAIR_LENS) : vec2(0.5), o, d);

    RayHit r;
    r.origin = o;
    r.tnear = 0.0;
    r.direction = d;
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
    PathArray(frame.paths).at[i] =
        PathState(vec3(weight), 0.0, vec3(0), PATH_SPECULAR, 1.0, scene.scene.camera_medium, seed, sample_index);
    if (HAS_GUIDES) GuideArray(frame.guides).at[i] = GuideSample(vec3(0), vec3(0), 0.0, 0u, 0u, weight, 0u);
}
