// Lambert's reflection, as a material of 0.2.
#include <restage/v1/sampling.glsl>
#include <restage/v1/table.glsl>

Spectrum velvet02_tint(velvet02_Params m) { return m.tint * (m.twill == 1 ? 0.5 : 1.0); }

Spectrum velvet02_eval(velvet02_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? velvet02_tint(m) * INV_PI * abs_cos(wi) : Spectrum(0);
}

float velvet02_pdf(velvet02_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? cosine_hemisphere_pdf(abs_cos(wi)) : 0.0;
}

BsdfSample velvet02_sample(velvet02_Params m, vec3 wo, vec3 u) {
    vec3 wi = sample_cosine_hemisphere(u.xy);
    float pdf = cosine_hemisphere_pdf(wi.z);
    if (!positive(pdf) || wo.z == 0.0)
        return BSDF_NONE;
    if (wo.z < 0.0)
        wi.z = -wi.z;
    return BsdfSample(wi, velvet02_tint(m), pdf, BSDF_REFLECT, 1.0);
}

Spectrum velvet02_albedo(velvet02_Params m, vec3 wo) { return velvet02_tint(m); }
