// SPDX-License-Identifier: Apache-2.0
// The metallic-roughness material of glTF 2.0 (appendix B) with KHR_materials_ior, _specular, _transmission, _volume (its
// refraction), _clearcoat, _sheen, _anisotropy and _iridescence. Lobes: diffuse; one GGX layer that reflects, as metal or
// dielectric, and transmits the transmissive part; fibres over both; a GGX coat on top. README.md lists the
// deviations from the specification.
#include <restage/v1/dielectric.glsl>
#include <restage/v1/multiscatter.glsl>
#include <restage/v1/sampling.glsl>
#include <restage/v1/sheen.glsl>
#include <restage/v1/thin_film.glsl>

const float principled_coat_f0 = 0.04;   // ior 1.5, KHR_materials_clearcoat
const float principled_least_eta = 1.01; // below it the half vector of refraction has no direction left

struct principled_State {
    Spectrum base;
    float metallic;
    float transmission;
    Spectrum f0;   // of the dielectric, normal and grazing
    float f90;
    float eta; // behind the surface / on wo's side
    bool thin;
    vec2 alpha;
    vec2 coat_alpha;
    float coat;
    Spectrum sheen;
    float sheen_alpha;
    float film; // fraction of the surface that has a film
    float film_ior;
    float film_thickness; // nm
    float mean_loss;      // of the layer, to multiple scattering; 0 without multiscatter
    Spectrum multiple;    // colour of light reflected more than once
    Spectrum multiple_through; // of a pane: colour of light transmitted then
    float clear_multiple; // fraction of the surface that is glass and scatters more than once
    MultiscatterDielectric glass;
    float sink;           // fraction of the cosine lobe's samples that go below
    vec2 turn;            // cosine and sine of the anisotropy's rotation
    vec4 choice;          // probabilities: cosine lobes (diffuse and multiple), layer, coat, sheen
};

float principled_schlick(float c) {
    float x = clamp(1.0 - c, 0.0, 1.0);
    return sqr(x * x) * x;
}
// Of the opaque dielectric. `film`: s.film, or 0 if an estimate suffices, as the film is expensive to compile.
Spectrum principled_fresnel(principled_State s, float c, float film) {
    Spectrum bare = s.f0 + (s.f90 - s.f0) * principled_schlick(c);
    return film > 0.0 ? mix(bare, thin_film_reflectance(c, s.film_ior, s.film_thickness, s.f0), film) : bare;
}
float principled_coat_fresnel(principled_State s, float c) {
    return s.coat * (principled_coat_f0 + (1.0 - principled_coat_f0) * principled_schlick(c));
}

// Reflection and transmission of a microfacet at the cosine c.
Spectrum principled_reflected(principled_State s, float c, float film, out Spectrum through) {
    Spectrum f[3]; // of the opaque dielectric, of glass, of metal; a film is evaluated in a loop: compiled once
    f[0] = s.f0 + (s.f90 - s.f0) * principled_schlick(c);
    float cos_t = 1.0;
    f[1] = Spectrum(!s.thin && s.transmission > 0.0 ? fresnel_dielectric(c, s.eta, cos_t) : 0.0);
    f[2] = fresnel_schlick(s.base, c);
    if (film > 0.0) {
        for (int k = 0; k < 3; ++k) {
            if (k == 1 && cos_t <= 0.0)
                continue; // total reflection
            // A film looks the same from both sides of glass.
            Spectrum filmed = thin_film_reflectance(k == 1 && s.eta < 1.0 ? cos_t : c, s.film_ior, s.film_thickness,
                                              k == 2 ? s.base : s.f0);
            f[k] = mix(f[k], filmed, film);
        }
    }
    Spectrum dielectric = f[0];
    Spectrum glass = s.thin ? Spectrum(max_component(dielectric)) : f[1];
    float clear = (1.0 - s.metallic) * s.transmission;
    through = clear * (1.0 - glass) * s.base;
    dielectric = mix(dielectric, s.thin ? dielectric : glass, s.transmission);
    return mix(dielectric, f[2], s.metallic);
}

// The fraction of the layer's samples that reflect.
float principled_reflects(Spectrum reflected, Spectrum through) {
    float r = max_component(reflected);
    float t = max_component(through);
    return t > 0.0 ? r / (r + t) : 1.0;
}

// The matte part below the layer: what the layer transmits in along wi and out along wo, scaled so that a
// smooth white surface loses nothing. Shirley, Smits, Hu and Lafortune 1997, "A Practitioners' Assessment of Light
// Reflection Models", Eq. 7.
Spectrum principled_diffuse(principled_State s, float cos_o, float cos_i, float mean_fresnel, float film) {
    float through = 1.0;
    for (int k = 0; k < 2; ++k)
        through *= 1.0 - max_component(principled_fresnel(s, k == 0 ? cos_o : cos_i, film));
    return s.base * ((1.0 - s.metallic) * (1.0 - s.transmission) * through / max(1.0 - mean_fresnel, 1e-4));
}

// Over the hemisphere, cosine-weighted: of Schlick's curve it is f0 + (f90 - f0) / 21; under a film a Gauss-Jacobi rule.
float principled_bare_mean(principled_State s) { return max_component(fresnel_schlick_average(s.f0, s.f90)); }
float principled_mean_fresnel(principled_State s) {
    if (s.film <= 0.0)
        return principled_bare_mean(s);
    const vec3 node = vec3(0.21234054, 0.59053314, 0.91141204), weight = vec3(0.13965396, 0.45848221, 0.40186383);
    float sum = 0.0;
    for (int k = 0; k < 3; ++k)
        sum += weight[k] * max_component(principled_fresnel(s, node[k], s.film));
    return sum;
}

// The fraction of the rest left under the fibres: KHR_materials_sheen, "Albedo-scaling technique".
float principled_under_sheen(principled_State s, float cos_o, float cos_i) {
    float most = max_component(s.sheen);
    if (most <= 0.0)
        return 1.0;
    return 1.0 - most * max(sheen_albedo(cos_o, s.sheen_alpha), sheen_albedo(cos_i, s.sheen_alpha));
}

// The frame of the anisotropy: x along its direction.
vec3 principled_turned(principled_State s, vec3 w) {
    return vec3(s.turn.x * w.x + s.turn.y * w.y, s.turn.x * w.y - s.turn.y * w.x, w.z);
}
vec3 principled_turned_back(principled_State s, vec3 w) {
    return vec3(s.turn.x * w.x - s.turn.y * w.y, s.turn.x * w.y + s.turn.y * w.x, w.z);
}

principled_State principled_state(principled_Params m, vec3 wo) {
    principled_State s;
    s.base = clamp(m.base_color, Spectrum(0), Spectrum(1));
    s.metallic = clamp(m.metallic, 0.0, 1.0);
    s.transmission = clamp(m.transmission, 0.0, 1.0);
    float ior = clamp(m.ior, 1.0, 10.0);
    s.f90 = clamp(m.specular, 0.0, 1.0);
    s.f0 = min(sqr((ior - 1.0) / (ior + 1.0)) * max(m.specular_color, Spectrum(0)), Spectrum(1)) * s.f90;
    float eta = max(ior, principled_least_eta);
    s.eta = wo.z < 0.0 ? 1.0 / eta : eta;
    s.thin = m.thin;
    float strength = clamp(m.anisotropy, 0.0, 1.0);
    float alpha = sqr(clamp(m.roughness, 0.0, 1.0));
    s.alpha = vec2(mix(alpha, 1.0, sqr(strength)), alpha); // KHR_materials_anisotropy, "Individual lobes"
    float turn = strength > 0.0 ? radians(m.anisotropy_rotation) : 0.0;
    s.turn = vec2(cos(turn), sin(turn));
    s.sheen = clamp(m.sheen_color, Spectrum(0), Spectrum(1));
    s.sheen_alpha = sheen_alpha(m.sheen_roughness);
    s.film = clamp(m.iridescence, 0.0, 1.0);
    s.film_ior = clamp(m.iridescence_ior, 1.0, 3.0);
    s.film_thickness = max(m.iridescence_thickness, 0.0);
    s.mean_loss = 0.0;
    s.multiple = Spectrum(0);
    s.multiple_through = Spectrum(0);
    s.clear_multiple = 0.0;
    s.glass = MultiscatterDielectric(s.eta, vec2(1), 0.0);
    if (m.multiscatter && !alpha_is_smooth(s.alpha)) {
        s.mean_loss = microfacet_mean_loss(s.alpha, DISTRIBUTION_GGX);
        s.multiple = mix((1.0 - s.transmission) * multiscatter_color(fresnel_schlick_average(s.f0, s.f90), s.mean_loss),
                         multiscatter_color(fresnel_schlick_average(s.base, 1.0), s.mean_loss), s.metallic);
        float clear = (1.0 - s.metallic) * s.transmission;
        if (s.thin) { // both sides lose alike; light leaves in the mean surface's proportions
            float mean = max_component(fresnel_schlick_average(s.f0, s.f90));
            s.multiple += clear * mean;
            s.multiple_through = clear * (1.0 - mean) * s.base;
        } else if (clear > 0.0) {
            s.clear_multiple = clear;
            s.glass = multiscatter_dielectric(s.alpha, s.eta, DISTRIBUTION_GGX);
        }
    }
    s.coat_alpha = vec2(sqr(clamp(m.clearcoat_roughness, 0.0, 1.0)));
    s.coat = clamp(m.clearcoat, 0.0, 1.0);
    float c = abs(wo.z);
    Spectrum through;
    Spectrum reflected = principled_reflected(s, c, 0.0, through);
    float coat = principled_coat_fresnel(s, c);
    float below = (1.0 - coat) * principled_under_sheen(s, c, c);
    float upward = max_component(principled_diffuse(s, c, 0.7, principled_bare_mean(s), 0.0)) +
                   max_component(s.multiple) * s.mean_loss + s.clear_multiple * s.glass.mean_loss.x * s.glass.reflected;
    float downward = max_component(s.multiple_through) * s.mean_loss +
                     s.clear_multiple * s.glass.mean_loss.x * (1.0 - s.glass.reflected) * max_component(s.base);
    s.sink = downward / max(upward + downward, 1e-20);
    s.choice = vec4(below * (upward + downward),
                    below * (max_component(reflected) + max_component(through)), coat,
                    (1.0 - coat) * max_component(s.sheen) * sheen_albedo(c, s.sheen_alpha));
    s.choice /= max(dot(s.choice, vec4(1)), 1e-20);
    return s;
}

// Transmission of the coat, in and out.
float principled_under_coat(principled_State s, float cos_o, float cos_i) {
    return (1.0 - principled_coat_fresnel(s, cos_o)) * (1.0 - principled_coat_fresnel(s, cos_i));
}

// f |cos wi| of light that the layer scatters more than once: Kulla and Conty's lobes, of a white reflector and of glass
// (restage/v1/multiscatter.glsl). The losses are evaluated in a loop: compiled once.
Spectrum principled_multiple(principled_State s, vec3 wo, vec3 wi) {
    bool reflects = wi.z > 0.0;
    float ci = abs(wi.z);
    Spectrum color = reflects ? s.multiple : s.multiple_through;
    Spectrum f = Spectrum(0);
    for (int k = 0; k < 2; ++k) {
        if (k == 0 ? max_component(color) <= 0.0 : s.clear_multiple <= 0.0)
            continue;
        float lost = 1.0;
        for (int side = 0; side < 2; ++side) {
            float eta = k == 0 ? 0.0 : side == 0 || reflects ? s.eta : 1.0 / s.eta;
            lost *= microfacet_loss(side == 0 ? wo : vec3(wi.xy, ci), s.alpha, eta, DISTRIBUTION_GGX);
        }
        lost *= ci * INV_PI;
        if (k == 0)
            f += color * (lost / s.mean_loss);
        else if (reflects)
            f += s.clear_multiple * (lost * s.glass.reflected / s.glass.mean_loss.x);
        else
            f += s.base * (s.clear_multiple * lost * (1.0 - s.glass.reflected) / (s.glass.mean_loss.y * sqr(s.eta)));
    }
    return f;
}

// f |cos wi| and the density of all lobes that are not delta; wo.z > 0.
Spectrum principled_value(principled_State s, vec3 wo, vec3 wi, out float pdf) {
    pdf = 0.0;
    if (wo.z <= 0.0 || wi.z == 0.0)
        return Spectrum(0);
    bool reflects = wi.z > 0.0;
    float ci = abs(wi.z);
    Spectrum f = principled_multiple(s, wo, wi);
    pdf = s.choice.x * (reflects ? 1.0 - s.sink : s.sink) * cosine_hemisphere_pdf(ci);
    if (reflects)
        f += principled_diffuse(s, wo.z, ci, principled_mean_fresnel(s), s.film) * (INV_PI * ci);
    if (!alpha_is_smooth(s.alpha) && (reflects || s.transmission > 0.0)) {
        // A pane's transmission is its reflection mirrored through the plane.
        bool mirrored = !reflects && s.thin;
        float ho;
        vec2 layer = rough_interface(wo, mirrored ? vec3(wi.xy, ci) : wi, s.alpha, s.eta, DISTRIBUTION_GGX, ho);
        Spectrum through;
        Spectrum reflected = principled_reflected(s, ho, s.film, through);
        float share = principled_reflects(reflected, through);
        f += (reflects ? reflected : through) * layer.x;
        pdf += s.choice.y * (reflects ? share : 1.0 - share) * layer.y;
    }
    f *= principled_under_sheen(s, wo.z, ci);
    if (reflects && max_component(s.sheen) > 0.0) {
        f += s.sheen * sheen_value(wo, wi, s.sheen_alpha);
        pdf += s.choice.w * SHEEN_PDF;
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

// Both sides are alike except for eta: z is turned so that wo looks from above, x and y to the anisotropy.
vec3 principled_turned_up(principled_State s, vec3 wo, vec3 w) {
    return principled_turned(s, vec3(w.xy, wo.z < 0.0 ? -w.z : w.z));
}

Spectrum principled_eval(principled_Params m, vec3 wo, vec3 wi) {
    float pdf;
    principled_State s = principled_state(m, wo);
    return principled_value(s, principled_turned_up(s, wo, wo), principled_turned_up(s, wo, wi), pdf);
}

float principled_pdf(principled_Params m, vec3 wo, vec3 wi) {
    float pdf;
    principled_State s = principled_state(m, wo);
    principled_value(s, principled_turned_up(s, wo, wo), principled_turned_up(s, wo, wi), pdf);
    return pdf;
}

// In the frame of principled_value, v.z > 0.
BsdfSample principled_sample_up(principled_State s, vec3 v, vec3 u) {
    vec3 wi;
    float bent = 1.0; // eta, where light is refracted
    float layers = u.z - s.choice.x - s.choice.w;
    if (u.z < s.choice.x) {
        wi = sample_cosine_hemisphere(u.xy);
        if (u.z < s.choice.x * s.sink) {
            wi.z = -wi.z;
            bent = s.thin ? 1.0 : s.eta;
        }
    } else if (layers < 0.0) {
        wi = sheen_sample(u.xy);
        if (wi.z <= 0.0)
            return BSDF_NONE;
    } else {
        bool coat = layers >= s.choice.y && s.choice.z > 0.0;
        vec2 alpha = coat ? s.coat_alpha : s.alpha;
        bool delta = alpha_is_smooth(alpha);
        vec3 h = delta ? vec3(0, 0, 1) : ggx_sample(v, alpha, u.xy);
        float ho = dot(v, h);
        if (ho <= 0.0)
            return BSDF_NONE;
        Spectrum through = Spectrum(0);
        Spectrum reflected =
            coat ? Spectrum(principled_coat_fresnel(s, ho)) : principled_reflected(s, ho, s.film, through);
        float share = principled_reflects(reflected, through);
        bool reflects = coat || layers < s.choice.y * share;
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
            if (!positive(p))
                return BSDF_NONE;
            Spectrum weight = (reflects ? reflected : through / (bent * bent)) / p;
            if (!coat)
                weight *= principled_under_coat(s, v.z, abs(wi.z)) * principled_under_sheen(s, v.z, abs(wi.z));
            return BsdfSample(wi, weight, p, BSDF_DELTA | (reflects ? BSDF_REFLECT : BSDF_TRANSMIT), bent);
        }
    }
    float pdf;
    Spectrum f = principled_value(s, v, wi, pdf);
    if (!positive(pdf))
        return BSDF_NONE;
    return BsdfSample(wi, f / pdf, pdf, wi.z > 0.0 ? BSDF_REFLECT : BSDF_TRANSMIT, bent);
}

BsdfSample principled_sample(principled_Params m, vec3 wo, vec3 u) {
    principled_State s = principled_state(m, wo);
    if (wo.z == 0.0)
        return BSDF_NONE;
    BsdfSample b = principled_sample_up(s, principled_turned_up(s, wo, wo), u);
    b.wi = principled_turned_back(s, b.wi);
    b.wi.z = wo.z < 0.0 ? -b.wi.z : b.wi.z;
    return b;
}

Spectrum principled_albedo(principled_Params m, vec3 wo) {
    principled_State s = principled_state(m, wo);
    float c = abs(wo.z);
    Spectrum through;
    Spectrum reflected = principled_reflected(s, c, s.film, through);
    float matte = (1.0 - s.metallic) * (1.0 - s.transmission) * (1.0 - max_component(principled_fresnel(s, c, 0.0)));
    float coat = principled_coat_fresnel(s, c);
    Spectrum below = principled_under_sheen(s, c, c) * (reflected + through + s.base * matte);
    Spectrum fibres = s.sheen * sheen_albedo(c, s.sheen_alpha);
    return clamp(coat + (1.0 - coat) * (fibres + below), Spectrum(0), Spectrum(1));
}
