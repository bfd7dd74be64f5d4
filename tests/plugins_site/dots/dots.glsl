// SPDX-License-Identifier: Apache-2.0
// A material that needs its Site: a solid procedural, filtered by the footprint, and the Site's values.
#include <restage/v1/sampling.glsl>
#include <restage/v1/site.glsl>

const int dots_footprint = 1, dots_uv = 2, dots_duv = 3, dots_normal = 4, dots_object = 5, dots_world = 6, dots_dp = 7;

// The mean of a line of alternating ones and zeros over [x - width / 2, x + width / 2].
float dots_line(float x, float width) {
    vec2 ends = x + 0.5 * max(width, 1e-4) * vec2(-1, 1);
    vec2 sums = floor(0.5 * ends) + max(2.0 * fract(0.5 * ends) - 1.0, vec2(0));
    return (sums.y - sums.x) / (ends.y - ends.x);
}

Spectrum dots_color(dots_Params m, Site site) {
    vec3 numbers = vec3(0);
    if (m.what == dots_footprint) numbers = vec3(site.footprint);
    if (m.what == dots_uv) numbers = vec3(site.uv, 0.0);
    if (m.what == dots_duv) numbers = abs(vec3(site.duv_dx.x, site.duv_dy.y, 0.0));
    if (m.what == dots_normal) numbers = 0.5 + 0.5 * site.normal;
    if (m.what == dots_object) numbers = vec3(site.object >> 8) / 16777216.0;
    if (m.what == dots_world) numbers = fract(site.world);
    if (m.what == dots_dp) numbers = vec3(length(site.dp_dx), length(site.dp_dy), 0.0);
    if (m.what != 0)
        return spectrum_from_rgb(clamp(numbers / m.size, 0.0, 1.0));
    vec3 width = max(abs(site.dp_dx), abs(site.dp_dy)) / m.size;
    vec3 at = site.position / m.size;
    vec3 s = 1.0 - 2.0 * vec3(dots_line(at.x, width.x), dots_line(at.y, width.y), dots_line(at.z, width.z));
    return clamp(mix(m.odd, m.even, 0.5 + 0.5 * s.x * s.y * s.z), Spectrum(0), Spectrum(1));
}

Spectrum dots_eval(dots_Params m, Site site, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? dots_color(m, site) * (INV_PI * abs_cos(wi)) : Spectrum(0);
}
float dots_pdf(dots_Params m, Site site, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? cosine_hemisphere_pdf(abs_cos(wi)) : 0.0;
}
BsdfSample dots_sample(dots_Params m, Site site, vec3 wo, vec3 u) {
    vec3 wi = sample_cosine_hemisphere(u.xy);
    float pdf = cosine_hemisphere_pdf(wi.z);
    if (!positive(pdf) || wo.z == 0.0)
        return BSDF_NONE;
    if (wo.z < 0.0)
        wi.z = -wi.z;
    return BsdfSample(wi, dots_color(m, site), pdf, BSDF_REFLECT, 1.0);
}
Spectrum dots_albedo(dots_Params m, Site site, vec3 wo) { return dots_color(m, site); }
