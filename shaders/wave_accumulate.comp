// SPDX-License-Identifier: Apache-2.0
// Wavefront: adds the wave's samples to the film.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "lib/records.glsl"

void main() {
    uint p = gl_GlobalInvocationID.x;
    FrameData frame = FrameRef(push.frame).frame;
    if (p >= frame.pixel_count) return;
    uint pixel = frame.first_pixel + p;
    SceneData scene = SceneRef(frame.scene).scene;
    FilmPixel f = FilmArray(frame.film).at[pixel];
    uint dropped = 0u;
    for (uint s = 0u; s < frame.samples; ++s) {
        PathState path = load_path(scene, frame.paths, frame.fourths, s * frame.pixel_count + p);
        if (!film_add(f, rgb_from_spectrum(path.radiance))) ++dropped;
    }
    if (dropped > 0u) atomicAdd(CounterArray(frame.counters).at[COUNTER_FILM], dropped);
    FilmArray(frame.film).at[pixel] = f;
    if (HAS_GUIDES) {
        GuidePixel g = GuidePixelArray(frame.film_guides).at[pixel];
        for (uint s = 0u; s < frame.samples; ++s) guide_add(g, GuideArray(frame.guides).at[s * frame.pixel_count + p]);
        GuidePixelArray(frame.film_guides).at[pixel] = g;
    }
}
