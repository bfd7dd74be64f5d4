// SPDX-License-Identifier: Apache-2.0
// One path step, the physics of a path vertex, used by every tracer: emission with its MIS weight, next-event
// estimation (gives a shadow ray), BSDF sampling (gives the next ray, which is also the BSDF half of the MIS), Russian
// roulette. pbrt 4ed, 13.4; Veach 1997, ch. 9. Independent of who finds the hits. The wavefront defines EMISSION_APART: its
// emission has a kernel of its own.
//
// The material composer defines before this file: Material (the parameter struct), material_fetch, material_eval,
// material_pdf, material_sample, material_albedo, with an Rng argument that most materials ignore.
#ifndef RESTAGE_PATH_STEP
#define RESTAGE_PATH_STEP
#include <restage/v1/bsdf.glsl>
#include "lib/light.glsl"
#include "lib/sampler.glsl"
#include "path/catcher.glsl"
#include "path/emission.glsl"
#include "path/film.glsl"
#include "path/photons.glsl"
#include "path/guided.glsl"
#ifdef MATERIAL_SITE
#include "lib/site.glsl"
#endif
#include "shared/path_data.h"

// Roulette leaves paths alone above this throughput, and brings others up to it. 1 kills too many that still matter, 0.1
// keeps too many that do not. Of 1, 0.3, 0.2, 0.1 and 0.05 this gives the least variance times rays on four of seven
// scenes, and within 3 % of it on the others.
const float ROULETTE_LEVEL = 0.3;

// Of a single sample's albedo. Four wavelengths scatter around a colour, and their mean must stay the colour.
#ifdef RESTAGE_SPECTRAL
const vec3 ALBEDO_LEAST = vec3(-16), ALBEDO_MOST = vec3(16);
#else
const vec3 ALBEDO_LEAST = vec3(0), ALBEDO_MOST = vec3(1);
#endif

// From a hit, of `ray` at t, to the next rays. Returns false if something was not finite: the path then ends, and
// contributes no more.
bool path_step(SceneData scene, InstanceData inst, MaterialData material_data, uint prim, vec2 bary, float t,
               StepRay ray, inout PathState path, out StepRay shadow, out Spectrum shadow_contribution,
               out StepRay next, out GuideSample guide) {
    shadow.tmax = -1.0;
    next.tmax = -1.0;
    next.tmin = 0.0;
    next.receiver = 0u;
    shadow_contribution = Spectrum(0);
    guide = guide_nothing(1.0);
    vec3 wo_world = -ray.direction;
    uint depth = path.flags & PATH_DEPTH_MASK;

    Surface s = surface_at(scene, inst, material_data, prim, bary, t, ray);
    if (HAS_MEDIA) path.throughput *= absorb_to_hit(scene, path.medium, t, ray);

#ifndef EMISSION_APART
    float pdf_light;
    if ((inst.flags & INSTANCE_EMITS) != 0u)
        path.radiance += surface_emission(scene, inst, prim, bary, s, t, ray, path, pdf_light);
#endif

    bool photon = HAS_CAUSTICS && (path.flags & PATH_PHOTON) != 0u;
    bool catches = HAS_CATCHERS && (inst.flags & INSTANCE_CATCHES) != 0u && (photon || depth == 0u);
    bool caught = catches && !photon;
    // A lamp without a surface: the ray keeps its origin, so that distances stay those to the last vertex.
    if (HAS_GLOW && (inst.flags & INSTANCE_PASSES) != 0u && !catches) {
        float away = s.offset + EPS * (6.0 * dot(abs(ray.origin), vec3(1)) + 15.0 * t); // see light_offset
        next = ray;
        next.tmin = t * (1.0 + 4.0 * EPS) + away / max(abs(dot(wo_world, s.ng)), 1e-4);
        next.tmax = 1e30;
        guide.weight = -1.0; // not a guide
        // As a border it may lie in neither part of the ray, or in both.
        if (HAS_MEDIA && (inst.flags & INSTANCE_HAS_MEDIA) != 0u)
            path.medium = dot(ray.direction, s.ng) > 0.0 ? inst.exterior : inst.interior;
        return finite(path.radiance);
    }

    Material m = material_fetch(scene, material_data.params, texture_at(scene, inst, prim, bary, s.uv));
#ifdef RESTAGE_SPECTRAL
    if (HAS_CURVES && path_disperses && (path.flags & PATH_HERO) == 0u) { // a direction is right for one wavelength only
        path.throughput *= Spectrum(4, 0, 0, 0);
        path.flags |= PATH_HERO;
    }
#endif
#ifdef MATERIAL_SITE
    m.site = make_site(scene, inst, prim, bary, s.p, s.ng);
#endif
    vec3 wo = to_local(s, wo_world);
    if (HAS_GUIDES && (path.flags & PATH_GUIDED) != 0u) {
        Spectrum seen = depth == 0u ? Spectrum(1) : abs(path.throughput) / (scene.filter_.weight.x * scene.filter_.weight.y);
        vec3 albedo = rgb_from_spectrum(seen * material_albedo(m, wo));
        guide.albedo = finite(albedo) ? clamp(albedo, ALBEDO_LEAST, ALBEDO_MOST) : vec3(0);
        guide.normal = finite(s.ns) ? s.ns : vec3(0);
        guide.depth = t;
        guide.coverage = 1.0;
        guide.instance_id = inst.object_id;
        guide.material_id = material_data.id;
    }
    if (caught) {
        path.flags |= PATH_CAUGHT;
        guide.albedo = guide.normal = vec3(0);
        guide.backdrop = behind_catcher(scene, path, ray.direction);
    }
    bool last = depth >= scene.max_depth;
    Rng rng = Rng(pcg_hash(path.seed ^ pcg_hash(path.sample_index * 64u + depth)));
    uvec2 pick = sample_bits(path.seed, path.sample_index, pair_light_pick(depth));
    float u_lobe = to_unit(sample_bits(path.seed, path.sample_index, pair_lobe(depth)).x);
    bool ok = true;
    uint receiver = receiver_bits(wo.z < 0.0 ? -s.ns : s.ns);

    Guide directions;
    if (HAS_GUIDING) directions = guide_at(GuidingRef(scene.guiding).guiding, s, m, wo);
    if (HAS_GUIDING && (photon || caught)) directions.share = 0.0;

    // Next-event estimation
    if (LIGHT_ROOTS > 0u) {
        LightSample light = light_sample(scene, receiver_at(s.p, receiver), pick.x, sample_bits(path.seed, path.sample_index, pair_light(depth)));
        if (!last && !photon && light.pdf > 0.0 && (STRATEGY != 2 || light.delta || light.unseen > 0.0 || caught)) {
            vec3 wi = to_local(s, light.wi);
            // Shading and geometry must agree on reflection or transmission, or light would leak through surfaces.
            bool same_side = dot(light.wi, s.ng) * dot(wo_world, s.ng) > 0.0;
            Spectrum f = same_side == same_hemisphere(wo, wi) ? material_eval(m, wo, wi, rng) : Spectrum(0);
            if (caught) f = same_side ? catcher_eval(wo, wi) : Spectrum(0);
            ok = finite(f);
            if (max_component(f) > 0.0) {
                float pdf = light.delta || STRATEGY == 2 ? 0.0 : material_pdf(m, wo, wi, rng);
                if (HAS_GUIDING && !light.delta) pdf = guided_pdf(directions, light.wi, pdf);
                float w = light.delta ? 1.0 : STRATEGY == 2 ? 0.0 : mis_weight(light.pdf, pdf);
                if (caught) w = 1.0;
                if (HAS_LIGHT_ALPHA) w = mix(w, 1.0, light.unseen);
                Spectrum c = path.throughput * f * light.radiance * (w / light.pdf);
                uint medium = path.medium;
                if (HAS_MEDIA && (inst.flags & INSTANCE_HAS_MEDIA) != 0u)
                    medium = dot(light.wi, s.ng) > 0.0 ? inst.exterior : inst.interior;
                if (HAS_MEDIA) c *= absorb(scene, medium, light.dist);
                shadow.medium = medium;
                shadow_contribution = clamp_contribution(scene, c, depth);
                if (caught) {
                    path.radiance -= shadow_contribution;
                    guide.without = rgb_from_spectrum(shadow_contribution);
                }
                shadow.origin = offset_origin(s.p, s.ng, s.offset, light.wi);
                shadow.direction = light.wi;
                shadow.tmax = 1e30;
                if (light.dist < 1e30) { // from start to end: both are off their surfaces
                    vec3 d = light.end - shadow.origin;
                    shadow.tmax = length(d);
                    shadow.direction = d / shadow.tmax;
                    if (!positive(dot(d, light.wi))) { // closer than floats can resolve: nothing is between
                        path.radiance += shadow_contribution;
                        shadow.tmax = -1.0;
                    }
                }
            }
        }
    }

    // BSDF sampling
    vec2 u = sample_pair(path.seed, path.sample_index, pair_bsdf(depth));
    bool guided = HAS_GUIDING && u.x < directions.share;
    if (HAS_GUIDING) u.x = guided ? u.x / directions.share : (u.x - directions.share) / (1.0 - directions.share);
    BsdfSample b = material_sample(m, wo, vec3(u, u_lobe), rng);
    if (caught) b = catcher_sample(wo, u);
    if (HAS_GUIDING && !caught) {
        float roulette;
        b = guided_sample(directions, m, s, wo, u, guided, b, rng, roulette);
        path.eta_scale *= roulette;
    }
    if (HAS_CAUSTICS && (photon ? depth > 0u : !last && photon_map.count > 0u) && scatters(m, wo, b, rng)) {
        if (photon) photon_stop(s, wo_world, path.radiance * path.throughput);
        else path.radiance += clamp_contribution(scene, path.throughput * gather_photons(m, s, wo_world, path.sample_index, rng), depth + 1u);
    }
    Spectrum colors = shadow_contribution + path.radiance;
    vec3 others = vec3(0);
    if (shadow.tmax > 0.0) others += shadow.origin + shadow.direction;
    if (b.flags != 0u) {
        colors += b.weight;
        others += b.wi + vec3(b.pdf, b.eta, 0.0);
    }
    ok = ok && finite(colors) && finite(others);
    if (!ok) {
        shadow.tmax = -1.0;
        return false;
    }
    if (last || b.flags == 0u || !positive(max_component(b.weight))) return true;
    vec3 wi_world = to_world(s, b.wi);
    bool same_side = dot(wi_world, s.ng) * dot(wo_world, s.ng) > 0.0;
    if (same_side != ((b.flags & BSDF_REFLECT) != 0u)) return true;
    path.throughput *= b.weight;
    bool delta = (b.flags & BSDF_DELTA) != 0u;
    if (photon) { // power, not radiance, which refraction scales by eta^2
        if (!delta || (photon_role & ROLE_CASTER) == 0u) return true;
        path.throughput *= sqr(b.eta) * shading_correction(s, wo_world, wi_world);
    }
    path.pdf = b.pdf;
    path.eta_scale *= b.eta * b.eta;
    if (HAS_MEDIA && !same_side && (inst.flags & INSTANCE_HAS_MEDIA) != 0u)
        path.medium = dot(wi_world, s.ng) > 0.0 ? inst.exterior : inst.interior;
    path.flags = (depth + 1u) | (path.flags & (HAS_CATCHERS ? PATH_HERO | PATH_CAUGHT : PATH_HERO)) | (delta ? PATH_SPECULAR | (path.flags & PATH_GUIDED) : 0u) |
                 (HAS_CAUSTICS ? photon_flags(path.flags, photon_role, delta) : 0u);

    // Russian roulette on throughput, blind to the eta^2 of radiance inside glass; pbrt 4ed, 13.4.2
    // ... and not while the denoiser's guide is still ahead
    if (scene.russian_roulette != 0u && depth > 0u && !photon && !(HAS_GUIDES && (path.flags & PATH_GUIDED) != 0u)) {
        float survive = max_component(abs(path.throughput)) * path.eta_scale / ROULETTE_LEVEL; // signed by some pixel filters
        if (survive < 1.0) {
            if (to_unit(pick.y) >= survive) return true;
            path.throughput /= survive;
        }
    }
    if (HAS_GUIDES && (path.flags & PATH_GUIDED) != 0u) { // guides look through, as Open Image Denoise advises
        guide.albedo = vec3(0);
        guide.normal = vec3(0);
    }
    next.origin = offset_origin(s.p, s.ng, s.offset, wi_world);
    next.direction = normalize(wi_world);
    if (!finite(next.origin + next.direction)) {
        shadow.tmax = -1.0;
        return false;
    }
    next.tmax = 1e30;
    next.receiver = receiver;
    return true;
}

#endif
