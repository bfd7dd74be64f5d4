// SPDX-License-Identifier: Apache-2.0
// Hair: Chiang, Bitterli, Tappan and Burley 2016, "A Practical and Controllable Hair and Fur Model for Production Path
// Tracing", after Marschner et al. 2003 and d'Eon et al. 2011; in the form of Pharr et al. 2023, section 9.9.
//
// The surface is the fibre's own cylinder: x runs along it, z is the normal, and the point of incidence (h, the offset
// across the fibre) follows from the angle between wo and the normal about x. Scattering inside is part of the scattering
// function, so from within the cylinder (wo.z < 0) light passes the wall unchanged.
#include <restage/v1/fresnel.glsl>

const int hair_lobes = 3; // R, TT, TRT; one more for the rest

struct hair_State {
    float sin_o, cos_o; // of wo's inclination to the normal plane
    float gamma_o, gamma_t;
    float phi_o;
    float s;      // scale of the logistic distribution about the fibre
    vec4 v;       // longitudinal variances
    vec2 tilt[3]; // (sin, cos) of wo's inclination, turned by the scales
    Spectrum ap[4];   // attenuations
    vec4 choice;  // probabilities of the lobes
};

// ln I0(x), I0 the modified Bessel function: 20 terms of its series are exact in single precision to x = 12, and beyond
// it is asymptotic (Abramowitz and Stegun 9.7.1).
float hair_log_bessel(float x) {
    if (x > 12.0)
        return x - 0.5 * log(TWO_PI * x) + log(1.0 + (0.125 + 0.0703125 / x) / x);
    float q = 0.25 * x * x;
    float term = 1.0;
    float sum = 1.0;
    for (int i = 1; i < 20; ++i) {
        term *= q / float(i * i);
        sum += term;
    }
    return log(sum);
}

// ln(2 sinh x)
float hair_log_sinh2(float x) { return x > 8.0 ? x : log(exp(x) - exp(-x)); }

// Longitudinal: d'Eon et al. 2011, Eq. 7. Integrates over the sphere's inclinations, weighted with cos, to 1.
float hair_m(float sin_i, float cos_i, float sin_o, float cos_o, float v) {
    return exp(hair_log_bessel(cos_i * cos_o / v) - sin_i * sin_o / v - hair_log_sinh2(1.0 / v) - log(v));
}

// atan2, to 1e-7 (Abramowitz and Stegun 4.4.49): GLSL's own may be off by 4096 ulp, which shows in narrow lobes.
float hair_atan(float y, float x) {
    float a = min(abs(x), abs(y)) / max(max(abs(x), abs(y)), 1e-20);
    float q = a * a;
    float t = -0.0161657367 + q * 0.0028662257;
    t = -0.0752896400 + q * (0.0429096138 + q * t);
    t = -0.1420889944 + q * (0.1065626393 + q * t);
    t = a * (1.0 + q * (-0.3333314528 + q * (0.1999355085 + q * t)));
    t = abs(y) > abs(x) ? 0.5 * PI - t : t;
    t = x < 0.0 ? PI - t : t;
    return y < 0.0 ? -t : t;
}

float hair_wrap(float phi) { return phi - TWO_PI * floor((phi + PI) / TWO_PI); } // into [-pi, pi)

float hair_logistic(float x, float s) {
    float e = exp(-abs(x) / s);
    return e / (s * sqr(1.0 + e));
}
float hair_logistic_cdf(float x, float s) { return 1.0 / (1.0 + exp(-x / s)); }

// The exit angle, after p passages, of light that entered at gamma_o: Marschner et al. 2003, Eq. 3.
float hair_phi(int p, hair_State st) { return 2.0 * float(p) * st.gamma_t - 2.0 * st.gamma_o + float(p) * PI; }

// Azimuthal: a logistic distribution trimmed to a turn (Chiang et al. 2016, section 4.1).
float hair_n(int p, float phi, hair_State st) {
    float inside = 1.0 - 2.0 * hair_logistic_cdf(-PI, st.s);
    return hair_logistic(hair_wrap(phi - hair_phi(p, st)), st.s) / inside;
}
float hair_sample_n(float u, hair_State st) {
    float lower = hair_logistic_cdf(-PI, st.s);
    float t = lower + u * (1.0 - 2.0 * lower);
    return clamp(-st.s * log(1.0 / max(t, 1e-12) - 1.0), -PI, PI);
}

// Absorption [1 / fibre radius] of hair that has this colour in bulk: Chiang et al. 2016, Eq. 9.
Spectrum hair_sigma(Spectrum color, float b) {
    float b2 = b * b;
    float d = 5.969 - 0.215 * b + 2.532 * b2 - 10.73 * b2 * b + 5.574 * b2 * b2 + 0.245 * b2 * b2 * b;
    Spectrum x = log(clamp(color, Spectrum(1e-4), Spectrum(1))) / d;
    return x * x;
}

hair_State hair_state(hair_Params m, vec3 wo) {
    hair_State st;
    float bm = clamp(m.beta_m, 0.05, 1.0);
    float bn = clamp(m.beta_n, 0.05, 1.0);
    // Chiang et al. 2016, Eqs. 7 and 8
    float v0 = sqr(0.726 * bm + 0.812 * bm * bm + 3.7 * pow(bm, 20.0));
    st.v = vec4(v0, 0.25 * v0, 4.0 * v0, 4.0 * v0);
    st.s = 0.626657069 * (0.265 * bn + 1.194 * bn * bn + 5.372 * pow(bn, 22.0));

    st.sin_o = clamp(wo.x, -1.0, 1.0);
    st.cos_o = max(length(wo.yz), 1e-6);
    st.phi_o = hair_atan(wo.z, wo.y);
    st.gamma_o = -hair_atan(wo.y, wo.z);
    float h = -wo.y / st.cos_o;

    float eta = max(m.eta, 1.01);
    float cos_t = sqrt(max(0.0, 1.0 - sqr(st.sin_o / eta)));
    float eta_p = sqrt(eta * eta - sqr(st.sin_o)) / st.cos_o; // Marschner et al. 2003: Snell in the normal plane
    float sin_gamma_t = clamp(h / eta_p, -1.0, 1.0);
    float cos_gamma_t = sqrt(max(0.0, 1.0 - sqr(sin_gamma_t)));
    st.gamma_t = hair_atan(sin_gamma_t, cos_gamma_t);
    Spectrum t = exp(-hair_sigma(m.color, bn) * (2.0 * cos_gamma_t / cos_t));

    // Attenuations, d'Eon et al. 2011, Eq. 13; the last sums all that is left (a geometric series).
    float f = fresnel_dielectric(wo.z, eta); // cos theta_o cos gamma_o
    st.ap[0] = Spectrum(f);
    st.ap[1] = sqr(1.0 - f) * t;
    st.ap[2] = st.ap[1] * t * f;
    st.ap[3] = st.ap[2] * f * t / max(1.0 - f * t, Spectrum(1e-6));
    for (int p = 0; p <= hair_lobes; ++p)
        st.choice[p] = average(st.ap[p]);
    st.choice /= max(st.choice.x + st.choice.y + st.choice.z + st.choice.w, 1e-12);

    // The scales turn R by -2 alpha, TT by alpha, TRT by 4 alpha.
    float alpha = radians(clamp(m.alpha, 0.0, 10.0));
    const vec3 turns = vec3(-2.0, 1.0, 4.0);
    for (int p = 0; p < hair_lobes; ++p) {
        float c = cos(turns[p] * alpha);
        float s = sin(turns[p] * alpha);
        st.tilt[p] = vec2(st.sin_o * c + st.cos_o * s, abs(st.cos_o * c - st.sin_o * s));
    }
    return st;
}

// f |cos wi| and its density; wo.z > 0. The scattering function contains no cosine, so 1 / |cos| is omitted here.
Spectrum hair_value(hair_State st, vec3 wi, out float pdf) {
    float sin_i = clamp(wi.x, -1.0, 1.0);
    float cos_i = sqrt(max(0.0, 1.0 - sin_i * sin_i));
    float phi = hair_atan(wi.z, wi.y) - st.phi_o;
    Spectrum f = Spectrum(0);
    pdf = 0.0;
    for (int p = 0; p <= hair_lobes; ++p) {
        bool rest = p == hair_lobes;
        vec2 o = rest ? vec2(st.sin_o, st.cos_o) : st.tilt[min(p, hair_lobes - 1)];
        float d = hair_m(sin_i, cos_i, o.x, o.y, st.v[p]) * (rest ? 0.5 * INV_PI : hair_n(p, phi, st));
        f += st.ap[p] * d;
        pdf += st.choice[p] * d;
    }
    return f;
}

Spectrum hair_eval(hair_Params m, vec3 wo, vec3 wi) {
    float pdf;
    return wo.z > 0.0 && wi.z != 0.0 ? hair_value(hair_state(m, wo), wi, pdf) : Spectrum(0);
}

float hair_pdf(hair_Params m, vec3 wo, vec3 wi) {
    float pdf = 0.0;
    if (wo.z > 0.0 && wi.z != 0.0)
        hair_value(hair_state(m, wo), wi, pdf);
    return pdf;
}

BsdfSample hair_sample(hair_Params m, vec3 wo, vec3 u) {
    if (wo.z <= 0.0)
        return wo.z < 0.0 ? BsdfSample(-wo, Spectrum(1), 1.0, BSDF_TRANSMIT | BSDF_DELTA, 1.0) : BSDF_NONE;
    hair_State st = hair_state(m, wo);
    int p = 0;
    float left = u.z;
    while (p < hair_lobes && left >= st.choice[p])
        left -= st.choice[p++];
    float again = clamp(left / max(st.choice[p], 1e-12), 0.0, 0.99999994); // reuses the random number
    // d'Eon et al. 2013, "Importance sampling for physically-based hair fiber models", Eqs. 6 and 7
    float v = st.v[p];
    float c = 1.0 + v * log(max(u.x, 1e-5) + (1.0 - u.x) * exp(-2.0 / v));
    float s = sqrt(max(0.0, 1.0 - c * c));
    vec2 o = p == hair_lobes ? vec2(st.sin_o, st.cos_o) : st.tilt[min(p, hair_lobes - 1)];
    float sin_i = clamp(-c * o.x + s * cos(TWO_PI * u.y) * o.y, -1.0, 1.0);
    float cos_i = sqrt(max(0.0, 1.0 - sin_i * sin_i));
    float phi = st.phi_o + (p == hair_lobes ? TWO_PI * again : hair_phi(p, st) + hair_sample_n(again, st));
    vec3 wi = vec3(sin_i, cos_i * cos(phi), cos_i * sin(phi));
    if (wi.z == 0.0)
        return BSDF_NONE;
    float pdf;
    Spectrum f = hair_value(st, wi, pdf);
    if (!positive(pdf))
        return BSDF_NONE;
    return BsdfSample(wi, f / pdf, pdf, wi.z > 0.0 ? BSDF_REFLECT : BSDF_TRANSMIT, 1.0);
}

Spectrum hair_albedo(hair_Params m, vec3 wo) {
    if (wo.z <= 0.0)
        return Spectrum(1);
    hair_State st = hair_state(m, wo);
    return clamp(st.ap[0] + st.ap[1] + st.ap[2] + st.ap[3], Spectrum(0), Spectrum(1));
}
