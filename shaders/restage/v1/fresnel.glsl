// SPDX-License-Identifier: Apache-2.0
// Fresnel reflectances for unpolarized light, and refraction.
#ifndef RESTAGE_V1_FRESNEL
#define RESTAGE_V1_FRESNEL

#include <restage/v1/bsdf.glsl>

// Dielectric; eta = ior on the transmitted side / on the incident side; cos_i >= 0. cos_t = 0 on total internal
// reflection. Pharr et al. 2023, Eqs. 9.5 and 9.6 (Snell: 9.2).
float fresnel_dielectric(float cos_i, float eta, out float cos_t) {
    cos_i = min(cos_i, 1.0);
    float sin2_t = max(0.0, 1.0 - cos_i * cos_i) / (eta * eta);
    cos_t = sqrt(max(0.0, 1.0 - sin2_t));
    if (sin2_t >= 1.0)
        return 1.0;
    float parallel = (eta * cos_i - cos_t) / max(eta * cos_i + cos_t, 1e-20);
    float perpendicular = (cos_i - eta * cos_t) / max(cos_i + eta * cos_t, 1e-20);
    return 0.5 * (sqr(parallel) + sqr(perpendicular));
}
float fresnel_dielectric(float cos_i, float eta) {
    float cos_t;
    return fresnel_dielectric(cos_i, eta, cos_t);
}

// Transmission direction of w about the normal n, dot(w, n) = cos_i > 0; cos_t from fresnel_dielectric.
vec3 refract_about(vec3 w, vec3 n, float cos_i, float cos_t, float eta) {
    return (n * cos_i - w) / eta - n * cos_t;
}
vec3 reflect_about(vec3 w, vec3 n) { return 2.0 * dot(w, n) * n - w; }

// Conductor with ior eta + ik relative to the outside. Born and Wolf; real arithmetic after Lagarde 2013,
// "Memo on Fresnel equations"; equal to Pharr et al. 2023, Eq. 9.5 with complex eta.
Spectrum fresnel_conductor(float cos_i, Spectrum eta, Spectrum k) {
    float c = clamp(cos_i, 0.0, 1.0);
    float c2 = c * c;
    float s2 = 1.0 - c2;
    Spectrum eta2 = eta * eta;
    Spectrum t0 = eta2 - k * k - s2;
    Spectrum a2b2 = sqrt(t0 * t0 + 4.0 * eta2 * k * k);
    Spectrum t1 = a2b2 + c2;
    Spectrum t2 = 2.0 * c * sqrt(max(Spectrum(0), 0.5 * (a2b2 + t0)));
    Spectrum rs = (t1 - t2) / max(t1 + t2, Spectrum(1e-20));
    Spectrum t3 = c2 * a2b2 + s2 * s2;
    Spectrum t4 = t2 * s2;
    Spectrum rp = rs * (t3 - t4) / max(t3 + t4, Spectrum(1e-20));
    return clamp(0.5 * (rp + rs), Spectrum(0), Spectrum(1));
}

// The k of a conductor with eta = 1 that reflects r at normal incidence (pbrt-v4, conductor "reflectance").
Spectrum conductor_k_from_reflectance(Spectrum r) {
    r = clamp(r, Spectrum(0), Spectrum(0.9999));
    return 2.0 * sqrt(r / (1.0 - r));
}

// Schlick 1994, Eq. 15.
Spectrum fresnel_schlick(Spectrum r0, float cos_i) {
    float x = clamp(1.0 - cos_i, 0.0, 1.0);
    float x2 = x * x;
    return r0 + (x2 * x2 * x) * (1.0 - r0);
}

// Hemispherical (cosine-weighted) reflectance of a dielectric seen from the thin side, eta > 1: Walsh 1926 in the form
// of Duntley 1942; near 1, where that cancels, a fit to that integral (relative error below 3e-4, 1.002 to 1.15).
// From the dense side it is 1 - (1 - result) / eta^2.
float fresnel_dielectric_average(float eta) {
    if (eta < 1.08) {
        float x = max(eta - 1.0, 1e-9);
        return x * (0.333149 + x * (0.367212 + 0.479722 * log(x) - 0.782705 * x));
    }
    float n2 = eta * eta;
    float n4 = n2 * n2;
    float a = (eta - 1.0) * (3.0 * eta + 1.0) / (6.0 * sqr(eta + 1.0));
    float b = n2 * sqr(n2 - 1.0) / (sqr(n2 + 1.0) * (n2 + 1.0)) * log((eta - 1.0) / (eta + 1.0));
    float c = 2.0 * n2 * eta * (n2 + 2.0 * eta - 1.0) / ((n2 + 1.0) * (n4 - 1.0));
    float d = 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * sqr(n4 - 1.0)) * log(eta);
    return 0.5 + a + b - c + d;
}

#endif
