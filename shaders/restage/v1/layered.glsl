// SPDX-License-Identifier: Apache-2.0
// A dielectric coat over an opaque base (diffuse or conductor), with an optional homogeneous medium between them:
// the position-free random walk of Guo et al. 2018 as in pbrt-v4 (Pharr et al. 2023, sec. 14.3, LayeredBxDF).
//
// eval and sample are two unbiased estimates of one function: the light that leaves after at most max_depth events
// inside. The density that MIS needs has no closed form, so `layered_pdf` is a deterministic approximation of
// it, used on both sides (light and BSDF samples): MIS weights then sum to 1 at every direction and nothing is biased,
// whereas a random density would correlate with the estimates it weighs. It is not the density of layered_sample.
//
// Differences from pbrt-v4: (1) its weight for continuing through the exit interface takes the density of the reverse
// direction, so its two weights do not sum to 1 and its f comes out too bright, by 4 % (alpha 0.1 over a diffuse base
// of 0.6) to 15 % (0.3 over metal); here they do, and energy is conserved. (2) A diffuse base uses only the direction
// drawn through the coat from wi, which always suits it. (3) After max_depth events sample may still leave, as in
// eval. (4) Coats are smooth below alpha = 0.0015. (5) Light leaving by a smooth coat after a smooth base is marked delta,
// even if the medium scattered it before: eval cannot make that connection, so no MIS weight may count on it.
// Directions have z > 0 outside; the walk runs downwards from z = thickness.
#ifndef RESTAGE_V1_LAYERED
#define RESTAGE_V1_LAYERED

#include <restage/v1/dielectric.glsl>
#include <restage/v1/frame.glsl>
#include <restage/v1/rng.glsl>
#include <restage/v1/sampling.glsl>

struct Layered {
    vec2 alpha;      // of the coat
    float eta;       // of the coat, relative to the outside
    float thickness; // in mean free paths, as in pbrt (extinction 1)
    Spectrum albedo;     // of the medium; 0 = it only absorbs
    float g;         // Henyey-Greenstein
    int max_depth;
    int n_samples;
    bool metal;      // a literal at the call site, so that the other base is compiled out
    Spectrum base;       // diffuse: reflectance; metal: ior relative to the coat
    Spectrum base_k;     // metal
    vec2 base_alpha; // metal
};

// The coat from a material's parameters; the caller fills in the base.
Layered layered_coat_of(vec2 roughness, int remap, float eta, float thickness, Spectrum albedo, float g, int max_depth,
                        int n_samples) {
    Layered l;
    l.alpha = roughness == vec2(0) ? vec2(0) : alpha_from_roughness(roughness.x, roughness.y, remap);
    l.eta = eta > 0.0 ? eta : 1.0;
    l.thickness = max(thickness, 1e-6);
    l.albedo = clamp(albedo, Spectrum(0), Spectrum(1));
    l.g = clamp(g, -0.99, 0.99);
    l.max_depth = max_depth;
    l.n_samples = n_samples;
    return l;
}

const int LAYER_TOP = 0;
const int LAYER_BASE = 1;
const int LAYER_MEDIUM = 2;
const int LAYER_EITHER = 0; // allowed events at the coat
const int LAYER_REFLECT = 1;
const int LAYER_TRANSMIT = 2;

bool coat_is_smooth(vec2 alpha, float eta) { return min(alpha.x, alpha.y) < 1.5e-3 || abs(eta - 1.0) < 1e-3; }

// Henyey and Greenstein 1941; c = cosine between the old and the new direction of travel.
float henyey_greenstein(float c, float g) {
    float d = max(1.0 + g * g - 2.0 * g * c, 1e-6);
    return (1.0 - g * g) / (2.0 * TWO_PI * d * sqrt(d));
}
vec3 henyey_greenstein_sample(vec3 w, float g, vec2 u) {
    float s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u.x);
    float c = abs(g) < 1e-3 ? 1.0 - 2.0 * u.x : clamp((1.0 + g * g - s * s) / (2.0 * g), -1.0, 1.0);
    float phi = TWO_PI * u.y;
    vec2 r = sqrt(max(0.0, 1.0 - c * c)) * vec2(cos(phi), sin(phi));
    Frame f = frame_from_normal(w);
    return r.x * f.t + r.y * f.b + c * w;
}

// One scattering at the coat seen from v. Returns f cos / pdf without 1/eta^2, 0 = lost; r.z > 0 if reflected.
// pdf: density of r given the choice (0 for a smooth coat).
float layered_coat(vec2 alpha, float eta, vec3 v, vec3 u, int allowed, out vec3 r, out float pdf) {
    bool smooth_coat = coat_is_smooth(alpha, eta);
    vec3 h = smooth_coat ? vec3(0, 0, 1) : ggx_sample(v, alpha, u.xy);
    float hv = max(dot(v, h), 0.0);
    float cos_t;
    float fresnel = fresnel_dielectric(hv, eta, cos_t);
    bool reflects = allowed == LAYER_EITHER ? u.z < fresnel : allowed == LAYER_REFLECT;
    r = reflects ? 2.0 * hv * h - v : refract_about(v, h, hv, cos_t, eta);
    float weight = allowed == LAYER_EITHER ? 1.0 : reflects ? fresnel : 1.0 - fresnel;
    pdf = 0.0;
    if (weight <= 0.0 || (reflects ? r.z < 1e-6 : r.z > -1e-6))
        return 0.0;
    if (!smooth_coat) {
        float ci = abs(r.z);
        float sigma_v = ggx_sigma(v, alpha);
        float hr = dot(r, h);
        weight *= ci * sigma_v * smith_visibility(v.z, sigma_v, ci, ggx_sigma(vec3(r.xy, ci), alpha));
        float jacobian = reflects ? 0.25 : -hv * hr / max(sqr(hr + hv / eta), 1e-20);
        pdf = ggx_d(h, alpha) * jacobian / sigma_v;
    }
    return weight;
}

// Russian roulette from the fourth event on, when little light is left.
bool layered_survives(int depth, inout Spectrum beta, inout Rng rng) {
    float q = max_component(beta);
    if (depth <= 3 || q >= 0.25)
        return true;
    if (is_nan(q) || rng_next(rng) >= q)
        return false;
    beta /= q;
    return true;
}

// From height z along w to the next event.
int layered_advance(Layered l, bool medium, vec3 w, inout float z, inout Spectrum beta, inout Rng rng) {
    float c = max(abs(w.z), 1e-6);
    bool up = w.z > 0.0;
    if (medium) {
        float dz = -log(1.0 - rng_next(rng)) * c;
        float to = up ? z + dz : z - dz;
        if (to > 0.0 && to < l.thickness) {
            z = to;
            return LAYER_MEDIUM;
        }
    } else {
        beta *= exp(-l.thickness / c); // always from one boundary to the other
    }
    z = up ? l.thickness : 0.0;
    return up ? LAYER_TOP : LAYER_BASE;
}

// Scatters at the base; v = direction it came from. beta is multiplied by f cos / pdf. Returns the density of w (rough metal) or 0.
float layered_base_sample(Layered l, vec3 v, vec2 u, out vec3 w, inout Spectrum beta) {
    if (!l.metal) {
        w = sample_cosine_hemisphere(u);
        beta *= l.base;
        return 0.0;
    }
    bool smooth_base = alpha_is_smooth(l.base_alpha);
    vec3 h = smooth_base ? vec3(0, 0, 1) : ggx_sample(v, l.base_alpha, u);
    w = reflect_about(v, h);
    float hv = dot(v, h);
    if (w.z < 1e-6 || hv <= 0.0) {
        beta = Spectrum(0);
        return 0.0;
    }
    beta *= fresnel_conductor(hv, l.base, l.base_k);
    if (smooth_base)
        return 0.0;
    float sigma_v = ggx_sigma(v, l.base_alpha);
    beta *= w.z * sigma_v * smith_visibility(v.z, sigma_v, w.z, ggx_sigma(w, l.base_alpha));
    return ggx_d(h, l.base_alpha) / (4.0 * sigma_v);
}

// f * |cos wi|, an unbiased estimate.
Spectrum layered_eval(Layered l, vec3 wo, vec3 wi, inout Rng rng) {
    if (wo.z * wi.z <= 0.0)
        return Spectrum(0);
    wo.z = abs(wo.z);
    wi.z = abs(wi.z);
    bool medium = max_component(l.albedo) > 0.0;
    bool rough_coat = !coat_is_smooth(l.alpha, l.eta);
    bool rough_base = !alpha_is_smooth(l.base_alpha);
    Spectrum sum = Spectrum(0);
    int n = max(l.n_samples, 1);
    for (int s = 0; s < n; ++s) {
        Spectrum beta = Spectrum(1);
        vec3 w = wo;
        float z = l.thickness;
        vec3 light = vec3(0, 0, 1); // inside the coat, towards the light: drawn from wi through the coat
        float light_weight = 0.0;
        float light_pdf = 0.0;
        // -2: wo enters; -1: wi enters; from 0: events of the walk. One loop, so that the coat is compiled once.
        for (int depth = -2; depth < l.max_depth; ++depth) {
            int event = LAYER_TOP;
            vec3 v = depth == -2 ? wo : wi;
            float eta = l.eta;
            if (depth >= 0) {
                if (!layered_survives(depth, beta, rng))
                    break;
                event = layered_advance(l, medium, w, z, beta, rng);
                v = vec3(-w.xy, abs(w.z));
                eta = 1.0 / l.eta;
            }
            vec3 u = rng_next3(rng);
            if (event == LAYER_TOP) {
                vec3 r;
                float pdf;
                float weight = layered_coat(l.alpha, eta, v, u, depth < 0 ? LAYER_TRANSMIT : LAYER_REFLECT, r, pdf);
                if (weight <= 0.0)
                    break;
                if (depth == -1) {
                    light = -r;
                    light_weight = weight;
                    light_pdf = pdf;
                } else {
                    beta *= weight;
                    w = vec3(r.xy, -abs(r.z));
                }
                continue;
            }
            float pdf;
            float transmittance = exp(-(l.thickness - z) / light.z);
            if (event == LAYER_BASE) {
                if (!l.metal) {
                    sum += beta * l.base * (INV_PI * transmittance * light_weight);
                } else if (rough_base) {
                    vec3 h = normalize(v + light);
                    float sigma_v = ggx_sigma(v, l.base_alpha);
                    float vis = smith_visibility(v.z, sigma_v, light.z, ggx_sigma(light, l.base_alpha));
                    float d = 0.25 * ggx_d(h, l.base_alpha);
                    float mis = rough_coat ? power_heuristic(light_pdf, d / sigma_v) : 1.0;
                    sum += beta * fresnel_conductor(dot(v, h), l.base, l.base_k) *
                           (d * vis * mis * transmittance * light_weight);
                }
                pdf = layered_base_sample(l, v, u.xy, w, beta);
            } else {
                float phase = henyey_greenstein(dot(w, light), l.g);
                float mis = l.metal && rough_coat ? power_heuristic(light_pdf, phase) : 1.0;
                beta *= l.albedo;
                sum += beta * (phase * mis * transmittance * light_weight / light.z);
                vec3 from = w;
                w = henyey_greenstein_sample(w, l.g, u.xy);
                pdf = henyey_greenstein(dot(from, w), l.g);
            }
            if (max_component(beta) <= 0.0 || abs(w.z) < 1e-6)
                break;
            // The second strategy: the sampled direction leaves through the rough coat towards wi.
            if (l.metal && rough_coat && w.z > 0.0) {
                vec3 h = wi - l.eta * w;
                h *= (h.z < 0.0 ? -1.0 : 1.0) * inversesqrt(max(dot(h, h), 1e-12));
                float hi = dot(wi, h);
                float hw = -dot(w, h);
                if (hi > 0.0 && hw < 0.0) {
                    float sigma_i = ggx_sigma(wi, l.alpha);
                    float j = ggx_d(h, l.alpha) * -hi * hw / max(sqr(hw + hi / l.eta), 1e-20);
                    float vis = smith_visibility(wi.z, sigma_i, w.z, ggx_sigma(w, l.alpha));
                    float mis = pdf > 0.0 ? power_heuristic(pdf, j / sigma_i) : 1.0;
                    sum += beta * ((1.0 - fresnel_dielectric(hi, l.eta)) * j * vis * mis *
                                   exp(-(l.thickness - z) / w.z));
                }
            }
        }
    }
    Spectrum value = sum * (wi.z / (float(n) * l.eta * l.eta)); // wo entered: 1/eta^2
    if (rough_coat)
        value += rough_dielectric(wo, wi, l.alpha, l.eta, DISTRIBUTION_GGX).x;
    return value;
}

// For MIS only, see above. Integrates to about 1 minus the probability of the delta lobes.
float layered_pdf(Layered l, vec3 wo, vec3 wi) {
    if (wo.z * wi.z <= 0.0)
        return 0.0;
    wo.z = abs(wo.z);
    wi.z = abs(wi.z);
    bool smooth_coat = coat_is_smooth(l.alpha, l.eta);
    bool medium = max_component(l.albedo) > 0.0;
    if (l.metal && smooth_coat && !medium && alpha_is_smooth(l.base_alpha))
        return 0.0;
    float inner = cosine_hemisphere_pdf(wi.z);
    float cos_o;
    float enters = 1.0 - fresnel_dielectric(wo.z, l.eta, cos_o);
    if (l.metal) {
        // The base's lobe between the directions refracted by the mean surface, widened by two rough refractions.
        vec2 widening = smooth_coat ? vec2(0) : 0.5 * sqr(1.0 - 1.0 / l.eta) * l.alpha * l.alpha;
        vec2 alpha = sqrt(l.base_alpha * l.base_alpha + widening);
        float cos_i = sqrt(max(0.0, 1.0 - (1.0 - wi.z * wi.z) / (l.eta * l.eta)));
        if (!alpha_is_smooth(alpha) && cos_i > 1e-6 && cos_o > 1e-6) {
            vec3 o = vec3(wo.xy / l.eta, cos_o);
            vec3 i = vec3(wi.xy / l.eta, cos_i);
            float lobe = ggx_d(normalize(o + i), alpha) / (4.0 * ggx_sigma(o, alpha));
            inner = mix(lobe * wi.z / (l.eta * l.eta * cos_i), inner, medium ? 0.5 : 0.1);
        }
    }
    float pdf = enters * inner;
    if (!smooth_coat)
        pdf += rough_dielectric(wo, wi, l.alpha, l.eta, DISTRIBUTION_GGX).y;
    return pdf;
}

BsdfSample layered_sample(Layered l, vec3 wo, vec3 u, inout Rng rng) {
    bool medium = max_component(l.albedo) > 0.0;
    bool smooth_coat = coat_is_smooth(l.alpha, l.eta);
    bool delta = smooth_coat;
    Spectrum beta = Spectrum(1);
    vec3 v = vec3(wo.xy, abs(wo.z));
    vec3 w = v;
    float z = l.thickness;
    if (v.z < 1e-6)
        return BSDF_NONE;
    for (int depth = -1; depth <= l.max_depth; ++depth) { // -1: wo enters or is reflected
        int event = LAYER_TOP;
        float eta = l.eta;
        if (depth >= 0) {
            if (!layered_survives(depth, beta, rng))
                break;
            event = layered_advance(l, medium, w, z, beta, rng);
            v = vec3(-w.xy, abs(w.z));
            eta = 1.0 / l.eta;
            u = rng_next3(rng);
        }
        if (event == LAYER_TOP) {
            vec3 r;
            float pdf;
            beta *= layered_coat(l.alpha, eta, v, u, LAYER_EITHER, r, pdf); // eta^2 of the two passages cancels
            if ((r.z > 0.0) == (depth < 0)) {
                if (max_component(beta) <= 0.0)
                    break;
                vec3 wi = normalize(vec3(r.xy, abs(r.z) * (wo.z > 0.0 ? 1.0 : -1.0)));
                float fresnel = fresnel_dielectric(abs(wo.z), l.eta);
                pdf = delta ? (depth < 0 ? fresnel : 1.0 - fresnel) : layered_pdf(l, wo, wi);
                return BsdfSample(wi, beta, pdf, delta ? BSDF_REFLECT | BSDF_DELTA : BSDF_REFLECT, 1.0);
            }
            w = vec3(r.xy, -abs(r.z));
        } else if (event == LAYER_BASE) {
            layered_base_sample(l, v, u.xy, w, beta);
            delta = smooth_coat && l.metal && alpha_is_smooth(l.base_alpha);
        } else {
            w = henyey_greenstein_sample(w, l.g, u.xy);
            beta *= l.albedo;
            delta = false;
        }
        if (max_component(beta) <= 0.0 || abs(w.z) < 1e-6)
            break;
    }
    return BSDF_NONE;
}

#endif
