// SPDX-License-Identifier: Apache-2.0
// Computes the Site of a hit, for materials (MATERIAL_SITE) and textures (RESTAGE_TEXTURE_SITES) that request it.
// It is not part of the path state.
#ifndef RESTAGE_LIB_SITE
#define RESTAGE_LIB_SITE
#include "lib/outward.glsl"
#include "lib/quadric.glsl"
#include "lib/scene.glsl"
#include <restage/v1/rng.glsl>
#include <restage/v1/site.glsl>

// The displacement, from one pixel to the next, of a point p on the plane with unit normal n, in world space. Exact to first
// order for points visible to a pinhole camera, and for orthographic cameras; for others as if the camera were rotated to see
// p in the middle of its picture.
void pixel_footprint(CameraData camera, vec3 p, vec3 n, out vec3 dx, out vec3 dy) {
    vec3 x = camera.camera_to_world[0], y = camera.camera_to_world[1], z = normalize(camera.camera_to_world[2]);
    vec2 size = vec2(camera.width, camera.height);
    vec2 pixel = (camera.screen_max - camera.screen_min) / size;
    vec3 d = z; // a ray of the pixel; the next one has direction d + pixel.x * x, or starts displaced by that
    if (CAMERA_KIND != CAMERA_ORTHOGRAPHIC) {
        x = normalize(x);
        y = normalize(y);
        d = p - camera.camera_to_world[3];
        float depth = dot(d, z);
        vec2 edge = max(abs(camera.screen_min), abs(camera.screen_max)) * depth;
        bool seen = CAMERA_KIND == CAMERA_PERSPECTIVE && depth > 0.0 && abs(dot(d, x)) <= edge.x && abs(dot(d, y)) <= edge.y;
        if (!seen) {
            if (CAMERA_KIND >= CAMERA_SPHERICAL) pixel = vec2(TWO_PI, PI) / size;
            depth = max(length(d), 1e-30);
            vec3 h = z + d / depth; // the rotation that takes z to d
            float k = 1.0 / max(1.0 + dot(z, d) / depth, 1e-4);
            x -= h * (dot(h, x) * k);
            y -= h * (dot(h, y) * k);
        }
        d /= depth;
        pixel *= depth;
    }
    float c = dot(n, d);
    c = (c < 0.0 ? -1.0 : 1.0) * max(abs(c), 1e-4);
    dx = pixel.x * (x - d * (dot(n, x) / c));
    dy = pixel.y * (y - d * (dot(n, y) / c));
}

// (s, t) of the v = s a + t b closest to it.
vec2 coordinates(vec3 v, vec3 a, vec3 b) {
    float aa = dot(a, a), ab = dot(a, b), bb = dot(b, b), va = dot(v, a), vb = dot(v, b);
    float det = aa * bb - ab * ab;
    return positive(det) ? vec2(bb * va - ab * vb, aa * vb - ab * va) / det : vec2(0);
}

// p: the point in the kernels' world; ng: unit, on the outside.
Site make_site(SceneData scene, InstanceData inst, uint prim, vec2 bary, vec3 p, vec3 ng) {
    Site site;
    vec3 dx, dy;
    pixel_footprint(scene.camera, p, ng, dx, dy);
    site.footprint = max(length(dx), length(dy));
    site.dp_dx = to_object_direction(inst, dx);
    site.dp_dy = to_object_direction(inst, dy);
    site.world = p + scene.world_origin;
    site.normal = ng;
    site.object = pcg_hash(inst.object_id);
    site.uv = bary;
    if (HAS_QUADRICS && (inst.flags & INSTANCE_QUADRIC) != 0u) {
        QuadricData q = quadric_of(inst);
        site.position = quadric_refine(q, to_object(inst, p));
        vec3 dpdu, dpdv;
        quadric_tangents(q, site.position, dpdu, dpdv);
        site.duv_dx = coordinates(site.dp_dx, dpdu, dpdv);
        site.duv_dy = coordinates(site.dp_dy, dpdu, dpdv);
        return site;
    }
    uvec3 tri = Uvec3Array(inst.indices).at[prim];
    Vec3Array positions = Vec3Array(inst.positions);
    vec3 p0 = positions.at[tri.x];
    vec3 e1 = positions.at[tri.y] - p0, e2 = positions.at[tri.z] - p0;
    site.position = p0 + (bary.x * e1 + bary.y * e2);
    mat2 uvs = mat2(1.0); // changes of uv along the edges
    if ((inst.flags & INSTANCE_HAS_UVS) != 0u) {
        Vec2Array at = Vec2Array(inst.uvs);
        vec2 uv0 = at.at[tri.x];
        uvs = mat2(at.at[tri.y] - uv0, at.at[tri.z] - uv0);
        site.uv = uv0 + uvs * bary;
    }
    site.duv_dx = uvs * coordinates(site.dp_dx, e1, e2);
    site.duv_dy = uvs * coordinates(site.dp_dy, e1, e2);
    return site;
}

// Likewise from the hit only.
Site site_of_hit(SceneData scene, InstanceData inst, uint prim, vec2 bary) {
    vec3 p;
    if (HAS_QUADRICS && (inst.flags & INSTANCE_QUADRIC) != 0u) {
        p = quadric_at(quadric_of(inst), bary);
    } else {
        uvec3 tri = Uvec3Array(inst.indices).at[prim];
        Vec3Array positions = Vec3Array(inst.positions);
        vec3 p0 = positions.at[tri.x];
        p = p0 + (bary.x * (positions.at[tri.y] - p0) + bary.y * (positions.at[tri.z] - p0));
    }
    vec3 n = normalize(outward_normal(inst, prim, bary));
    return make_site(scene, inst, prim, bary, inst.object_to_world * vec4(p, 1.0), n);
}

#endif
