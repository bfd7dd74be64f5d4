// SPDX-License-Identifier: Apache-2.0
// Cloth fibres: the "Charlie" distribution with its fitted masking. Estevez and Kulla 2017, "Production Friendly
// Microfacet Sheen BRDF"; KHR_materials_sheen takes alpha = roughness^2. Directions have z > 0.
#ifndef RESTAGE_V1_SHEEN
#define RESTAGE_V1_SHEEN

#include <restage/v1/bsdf.glsl>

const float SHEEN_LEAST_ALPHA = 0.01; // the fit of the albedo ends here

float sheen_alpha(float roughness) { return max(sqr(clamp(roughness, 0.0, 1.0)), SHEEN_LEAST_ALPHA); }

// Estevez and Kulla 2017, Eq. 2.
float sheen_d(float cos_h, float alpha) {
    float sin2 = max(1.0 - cos_h * cos_h, 0.0);
    return (2.0 + 1.0 / alpha) * pow(sin2, 0.5 / alpha) / TWO_PI;
}

// Eq. 3 and table 1, without the softening of the terminator (sec. 4), which is not reciprocal.
float sheen_lambda(float c, float alpha) {
    float t = sqr(1.0 - alpha);
    float a = mix(21.5473, 25.3245, t), b = mix(3.82987, 3.32435, t), d = mix(0.19823, 0.16801, t);
    float e = mix(-1.97760, -1.27393, t), f = mix(-4.32054, -4.85967, t);
    float x = min(c, 1.0 - c);
    float l = a / (1.0 + b * pow(max(x, 0.0), d)) + e * x + f;
    float half_way = a / (1.0 + b * pow(0.5, d)) + e * 0.5 + f;
    return exp(c < 0.5 ? l : 2.0 * half_way - l);
}

// Directional albedo of the above: a fit to its integral, error 0.006. Less accurate beyond 1 (alpha < 0.1, grazing).
float sheen_albedo_unlimited(float c, float alpha) {
    float x = pow(clamp(c, 0.0, 1.0), 1.0 / 3.0) - 0.6;
    float b = sqrt(sqrt(alpha)) - 0.65;
    vec4 p = vec4(1, b, b * b, b * b * b);
    float q = p.z * p.z;
    float c0 = dot(p, vec4(-0.997, 1.254, 1.026, 10.353)) - 39.137 * q;
    float c1 = dot(p, vec4(-3.339, 8.731, -30.87, 90.216)) - 118.64 * q;
    float c2 = dot(p, vec4(-4.446, 23.256, -93.458, 140.921)) + 13.165 * q;
    float c3 = dot(p, vec4(-8.94, 51.444, -124.765, -96.272)) + 535.743 * q;
    float c4 = dot(p, vec4(-17.863, 62.296, 63.568, -469.444)) + 250.344 * q;
    float c5 = dot(p, vec4(-5.087, 25.228, 198.281, -345.324)) - 517.999 * q;
    return exp(c0 + x * (c1 + x * (c2 + x * (c3 + x * (c4 + x * c5)))));
}
float sheen_albedo(float c, float alpha) { return min(sheen_albedo_unlimited(c, alpha) + 0.006, 1.0); }

// f |cos wi| of a white sheen. Where the model would return more light than it receives, it is scaled down, in both
// directions alike; by 0.006 more, the fit's error, so that it never gains.
float sheen_value(vec3 wo, vec3 wi, float alpha) {
    vec3 h = normalize(wo + wi);
    float g = 1.0 / (1.0 + sheen_lambda(wo.z, alpha) + sheen_lambda(wi.z, alpha)); // Eq. 4: height-correlated
    float most = max(sheen_albedo_unlimited(wo.z, alpha), sheen_albedo_unlimited(wi.z, alpha)) * 1.01 + 0.006;
    return sheen_d(h.z, alpha) * g / (4.0 * wo.z) / max(most, 1.0);
}

// Uniform over the hemisphere, as the paper proposes: the lobe is broad and highest at its rim.
vec3 sheen_sample(vec2 u) {
    float phi = TWO_PI * u.y;
    return vec3(sqrt(max(0.0, 1.0 - u.x * u.x)) * vec2(cos(phi), sin(phi)), u.x);
}
const float SHEEN_PDF = 1.0 / TWO_PI;

#endif
