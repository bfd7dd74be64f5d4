// SPDX-License-Identifier: Apache-2.0
// The start of a path: the camera ray of one sample of one pixel, and its initial state.
#ifndef RESTAGE_PATH_BEGIN
#define RESTAGE_PATH_BEGIN
#include "lib/camera.glsl"
#include "lib/sampler.glsl"
#include "shared/path_data.h"
#include "shared/twins.h"

// pixel: of the film, row by row, also those of its twins. The path's throughput is the weight of the pixel filter.
PathState path_begin(SceneRef scene, FrameData frame, uint pixel, uint sample_index, out vec3 origin, out vec3 direction) {
    uvec2 xy = uvec2(pixel % frame.crop_width, pixel / frame.crop_width);
    bool twin = xy.y >= frame.crop_height;
    if (twin) xy.y = twin_of(xy.x, xy.y - frame.crop_height, frame.crop_height);
    xy += uvec2(frame.crop_x, frame.crop_y);
    uint seed = pixel_seed(xy, twin, frame.seed);
    float weight;
    vec2 offset = filter_sample(scene.scene.filter_, sample_pair(seed, sample_index, PAIR_FILTER), weight);
    vec2 u_lens = HAS_LENS ? sample_pair(seed, sample_index, PAIR_LENS) : vec2(0.5);
    camera_ray(scene.scene.camera, vec2(xy) + 0.5 + offset, u_lens, origin, direction);
    return PathState(Spectrum(weight), 0.0, Spectrum(0), PATH_SPECULAR | PATH_GUIDED, 1.0, scene.scene.camera_medium, seed, sample_index);
}

#endif
