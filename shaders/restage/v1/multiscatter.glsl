// SPDX-License-Identifier: Apache-2.0
// Energy lost by single scattering on microfacets, and lobes that restore it: Kulla and Conty 2017, "Revisiting
// Physically Based Shading at Imageworks", pp. 13-24, after Kelemen and Szirmay-Kalos 2001, Eq. 12. Reciprocal by construction.
//   f_ms(o, i) = L(o) L(i) / (pi Lm),  L = 1 - directional albedo with F = 1,  Lm = 2 int_0^1 L mu dmu
// L is a quadrature over visible normals, because fits hold neither for anisotropic surfaces (four variables) nor for
// dielectrics (three, with total reflection); Lm, which is smooth, is a fit. Errors are given at each.
#ifndef RESTAGE_V1_MULTISCATTER
#define RESTAGE_V1_MULTISCATTER

#include <restage/v1/fresnel.glsl>
#include <restage/v1/microfacet.glsl>

// 1 - directional albedo of a microfacet interface seen from wo, wo.z > 0. eta = ior below / above; 0: total reflection.
// A Fibonacci lattice of 55 normals (Sloan and Joe 1994, sec. 2.9), shifted off 0 and 1. Error: rms 0.005, max 0.02;
// from inside a dielectric, with total reflection, 0.01 and 0.045.
float microfacet_loss(vec3 wo, vec2 alpha, float eta, int distribution) {
    const int count = 55, generator = 34;
    float sigma_o = microfacet_sigma(wo, alpha, distribution);
    float albedo = 0.0;
    for (int k = 0; k < count; ++k) {
        float a = (float(k) + 0.5) / float(count);
        float b = (float((k * generator) % count) + 0.25) / float(count);
        // The elevation is the second variable of GGX and the first of Beckmann.
        vec2 u = distribution == DISTRIBUTION_GGX ? vec2(b, a) : vec2(a, b);
        vec3 h = microfacet_sample(wo, alpha, u, distribution);
        float ho = max(dot(wo, h), 0.0);
        float cos_t = 0.0;
        float fresnel = eta > 0.0 ? fresnel_dielectric(ho, eta, cos_t) : 1.0;
        vec3 r = reflect_about(wo, h);
        vec3 t = eta > 0.0 ? refract_about(wo, h, ho, cos_t, eta) : vec3(0, 0, 1);
        for (int lobe = 0; lobe < 2; ++lobe) {
            vec3 wi = lobe == 0 ? r : vec3(t.xy, -t.z);
            float share = lobe == 0 ? fresnel : 1.0 - fresnel;
            if (wi.z <= 0.0 || share <= 0.0)
                continue;
            float sigma_i = microfacet_sigma(wi, alpha, distribution);
            albedo += share * wi.z * sigma_o * smith_visibility(wo.z, sigma_o, wi.z, sigma_i);
        }
    }
    return clamp(1.0 - albedo / float(count), 0.0, 1.0);
}

// Lm with F = 1: a fit in the root mean square alpha and in the anisotropy. Error: 0.002 (alpha up to 1.62), 0.005 when
// anisotropic.
float microfacet_mean_loss(vec2 alpha, int distribution) {
    float rms = sqrt(0.5 * dot(alpha, alpha));
    float r = rms / (1.0 + 0.5 * rms);
    float q = sqr(alpha.x - alpha.y) / (1.0 + dot(alpha, alpha));
    bool ggx = distribution == DISTRIBUTION_GGX;
    vec4 c = ggx ? vec4(0.05676, 2.6849, -2.6877, 0.78668) : vec4(0.04565, 0.02651, 1.70679, -1.08129);
    vec4 a = ggx ? vec4(-0.06176, -0.01855, 0.05254, -0.00846) : vec4(-0.00695, -0.00468, -0.00437, -0.0033);
    return max(r * dot(c, vec4(1, r, r * r, r * r * r)) + q * dot(a, vec4(1, r, q, r * r)), 1e-5);
}

// Lm of a dielectric with the index n > 1 below, from above (x) and from below (y): fits in 1 / n as well. Error: 0.003
// and 0.014, 0.01 and 0.024 when anisotropic.
vec2 microfacet_mean_loss_dielectric(vec2 alpha, float n, int distribution) {
    float rms = sqrt(0.5 * dot(alpha, alpha));
    float r = rms / (1.0 + rms);
    float x = 1.0 / n;
    vec4 p = r * vec4(1, r, r * r, r * r * r);
    vec4 xs = vec4(1, x, x * x, x * x * x);
    vec4 q = sqr(alpha.x - alpha.y) / (1.0 + dot(alpha, alpha)) * vec4(1, r, x, r * x);
    vec2 m; // columns of the matrices: powers of r
    if (distribution == DISTRIBUTION_GGX) {
        const mat4 above = mat4(0.22885, -0.71142, 1.39574, -0.95829, -1.48848, 9.06473, -18.93553, 12.62342, //
                                10.88962, -40.31632, 65.25266, -37.04864, -9.52091, 36.87891, -55.04895, 27.9892);
        const mat4 below = mat4(1.44054, -7.33028, 12.02335, -6.23194, 0.84211, 6.18178, 0.7504, -3.86338, //
                                -6.10312, 42.65563, -88.80591, 40.43627, 6.64829, -52.3804, 87.90126, -30.91856);
        m = vec2(dot(xs, above * p) + dot(q, vec4(0.10049, -0.01579, -0.15708, 0.12143)),
                 dot(xs, below * p) + dot(q, vec4(0.03304, -0.27138, -0.36338, 0.88034)));
    } else {
        const mat4 above = mat4(-0.00689, -0.31341, 0.78676, -0.42348, 0.62673, 2.37929, -4.49143, 0.91766, //
                                -2.53865, -2.36819, 0.29271, 6.9135, 5.82954, -7.31322, 13.37149, -13.44486);
        const mat4 below = mat4(-1.03163, 5.2624, -6.88871, 2.32427, 16.58416, -82.85056, 114.95259, -44.3404, //
                                -45.1656, 227.95287, -284.01791, 90.14062, 39.15394, -178.67239, 196.6115, -48.38358);
        m = vec2(dot(xs, above * p) + dot(q, vec4(-0.15556, 0.40314, 0.15534, -0.38568)),
                 dot(xs, below * p) + dot(q, vec4(0.61058, -1.32821, -0.93963, 1.93688)));
    }
    return max(m, vec2(1e-5));
}

// The fraction of colour that survives two or more reflections of mean reflectance f, if each exits with 1 - mean_loss:
// the geometric series f^2 E (1 + f (1 - E) + ...). Kulla and Conty 2017, p. 16, with the square of Hill 2018,
// "A Multi-Faceted Exploration", part 3.
Spectrum multiscatter_color(Spectrum f, float mean_loss) { return f * f * (1.0 - mean_loss) / (1.0 - f * mean_loss); }

// Cosine-weighted means over the hemisphere: of Schlick's curve, and of a conductor by Gauss-Jacobi quadrature.
Spectrum fresnel_schlick_average(Spectrum f0, float f90) { return f0 + (f90 - f0) / 21.0; }
Spectrum fresnel_conductor_average(Spectrum eta, Spectrum k) {
    const vec3 node = vec3(0.21234054, 0.59053314, 0.91141204), weight = vec3(0.13965396, 0.45848221, 0.40186383);
    Spectrum sum = Spectrum(0);
    for (int i = 0; i < 3; ++i)
        sum += weight[i] * fresnel_conductor(node[i], eta, k);
    return sum;
}

// f_ms |cos wi| with F = 1, both directions above; sample with a cosine distribution.
float multiscatter_reflection(vec3 wo, vec3 wi, vec2 alpha, float mean_loss, int distribution) {
    return microfacet_loss(wo, alpha, 0.0, distribution) * microfacet_loss(wi, alpha, 0.0, distribution) /
           (PI * mean_loss) * wi.z;
}

// The fraction of a dielectric's lost light that returns above; the rest is transmitted. Preserves both sides' energy and
// reciprocity, (1 - r) Lm = eta^2 (1 - r') Lm', with 1 - r proportional to the mean transmittance.
struct MultiscatterDielectric {
    float eta;       // below / above, where above is wo's side
    vec2 mean_loss;  // above, below
    float reflected;
};

MultiscatterDielectric multiscatter_dielectric(vec2 alpha, float eta, int distribution) {
    MultiscatterDielectric d;
    float n = max(eta, 1.0 / eta);
    d.eta = eta;
    d.mean_loss = microfacet_mean_loss_dielectric(alpha, n, distribution);
    if (eta < 1.0)
        d.mean_loss = d.mean_loss.yx;
    float through = (1.0 - fresnel_dielectric_average(n)) * (eta < 1.0 ? eta * eta : 1.0);
    d.reflected = 1.0 - through * d.mean_loss.y / max(d.mean_loss.x, d.mean_loss.y);
    return d;
}

// f_ms |cos wi| in radiance transport, wo above.
float multiscatter_transmission(MultiscatterDielectric d, vec3 wo, vec3 wi, vec2 alpha, int distribution) {
    bool reflects = wi.z > 0.0;
    float ci = abs(wi.z);
    float lost = microfacet_loss(wo, alpha, d.eta, distribution) *
                 microfacet_loss(vec3(wi.xy, ci), alpha, reflects ? d.eta : 1.0 / d.eta, distribution);
    return lost * ci * INV_PI *
           (reflects ? d.reflected / d.mean_loss.x : (1.0 - d.reflected) / (d.mean_loss.y * sqr(d.eta)));
}

#endif
