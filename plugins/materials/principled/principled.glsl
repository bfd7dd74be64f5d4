// SPDX-License-Identifier: Apache-2.0
// The metallic-roughness material of glTF 2.0 (appendix B) with KHR_materials_ior, _specular, _transmission, _volume (its
// refraction) and _clearcoat. Lobes: diffuse; one GGX layer that reflects, as metal or dielectric, and lets through what
// is transmissive; a GGX coat on top. README.md says where it is not appendix B to the letter.
#include "lib/dielectric.glsl"
#include "lib/sampling.glsl"

const float principled_coat_f0 = 0.04;   // ior 1.5, KHR_materials_clearcoat
const float principled_least_eta = 1.01; // below it the half vector of refraction has no direction left

struct principled_State {
    vec3 base;
    float metallic;
    float transmission;
    vec3 f0;   // of the dielectric, head on and grazing
    float f90;
    float eta; // behind the surface / on wo's side
    bool thin;
    vec2 alpha;
    vec2 coat_alpha;
    float coat;
    vec3 choice; // probabilities: diffuse, layer, coat
};

float principled_schlick(float c) {
    float x = clamp(1.0 - c, 0.0, 1.0);
    return sqr(x * x) * x;
}
vec3 principled_fresnel(principled_State s, float c) { return s.f0 + (s.f90 - s.f0) * principled_schlick(c); }
float principled_coat_fresnel(principled_State s, float c) {
    return s.coat * (principled_coat_f0 + (1.0 - principled_coat_f0) * principled_schlick(c));
}

// What a microfacet seen under the cosine c reflects and lets through.
vec3 principled_reflected(principled_State s, float c, out vec3 through) {
    vec3 dielectric = principled_fresnel(s, c);
    float glass = s.thin ? max_component(dielectric) : fresnel_dielectric(c, s.eta);
    float clear = (1.0 - s.metallic) * s.transmission;
    through = clear * (1.0 - glass) * s.base;
    dielectric = mix(dielectric, s.thin ? dielectric : vec3(glass), s.transmission);
    return mix(dielectric, fresnel_schlick(s.base, c), s.metallic);
}

// The share of the layer's samples that reflect.
float principled_reflects(vec3 reflected, vec3 through) {
    float r = max_component(reflected);
    float t = max_component(through);
    return t > 0.0 ? r / (r + t) : 1.0;
}

// The matte part below the layer: what the layer lets in on the way of wi and out on the way of wo, scaled so that a
// smooth white surface loses nothing. Shirley, Smits, Hu and Lafortune 1997, "A Practitioners' Assessment of Light
// Reflection Models", Eq. 7, with Schlick's mean over the hemisphere f0 + (f90 - f0) / 21.
vec3 principled_diffuse(principled_State s, float cos_o, float cos_i) {
    float f0 = max_component(s.f0);
    float o = 1.0 - max_component(principled_fresnel(s, cos_o));
    float i = 1.0 - max_component(principled_fresnel(s, cos_i));
    float mean = max(1.0 - f0 - (s.f90 - f0) / 21.0, 1e-4);
    return s.base * ((1.0 - s.metallic) * (1.0 - s.transmission) * o * i / mean);
}

principled_State principled_state(principled_Params m, vec3 wo) {
    principled_State s;
    s.base = clamp(m.base_color, vec3(0), vec3(1));
    s.metallic = clamp(m.metallic, 0.0, 1.0);
    s.transmission = clamp(m.transmission, 0.0, 1.0);
    float ior = clamp(m.ior, 1.0, 10.0);
    s.f90 = clamp(m.specular, 0.0, 1.0);
    s.f0 = min(sqr((ior - 1.0) / (ior + 1.0)) * clamp(m.specular_color, vec3(0), vec3(1)), vec3(1)) * s.f90;
    float eta = max(ior, principled_least_eta);
    s.eta = wo.z < 0.0 ? 1.0 / eta : eta;
    s.thin = m.thin;
    s.alpha = vec2(sqr(clamp(m.roughness, 0.0, 1.0)));
    s.coat_alpha = vec2(sqr(clamp(m.clearcoat_roughness, 0.0, 1.0)));
    s.coat = clamp(m.clearcoat, 0.0, 1.0);
    float c = abs(wo.z);
    vec3 through;
    vec3 reflected = principled_reflected(s, c, through);
    float coat = principled_coat_fresnel(s, c);
    s.choice = vec3((1.0 - coat) * max_component(principled_diffuse(s, c, 0.7)),
                    (1.0 - coat) * (max_component(reflected) + max_component(through)), coat);
    s.choice /= max(s.choice.x + s.choice.y + s.choice.z, 1e-20);
    return s;
}

// What passes the coat on the way in and out.
float principled_under_coat(principled_State s, float cos_o, float cos_i) {
    return (1.0 - principled_coat_fresnel(s, cos_o)) * (1.0 - principled_coat_fresnel(s, cos_i));
}

// f |cos wi| and the density of all lobes that are not delta; wo.z > 0.
vec3 principled_value(principled_State s, vec3 wo, vec3 wi, out float pdf) {
    pdf = 0.0;
    if (wo.z <= 0.0 || wi.z == 0.0)
        return vec3(0);
    bool reflects = wi.z > 0.0;
    float ci = abs(wi.z);
    vec3 f = vec3(0);
    if (reflects) {
        f = principled_diffuse(s, wo.z, ci) * (INV_PI * ci);
        pdf = s.choice.x * cosine_hemisphere_pdf(ci);
    }
    if (!alpha_is_smooth(s.alpha) && (reflects || s.transmission > 0.0)) {
        // A pane is seen through as a mirror turned inside out.
        bool mirrored = !reflects && s.thin;
        float ho;
        vec2 layer = rough_interface(wo, mirrored ? vec3(wi.xy, ci) : wi, s.alpha, s.eta, DISTRIBUTION_GGX, ho);
        vec3 through;
        vec3 reflected = principled_reflected(s, ho, through);
        float share = principled_reflects(reflected, through);
        f += (reflects ? reflected : through) * layer.x;
        pdf += s.choice.y * (reflects ? share : 1.0 - share) * layer.y;
    }
    f *= principled_under_coat(s, wo.z, ci);
    if (reflects && s.coat > 0.0 && !alpha_is_smooth(s.coat_alpha)) {
        float ho;
        vec2 layer = rough_interface(wo, wi, s.coat_alpha, 1.5, DISTRIBUTION_GGX, ho);
        f += principled_coat_fresnel(s, ho) * layer.x;
        pdf += s.choice.z * layer.y;
    }
    return f;
}

// Everything is alike on both sides but for eta: z is turned so that wo looks from above.
vec3 principled_eval(principled_Params m, vec3 wo, vec3 wi) {
    float pdf;
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    return principled_value(principled_state(m, wo), vec3(wo.xy, side * wo.z), vec3(wi.xy, side * wi.z), pdf);
}

float principled_pdf(principled_Params m, vec3 wo, vec3 wi) {
    float pdf;
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    principled_value(principled_state(m, wo), vec3(wo.xy, side * wo.z), vec3(wi.xy, side * wi.z), pdf);
    return pdf;
}

BsdfSample principled_sample(principled_Params m, vec3 wo, vec3 u) {
    principled_State s = principled_state(m, wo);
    float side = wo.z < 0.0 ? -1.0 : 1.0;
    vec3 v = vec3(wo.xy, abs(wo.z));
    if (v.z == 0.0)
        return BSDF_NONE;
    vec3 wi;
    float bent = 1.0; // eta, where light is refracted
    if (u.z < s.choice.x) {
        wi = sample_cosine_hemisphere(u.xy);
    } else {
        bool coat = u.z >= s.choice.x + s.choice.y && s.choice.z > 0.0;
        vec2 alpha = coat ? s.coat_alpha : s.alpha;
        bool delta = alpha_is_smooth(alpha);
        vec3 h = delta ? vec3(0, 0, 1) : ggx_sample(v, alpha, u.xy);
        float ho = dot(v, h);
        if (ho <= 0.0)
            return BSDF_NONE;
        vec3 through = vec3(0);
        vec3 reflected = coat ? vec3(principled_coat_fresnel(s, ho)) : principled_reflected(s, ho, through);
        float share = principled_reflects(reflected, through);
        bool reflects = coat || u.z - s.choice.x < s.choice.y * share;
        wi = delta ? vec3(-v.xy, v.z) : normalize(reflect_about(v, h));
        if (!reflects && s.thin) {
            if (wi.z <= 0.0)
                return BSDF_NONE;
            wi.z = -wi.z;
        } else if (!reflects) {
            float cos_t;
            fresnel_dielectric(ho, s.eta, cos_t);
            wi = normalize(refract_about(v, h, ho, cos_t, s.eta));
            bent = s.eta;
        }
        if (wi.z == 0.0 || (wi.z > 0.0) != reflects)
            return BSDF_NONE;
        if (delta) {
            float p = coat ? s.choice.z : s.choice.y * (reflects ? share : 1.0 - share);
            if (!(p > 0.0))
                return BSDF_NONE;
            vec3 weight = (reflects ? reflected : through / (bent * bent)) / p;
            if (!coat)
                weight *= principled_under_coat(s, v.z, abs(wi.z));
            return BsdfSample(vec3(wi.xy, side * wi.z), weight, p, BSDF_DELTA | (reflects ? BSDF_REFLECT : BSDF_TRANSMIT),
                              bent);
        }
    }
    float pdf;
    vec3 f = principled_value(s, v, wi, pdf);
    if (!(pdf > 0.0))
        return BSDF_NONE;
    uint kind = wi.z > 0.0 ? BSDF_REFLECT : BSDF_TRANSMIT;
    return BsdfSample(vec3(wi.xy, side * wi.z), f / pdf, pdf, kind, bent);
}

vec3 principled_albedo(principled_Params m, vec3 wo) {
    principled_State s = principled_state(m, wo);
    float c = abs(wo.z);
    vec3 through;
    vec3 reflected = principled_reflected(s, c, through);
    float matte = (1.0 - s.metallic) * (1.0 - s.transmission) * (1.0 - max_component(principled_fresnel(s, c)));
    float coat = principled_coat_fresnel(s, c);
    return clamp(coat + (1.0 - coat) * (reflected + through + s.base * matte), vec3(0), vec3(1));
}
