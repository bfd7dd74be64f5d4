// SPDX-License-Identifier: Apache-2.0
// Wavefront: adds the wave's samples to the film.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "lib/records.glsl"

void main() {
    FrameData frame = FrameRef(push.frame).frame;
    if (gl_GlobalInvocationID.x >= frame.run_count) return;
    SampleRun run = RunArray(frame.runs).at[gl_GlobalInvocationID.x];
    SceneData scene = SceneRef(frame.scene).scene;
    FilmPixel f = FilmArray(frame.film).at[run.pixel];
    uint dropped = 0u;
    for (uint s = 0u; s < run.count; ++s) {
        PathState path = load_path(scene, frame.paths, frame.fourths, run.first + s);
        if (!film_add(f, rgb_from_spectrum(path.radiance))) ++dropped;
    }
    if (dropped > 0u) atomicAdd(CounterArray(frame.counters).at[COUNTER_FILM], dropped);
    FilmArray(frame.film).at[run.pixel] = f;
    if (HAS_GUIDES) {
        GuidePixel g = GuidePixelArray(frame.film_guides).at[run.pixel];
        for (uint s = 0u; s < run.count; ++s) guide_add(g, GuideArray(frame.guides).at[run.first + s]);
        GuidePixelArray(frame.film_guides).at[run.pixel] = g;
    }
}
