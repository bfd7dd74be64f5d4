// SPDX-License-Identifier: Apache-2.0
// Wavefront: the wave's samples into the film: sums and sums of squares, so that every image knows its own error.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
#include "wave_common.glsl"
#include "lib/bsdf.glsl"

void main() {
    uint p = gl_GlobalInvocationID.x;
    FrameData frame = FrameRef(push.frame).frame;
    if (p >= frame.pixel_count) return;
    uint pixel = frame.first_pixel + p;
    PathArray paths = PathArray(frame.paths);
    FilmPixel f = FilmArray(frame.film).at[pixel];
    for (uint s = 0u; s < frame.samples; ++s) {
        vec3 c = paths.at[s * frame.pixel_count + p].radiance;
        if (any(isnan(c)) || any(isinf(c))) continue; // counted where it arose; nothing unnatural reaches the film
        f.sum += c;
        f.sum_sq += c * c;
        f.sum_sq_luminance += sqr(luminance(c));
        f.count += 1.0;
    }
    FilmArray(frame.film).at[pixel] = f;
    if (HAS_GUIDES) {
        GuidePixel g = GuidePixelArray(frame.film_guides).at[pixel];
        for (uint s = 0u; s < frame.samples; ++s) {
            GuideSample a = GuideArray(frame.guides).at[s * frame.pixel_count + p];
            if (g.count == 0.0) {
                g.instance_id = a.instance_id;
                g.material_id = a.material_id;
            }
            g.albedo += a.albedo;
            g.normal += a.normal;
            g.depth += a.depth;
            g.count += 1.0;
        }
        GuidePixelArray(frame.film_guides).at[pixel] = g;
    }
}
