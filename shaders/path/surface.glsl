// SPDX-License-Identifier: Apache-2.0
// Surface: a hit as seen by the path step. Built from the triangle, in world space, with the shading frame and
// the bound of its own rounding error.
#ifndef RESTAGE_PATH_SURFACE
#define RESTAGE_PATH_SURFACE
#include <restage/v1/bsdf.glsl>
#include "lib/quadric.glsl"
#include "lib/ray_offset.glsl"
#include "lib/scene.glsl"
#include "lib/texture.glsl"
#include "lib/words.glsl"
#include "shared/normal.h"
#include <restage/v1/frame.glsl>

struct Surface {
    vec3 p;
    vec3 ng;      // unit, geometric, the outside
    vec3 ns;      // unit, shading
    vec3 ss, ts;  // with ns an orthonormal frame; right-handed unless the mesh's tangents say that uv are mirrored
    vec4 uv;      // both sets
    float offset; // along ng, required by a leaving ray
};

void orthonormal_basis(vec3 n, out vec3 s, out vec3 t) {
    Frame f = frame_from_normal(n);
    s = f.t;
    t = f.b;
}

vec3 to_local(Surface s, vec3 w) { return vec3(dot(w, s.ss), dot(w, s.ts), dot(w, s.ns)); }
vec3 to_world(Surface s, vec3 w) { return s.ss * w.x + s.ts * w.y + s.ns * w.z; }

// Frame around ns with s as close to dpdu as possible.
void set_frame(inout Surface s, vec3 dpdu) {
    vec3 t = dpdu - s.ns * dot(dpdu, s.ns);
    float l = dot(t, t);
    if (l > 1e-20 * dot(dpdu, dpdu) && l > 0.0) {
        s.ss = t * inversesqrt(l);
        s.ts = cross(s.ns, s.ss);
    } else {
        orthonormal_basis(s.ns, s.ss, s.ts);
    }
}

// Bump map: the normal of the displaced surface p + d(uv) n. Blinn 1978; pbrt 4ed, 10.5.3.
void apply_bump(SceneData scene, InstanceData inst, uint texture_id, TextureAt at, vec3 dpdu, vec3 dpdv,
                inout Surface s) {
    const float h = 0.0005; // in uv, as in pbrt without ray differentials
    float d = texture_number(scene, texture_id, at);
    float du = (texture_number(scene, texture_id, texture_moved(at, inst, vec2(h, 0), h * dpdu)) - d) / h;
    float dv = (texture_number(scene, texture_id, texture_moved(at, inst, vec2(0, h), h * dpdv)) - d) / h;
    vec3 n = s.ns;
    vec3 a = dpdu + du * n, b = dpdv + dv * n;
    vec3 m = cross(a, b);
    float l = dot(m, m);
    if (!positive(l)) return;
    m *= inversesqrt(l);
    s.ns = dot(m, n) < 0.0 ? -m : m;
    set_frame(s, a);
}

// The normal in the frame of the tangent; `side` is -1 if its y opposes cross(normal, tangent).
void apply_normal_map(SceneData scene, uint texture_id, TextureAt at, vec3 tangent, float side, inout Surface s) {
    vec3 m = 2.0 * texture_data(scene, texture_id, at) - 1.0;
    if (is_nan(dot(m, m)) || dot(m, m) <= 1e-6) return;
    set_frame(s, tangent);
    s.ts *= side;
    s.ns = normalize(to_world(s, normalize(m)));
    set_frame(s, tangent);
}

// Rotates the shading normal just enough for wo to lie on the same side of it as of the geometry, so that light neither
// leaks nor vanishes at silhouettes. Keller et al. 2017, "The Iray Light Transport Simulation and Rendering System", A.3.
void adapt_shading_normal(vec3 wo, inout Surface s) {
    float side = dot(wo, s.ng) < 0.0 ? -1.0 : 1.0;
    float c = dot(wo, s.ns) * side;
    if (c >= 1e-3) return;
    vec3 n = normalize(s.ns * side + wo * (1e-3 - c)) * side;
    s.ns = n;
    vec3 t = s.ss - n * dot(s.ss, n);
    float l = dot(t, t);
    if (l > 1e-8) {
        s.ss = t * inversesqrt(l);
        s.ts = cross(n, s.ss);
    } else {
        orthonormal_basis(n, s.ss, s.ts);
    }
}

// For a quadric hit by the ray from `origin` at t * direction.
Surface quadric_surface(SceneData scene, InstanceData inst, MaterialData material, vec2 uv, vec3 origin, vec3 direction, float t) {
    Surface s;
    QuadricData q = quadric_of(inst);
    vec3 p = quadric_refine(q, to_object(inst, origin) + t * to_object_direction(inst, direction));
    s.p = inst.object_to_world * vec4(p, 1.0);
    s.ng = normalize(inst.normal_to_world * quadric_normal(q, p));
    if ((inst.flags & INSTANCE_FLIP_NORMAL) != 0u) s.ng = -s.ng;
    s.ns = s.ng;
    s.offset = scene.ray_epsilon > 0.0 ? scene.ray_epsilon : quadric_offset(inst, q, p, s.p, s.ng);
    s.uv = uv.xyxy;
    if (HAS_TANGENTS) {
        vec3 dpdu, dpdv;
        quadric_tangents(q, p, dpdu, dpdv);
        dpdu = linear_part(inst) * dpdu;
        dpdv = linear_part(inst) * dpdv;
        set_frame(s, dpdu);
        TextureAt at = texture_at(scene, inst, 0u, uv, s.uv);
        if (HAS_BUMP && material.bump != 0u) apply_bump(scene, inst, material.bump, at, dpdu, dpdv, s);
        if (HAS_BUMP && material.normal_map != 0u) apply_normal_map(scene, material.normal_map, at, dpdu, 1.0, s);
    } else {
        orthonormal_basis(s.ns, s.ss, s.ts);
    }
    adapt_shading_normal(-direction, s);
    return s;
}

// Barycentrics place a hit to some ulps of the triangle's edges. If these are much longer than the ray, the ray places it
// better within the plane: else a hit near the edge of a room with walls of 1e4 times its size may lie behind the next wall.
vec3 refined_hit(InstanceData inst, vec3 e1, vec3 e2, vec3 p, vec3 ng, vec3 origin, vec3 direction, float t) {
    mat3 lin = linear_part(inst);
    vec3 size = mat3(abs(lin[0]), abs(lin[1]), abs(lin[2])) * (abs(e1) + abs(e2));
    vec3 on_ray = origin + t * direction;
    vec3 q = on_ray - ng * dot(ng, on_ray - p);
    return max_component(size) > 16.0 * (max_component(abs(origin)) + t) ? q : p;
}

// For a triangle hit by the ray from `origin` at t * direction.
Surface make_surface(SceneData scene, InstanceData inst, MaterialData material, uint prim, vec2 bary, vec3 origin, vec3 direction,
                     float t) {
    Surface s;
    uvec3 tri = uvec3_at(inst.indices, prim);
    vec3 p0 = vec3_at(inst.positions, tri.x);
    vec3 e1 = vec3_at(inst.positions, tri.y) - p0, e2 = vec3_at(inst.positions, tri.z) - p0;
    vec3 p = p0 + (bary.x * e1 + bary.y * e2);
    s.p = inst.object_to_world * vec4(p, 1.0);
    vec3 ng = normalize(inst.normal_to_world * cross(e1, e2));
    bool reversed = (inst.flags & INSTANCE_FLIP_NORMAL) != 0u;
    float along = 0.0;
    bool shaded = false;
    if ((inst.flags & INSTANCE_HAS_NORMALS) != 0u) {
        vec3 n = (1.0 - bary.x - bary.y) * vec3_at(inst.normals, tri.x) + bary.x * vec3_at(inst.normals, tri.y) +
                 bary.y * vec3_at(inst.normals, tri.z);
        n = inst.normal_to_world * n;
        float l = dot(n, n);
        if (l > 0.0) {
            s.ns = n * inversesqrt(l);
            along = dot(ng, s.ns);
            if (reversed) s.ns = -s.ns;
            shaded = true;
        }
    }
    if (points_inward(along, reversed)) ng = -ng;
    s.ng = ng;
    s.p = refined_hit(inst, e1, e2, s.p, ng, origin, direction, t);
    if (!shaded) s.ns = ng;
    s.offset = scene.ray_epsilon > 0.0 ? scene.ray_epsilon
                                       : ray_offset(p0, e1, e2, p, s.p, inst.object_to_world, inst.normal_to_world, ng,
                                                    scene.world_copies);

    vec2 uv = bary;
    vec2 duv1 = vec2(1, 0), duv2 = vec2(0, 1);
    if ((HAS_TEXTURES || HAS_TANGENTS) && (inst.flags & INSTANCE_HAS_UVS) != 0u) {
        vec2 uv0 = vec2_at(inst.uvs, tri.x);
        duv1 = vec2_at(inst.uvs, tri.y) - uv0;
        duv2 = vec2_at(inst.uvs, tri.z) - uv0;
        uv = uv0 + bary.x * duv1 + bary.y * duv2;
    }
    s.uv = vec4(uv, HAS_TEXTURES ? second_uv(inst, tri, bary, uv) : uv);
    float side = 1.0;
    if (HAS_TANGENTS) { // pbrt 4ed, 6.5.3: solve for dp/du, dp/dv
        mat3 lin = mat3(inst.object_to_world[0], inst.object_to_world[1], inst.object_to_world[2]);
        vec2 products = vec2(duv1.x * duv2.y, duv1.y * duv2.x);
        float det = products.x - products.y;
        vec3 dpdu, dpdv;
        if (abs(det) > 1e-6 * (abs(products.x) + abs(products.y))) { // more than rounding of its terms
            dpdu = lin * ((duv2.y * e1 - duv1.y * e2) / det);
            dpdv = lin * ((duv1.x * e2 - duv2.x * e1) / det);
        } else {
            orthonormal_basis(s.ns, dpdu, dpdv);
        }
        vec3 tangent = dpdu;
        if (inst.tangents != uint64_t(0)) { // glTF 2.0, 3.7.2.1; a mirrored object also mirrors its bitangents
            Vec4Array tangents = Vec4Array(inst.tangents);
            vec4 t = (1.0 - bary.x - bary.y) * tangents.at[tri.x] + bary.x * tangents.at[tri.y] + bary.y * tangents.at[tri.z];
            if (dot(t.xyz, t.xyz) > 0.0) {
                tangent = lin * t.xyz;
                bool mirrored = dot(cross(lin[0], lin[1]), lin[2]) < 0.0;
                bool turned = (inst.flags & INSTANCE_FLIP_NORMAL) != 0u;
                side = (t.w < 0.0) != (mirrored != turned) ? -1.0 : 1.0;
            }
        }
        set_frame(s, tangent);
        TextureAt at = texture_at(scene, inst, prim, bary, s.uv);
        if (HAS_BUMP && material.bump != 0u) apply_bump(scene, inst, material.bump, at, dpdu, dpdv, s);
        if (HAS_BUMP && material.normal_map != 0u) apply_normal_map(scene, material.normal_map, at, tangent, side, s);
    } else {
        orthonormal_basis(s.ns, s.ss, s.ts);
    }
    adapt_shading_normal(-direction, s);
    s.ts *= side;
    return s;
}

#endif
