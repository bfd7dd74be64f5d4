// SPDX-License-Identifier: Apache-2.0
// A tabulated isotropic BRDF in half and difference angles (Rusinkiewicz 1998; Matusik et al. 2003). merl.h describes
// the table's layout, README.md its meaning. Both sides reflect.
#include <restage/v1/sampling.glsl>
#include <restage/v1/table.glsl>

const uint measured_head = 4u;
const uint measured_row_head = 4u;

uvec3 measured_counts(measured_Params m) {
    return uvec3(table_word(m.filename, 0u), table_word(m.filename, 1u), table_word(m.filename, 2u));
}
uint measured_row_words(measured_Params m) { return measured_row_head + 2u * table_word(m.filename, 0u) + 1u; }

// The row that samples this wo: see merl.h.
uint measured_row(measured_Params m, vec3 wo) {
    uint rows = table_word(m.filename, 3u);
    float theta = atan(length(wo.xy), wo.z);
    uint row = min(uint(theta * (2.0 * INV_PI) * float(rows)), max(rows, 1u) - 1u);
    return measured_head + row * measured_row_words(m);
}

vec3 measured_entry(measured_Params m, uint first, uvec3 n, ivec3 at) {
    uint i = first + 3u * ((uint(at.x) * n.y + uint(at.y)) * n.z + uint(at.z));
    return vec3(table_float(m.filename, i), table_float(m.filename, i + 1u), table_float(m.filename, i + 2u));
}

// The BRDF, wo and wi above. Angles by their tangents: near the peak an arc cosine loses all precision.
Spectrum measured_brdf(measured_Params m, vec3 wo, vec3 wi) {
    uvec3 n = measured_counts(m);
    vec3 h = wo + wi, d = wi - wo;
    float h_xy = length(h.xy);
    float theta_h = atan(h_xy, h.z);
    float theta_d = atan(length(d), length(h));
    vec2 e = h_xy > 0.0 ? h.xy / h_xy : vec2(1, 0);
    float along = cos(theta_h) * dot(d.xy, e) - sin(theta_h) * d.z;
    float across = dot(d.xy, vec2(-e.y, e.x));
    float phi_d = atan(across, along);
    if (phi_d < 0.0)
        phi_d += PI; // reciprocity: phi and phi + pi are the same
    vec3 x = vec3(n) * vec3(sqrt(theta_h * (2.0 * INV_PI)), theta_d * (2.0 * INV_PI), phi_d * INV_PI) - 0.5;
    x.xy = clamp(x.xy, vec2(0), vec2(n.xy) - 1.0);
    ivec3 lower = ivec3(floor(x));
    vec3 f = x - vec3(lower);
    ivec3 upper = min(lower + 1, ivec3(n) - 1);
    int around = int(max(n.z, 1u));
    lower.z = (lower.z + around) % around;
    upper.z = (lower.z + 1) % around;
    uint first = measured_head + table_word(m.filename, 3u) * measured_row_words(m);
    vec3 sum = vec3(0), measured = vec3(0); // RGB, as in the table; unmeasured entries have no weight
    for (int k = 0; k < 8; ++k) {
        bvec3 up = bvec3((k & 1) != 0, (k & 2) != 0, (k & 4) != 0);
        vec3 w = mix(1.0 - f, f, up);
        vec3 value = measured_entry(m, first, n, ivec3(up.x ? upper.x : lower.x, up.y ? upper.y : lower.y,
                                                       up.z ? upper.z : lower.z));
        vec3 weight = w.x * w.y * w.z * step(vec3(0), value);
        sum += weight * value;
        measured += weight;
    }
    return spectrum_from_rgb_unbounded(sum / max(measured, vec3(1e-30)));
}

vec3 measured_up(vec3 w) { return vec3(w.xy, abs(w.z)); }

// 1 - cos(theta_h) at an edge of a bin.
float measured_edge(uint bin, uint n) { return 2.0 * sqr(sin(0.25 * PI * sqr(float(bin) / float(n)))); }

// Density of half vectors of a row [1/sr].
float measured_half_density(measured_Params m, uint row, float theta_h) {
    uint n = max(table_word(m.filename, 0u), 1u);
    uint bin = min(uint(float(n) * sqrt(theta_h * (2.0 * INV_PI))), n - 1u), at = row + measured_row_head + n + bin;
    float lower = measured_edge(bin, n), t = (2.0 * sqr(sin(0.5 * theta_h)) - lower) / (measured_edge(bin + 1u, n) - lower);
    return mix(table_float(m.filename, at), table_float(m.filename, at + 1u), clamp(t, 0.0, 1.0));
}

// Density of sampling wi, both above: half vectors of a row, and the cosine.
float measured_density(measured_Params m, vec3 wo, vec3 wi) {
    uint row = measured_row(m, wo);
    float share = table_float(m.filename, row + 3u);
    vec3 h = wo + wi;
    float density = measured_half_density(m, row, atan(length(h.xy), h.z));
    return share * density / max(2.0 * length(h), 1e-20) // wo.h = |wo + wi| / 2; Walter et al. 2007, Eq. 14
           + (1.0 - share) * cosine_hemisphere_pdf(wi.z);
}

vec3 measured_sample_half(measured_Params m, uint row, vec2 u) {
    uint n = max(table_word(m.filename, 0u), 1u), sums = row + measured_row_head, lower = 0u, upper = n - 1u;
    while (lower < upper) { // the first bin whose sum is above u
        uint middle = (lower + upper) / 2u;
        if (table_float(m.filename, sums + middle) > u.x)
            upper = middle;
        else
            lower = middle + 1u;
    }
    float before = lower > 0u ? table_float(m.filename, sums + lower - 1u) : 0.0;
    float x = clamp((u.x - before) / max(table_float(m.filename, sums + lower) - before, 1e-20), 0.0, 1.0);
    float a = table_float(m.filename, sums + n + lower), b = table_float(m.filename, sums + n + lower + 1u);
    float t = x * (a + b) / max(a + sqrt(mix(a * a, b * b, x)), 1e-20); // inverts the integral of a linear density
    float v = mix(measured_edge(lower, n), measured_edge(lower + 1u, n), clamp(t, 0.0, 1.0));
    float r = sqrt(max(0.0, v * (2.0 - v))), phi = TWO_PI * u.y;
    return vec3(r * cos(phi), r * sin(phi), 1.0 - v);
}

Spectrum measured_eval(measured_Params m, vec3 wo, vec3 wi) {
    if (!same_hemisphere(wo, wi) || table_size(m.filename) == 0u)
        return Spectrum(0);
    return clamp(m.tint, Spectrum(0), Spectrum(1)) * measured_brdf(m, measured_up(wo), measured_up(wi)) * abs(wi.z);
}

float measured_pdf(measured_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? measured_density(m, measured_up(wo), measured_up(wi)) : 0.0;
}

BsdfSample measured_sample(measured_Params m, vec3 wo, vec3 u) {
    vec3 v = measured_up(wo);
    uint row = measured_row(m, v);
    vec3 wi = sample_cosine_hemisphere(u.xy);
    if (u.z < table_float(m.filename, row + 3u)) {
        vec3 h = measured_sample_half(m, row, u.xy);
        wi = 2.0 * dot(v, h) * h - v;
    }
    if (wi.z <= 0.0 || v.z <= 0.0)
        return BSDF_NONE;
    float pdf = measured_density(m, v, wi);
    if (!positive(pdf))
        return BSDF_NONE;
    Spectrum f = measured_eval(m, v, wi);
    return BsdfSample(wo.z < 0.0 ? vec3(wi.xy, -wi.z) : wi, f / pdf, pdf, BSDF_REFLECT, 1.0);
}

Spectrum measured_albedo(measured_Params m, vec3 wo) {
    uint row = measured_row(m, measured_up(wo));
    vec3 mean = vec3(table_float(m.filename, row), table_float(m.filename, row + 1u), table_float(m.filename, row + 2u));
    return m.tint * spectrum_from_rgb(mean);
}
