// SPDX-License-Identifier: Apache-2.0
// Buffer types behind a frame's addresses, and adding samples to the film: sums and sums of squares, so that every image knows
// its own error.
#ifndef RESTAGE_PATH_FILM
#define RESTAGE_PATH_FILM
#include <restage/v1/bsdf.glsl>
#include "lib/scene.glsl"
#include "shared/path_data.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer FrameRef { FrameData frame; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FilmArray { FilmPixel at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer GuidePixelArray { GuidePixel at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer GuideArray { GuideSample at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer PickArray { SamplePick at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RunArray { SampleRun at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer CounterArray { uint at[]; };

const float INFINITE = 1e30;

// Larger values would overflow the sums of squares. A radiance of 1e16 means a broken file.
const float FILM_LARGEST = 1e16;

// Compensated sums: `excess` is what rounding has added so far. Without it the mean of 2^20 equal samples is off by 1 %.
// Kahan 1965, "Pracniques: Further Remarks on Reducing Truncation Errors".
void add_compensated(inout vec3 sum, inout vec3 excess, vec3 x) {
    precise vec3 y = x - excess;
    precise vec3 total = sum + y;
    precise vec3 rounded = (total - sum) - y;
    sum = total;
    excess = rounded;
}
void add_compensated(inout float sum, inout float excess, float x) {
    precise float y = x - excess;
    precise float total = sum + y;
    precise float rounded = (total - sum) - y;
    sum = total;
    excess = rounded;
}

// A sample that is non-finite or too large counts as black and returns false: nothing invalid reaches the film.
bool film_add(inout FilmPixel f, vec3 c) {
    bool fits = finite(c) && all(lessThanEqual(abs(c), vec3(FILM_LARGEST)));
    if (!fits) c = vec3(0);
    add_compensated(f.sum, f.excess, c);
    add_compensated(f.sum_sq, f.excess_sq, c * c);
    add_compensated(f.sum_sq_luminance, f.excess_sq_luminance, sqr(luminance(c)));
    f.count += 1.0;
    return fits;
}

// For a sample that hits nothing. weight: of the pixel filter; < 0: this surface is not a guide.
GuideSample guide_nothing(float weight) {
    GuideSample g;
    g.albedo = g.normal = g.without = g.backdrop = vec3(0);
    g.depth = g.coverage = 0.0;
    g.instance_id = g.material_id = 0u;
    g.weight = weight;
    return g;
}
// Field by field: all but the weight, already set; and, behind mirrors and glass, the fields seen through them.
void guide_write(GuideArray guides, uint i, GuideSample g) {
    guides.at[i].albedo = g.albedo;
    guides.at[i].normal = g.normal;
    guides.at[i].depth = g.depth;
    guides.at[i].instance_id = g.instance_id;
    guides.at[i].material_id = g.material_id;
    guides.at[i].coverage = g.coverage;
    if (HAS_CATCHERS) {
        guides.at[i].without = g.without;
        guides.at[i].backdrop = g.backdrop;
    }
}
void guide_write_behind(GuideArray guides, uint i, GuideSample g) {
    guides.at[i].albedo = g.albedo;
    guides.at[i].normal = g.normal;
}

void guide_add(inout GuidePixel g, GuideSample a) {
    if (g.count == 0.0) {
        g.instance_id = a.instance_id;
        g.material_id = a.material_id;
    }
    g.albedo += a.albedo;
    g.normal += a.normal;
    g.depth += a.depth;
    g.coverage += a.coverage;
    if (HAS_CATCHERS) {
        g.without += a.without;
        g.backdrop += a.backdrop;
    }
    g.count += 1.0;
}
// radiance: of `count` paths that began at a catcher, which is their L_with - L_without (path/catcher.glsl).
void guide_add_caught(inout GuidePixel g, vec3 radiance, float count) {
    g.shade += radiance;
    g.caught += count;
}
// Behind mirrors and glass: for a sample that guide_add has counted.
void guide_add_behind(inout GuidePixel g, GuideSample a) {
    g.albedo += a.albedo;
    g.normal += a.normal;
}

#endif
