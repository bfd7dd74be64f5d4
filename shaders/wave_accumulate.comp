// SPDX-License-Identifier: Apache-2.0
// Wavefront: adds the wave's samples to the film.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "lib/records.glsl"
#include "path/catcher.glsl"

void main() {
    FrameData frame = FrameRef(push.frame).frame;
    if (gl_GlobalInvocationID.x >= frame.run_count) return;
    SampleRun run = RunArray(frame.runs).at[gl_GlobalInvocationID.x];
    SceneData scene = SceneRef(frame.scene).scene;
    FilmPixel f = FilmArray(frame.film).at[run.pixel];
    uint dropped = 0u;
    vec3 shade = vec3(0);
    float caught = 0.0;
    for (uint s = 0u; s < run.count; ++s) {
        PathState path = load_path(scene, frame.paths, frame.fourths, run.first + s);
        vec3 radiance = rgb_from_spectrum(path.radiance);
        if (!film_add(f, radiance)) ++dropped;
        else if (is_caught(path)) {
            shade += radiance;
            caught += 1.0;
        }
    }
    if (dropped > 0u) atomicAdd(CounterArray(frame.counters).at[COUNTER_FILM], dropped);
    FilmArray(frame.film).at[run.pixel] = f;
    if (HAS_GUIDES) {
        GuidePixel g = GuidePixelArray(frame.film_guides).at[run.pixel];
        for (uint s = 0u; s < run.count; ++s) guide_add(g, GuideArray(frame.guides).at[run.first + s]);
        if (HAS_CATCHERS) guide_add_caught(g, shade, caught);
        GuidePixelArray(frame.film_guides).at[run.pixel] = g;
    }
}
