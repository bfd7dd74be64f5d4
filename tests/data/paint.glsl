// A diffuse material for tests that edit one: COLOR is replaced by what it is to reflect.
#include <restage/v1/sampling.glsl>
Spectrum paint_eval(paint_Params m, vec3 wo, vec3 wi) {
    return same_hemisphere(wo, wi) ? COLOR * INV_PI * abs_cos(wi) : Spectrum(0);
}
float paint_pdf(paint_Params m, vec3 wo, vec3 wi) { return same_hemisphere(wo, wi) ? abs_cos(wi) * INV_PI : 0.0; }
BsdfSample paint_sample(paint_Params m, vec3 wo, vec3 u) {
    vec3 wi = sample_cosine_hemisphere(u.xy);
    float pdf = wi.z * INV_PI;
    if (wo.z < 0.0)
        wi.z = -wi.z;
    return pdf > 0.0 && wo.z != 0.0 ? BsdfSample(wi, COLOR, pdf, BSDF_REFLECT, 1.0) : BSDF_NONE;
}
Spectrum paint_albedo(paint_Params m, vec3 wo) { return COLOR; }
