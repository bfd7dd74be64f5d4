// SPDX-License-Identifier: Apache-2.0
// Textures: postfix programs, data, whose operations are a switch over the types that the scene has: where there are
// some, render/texture_composer.cpp writes texture_operation(). Images are filtered bilinearly as pbrt does without mip
// levels (pbrt 4ed, 10.4). Texels live in buffers, linear: the same result on every device, without descriptors.
// render/texture_program.cpp does the same in C++, for cut-outs and mixes that the CPU resolves.
#ifndef RESTAGE_LIB_TEXTURE
#define RESTAGE_LIB_TEXTURE
#include "lib/scene.glsl"
#include <restage/v1/texture.glsl>
#ifdef RESTAGE_TEXTURE_SITES
#include "lib/site.glsl"
#endif

vec4 texel(ImageData image, ivec2 p, uint wrap) {
    ivec2 size = ivec2(image.width, image.height);
    if (wrap == WRAP_REPEAT) {
        p -= ivec2(floor(vec2(p) / vec2(size))) * size;
    } else if (wrap == WRAP_BLACK && (any(lessThan(p, ivec2(0))) || any(greaterThanEqual(p, size)))) {
        return vec4(0);
    }
    p = clamp(p, ivec2(0), size - 1);
    uint i = uint(p.y) * image.width + uint(p.x);
    if (image.format == TEXEL_HALF4) {
        uvec2 h = Uvec2Array(image.texels).at[i];
        return vec4(unpackHalf2x16(h.x), unpackHalf2x16(h.y));
    }
    return Vec4Array(image.texels).at[i];
}

// st: s to the right, t *upwards* (pbrt): row 0 of the image is at t = 1.
vec4 image_bilinear(ImageData image, vec2 st, uint wrap) {
    vec2 x = vec2(st.x, 1.0 - st.y) * vec2(image.width, image.height) - 0.5;
    vec2 base = floor(x);
    vec2 d = x - base;
    ivec2 p = ivec2(base);
    vec4 sum = vec4(0);
    for (int k = 0; k < 4; ++k) {
        ivec2 o = ivec2(k & 1, k >> 1);
        vec2 w = mix(1.0 - d, d, vec2(o));
        sum += w.x * w.y * texel(image, p + o, wrap);
    }
    return sum;
}

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ImageRef { ImageData image; };

const uint IMAGE_DATA_BYTES = 24u;
TextureImage texture_image_of(SceneData scene, uint image) {
    return TextureImage(scene.images + uint64_t(image * IMAGE_DATA_BYTES));
}
vec4 texture_image(TextureImage image, vec2 st, int wrap) { // declared in restage/v1/texture.glsl
    return image_bilinear(ImageRef(image.record).image, st, uint(wrap));
}

// Where a texture is asked.
struct TextureAt {
    vec4 uv; // of the first and of the second set
#ifdef RESTAGE_TEXTURE_SITES
    Site place;
#endif
};

#ifdef RESTAGE_TEXTURE_SITES
TextureAt texture_at(SceneData scene, InstanceData inst, uint prim, vec2 bary, vec4 uv) {
    return TextureAt(uv, site_of_hit(scene, inst, prim, bary));
}
TextureAt texture_at_uv(vec4 uv) { // of no object
    return TextureAt(uv, Site(uv.xy, vec2(0), vec2(0), vec3(uv.xy, 0.0), vec3(0), vec3(0), vec3(uv.xy, 0.0), vec3(0, 0, 1), 0.0, 0u));
}
// Moved by d in uv, and by p in world space.
TextureAt texture_moved(TextureAt at, InstanceData inst, vec2 d, vec3 p) {
    at.uv += d.xyxy;
    at.place.uv += d;
    at.place.world += p;
    at.place.position += to_object_direction(inst, p);
    return at;
}
#else
TextureAt texture_at(SceneData scene, InstanceData inst, uint prim, vec2 bary, vec4 uv) { return TextureAt(uv); }
TextureAt texture_at_uv(vec4 uv) { return TextureAt(uv); }
TextureAt texture_moved(TextureAt at, InstanceData inst, vec2 d, vec3 p) { return TextureAt(at.uv + d.xyxy); }
#endif

struct TextureStack {
    Spectrum a, b, c, d; // top first
};
void texture_push(inout TextureStack s, Spectrum v) { s = TextureStack(v, s.a, s.b, s.c); }
// A texturable parameter: from the stack where `bit` of the operation's first word is set.
Spectrum texture_operand(uint head, uint bit, Spectrum constant, inout TextureStack s) {
    if ((head & bit) == 0u) return constant;
    Spectrum v = s.a;
    s = TextureStack(s.b, s.c, s.d, s.d);
    return v;
}
float texture_operand(uint head, uint bit, float constant, inout TextureStack s) {
    return texture_operand(head, bit, Spectrum(constant), s).x;
}
vec3 texture_words3(UintArray w, uint at) {
    return vec3(uintBitsToFloat(w.at[at]), uintBitsToFloat(w.at[at + 1u]), uintBitsToFloat(w.at[at + 2u]));
}
TextureSite texture_site(uint head, TextureAt at, uint use_) {
    TextureSite site;
    site.uv = (head & TEXTURE_OP_SECOND_UV) != 0u ? at.uv.zw : at.uv.xy;
    site.use_ = (head & TEXTURE_OP_DATA) != 0u ? TEXTURE_DATA : use_;
#ifdef RESTAGE_TEXTURE_SITES
    site.place = at.place;
    site.duv_dx = at.place.duv_dx;
    site.duv_dy = at.place.duv_dy;
#endif
    return site;
}
// The affine map of MAPPED textures; its six words begin at `at`.
void texture_map(UintArray w, uint at, inout TextureSite site) {
    vec2 scale = vec2(uintBitsToFloat(w.at[at]), uintBitsToFloat(w.at[at + 1u]));
    vec2 shear = vec2(uintBitsToFloat(w.at[at + 4u]), uintBitsToFloat(w.at[at + 5u]));
    vec2 delta = vec2(uintBitsToFloat(w.at[at + 2u]), uintBitsToFloat(w.at[at + 3u]));
    site.uv = site.uv * scale + site.uv.yx * shear + delta;
#ifdef RESTAGE_TEXTURE_SITES
    site.duv_dx = site.duv_dx * scale + site.duv_dx.yx * shear;
    site.duv_dy = site.duv_dy * scale + site.duv_dy.yx * shear;
#endif
}
// What this shader was not composed for, as long as the one that was is being compiled, is grey; and literals.
Spectrum texture_other(UintArray w, uint head, inout uint at, TextureSite site, inout TextureStack s) {
    if ((head & TEXTURE_KIND) == TEXTURE_LITERAL) {
        at += 4u;
        return texture_color(site, texture_words3(w, at - 3u));
    }
    at += w.at[at + 1u];
    for (uint bit = TEXTURE_OP_FIRST_OPERAND; bit != 0u; bit <<= 1u)
        texture_operand(head, bit, 0.0, s);
    return Spectrum(0.5);
}

#ifdef TEXTURE_TYPES // composed: one case a type of the scene
Spectrum texture_operation(SceneData scene, UintArray w, uint head, inout uint at, TextureAt where, uint use_, inout TextureStack s);
#else
Spectrum texture_operation(SceneData scene, UintArray w, uint head, inout uint at, TextureAt where, uint use_, inout TextureStack s) {
    return texture_other(w, head, at, texture_site(head, where, use_), s);
}
#endif

// use_: TEXTURE_REFLECTANCE, TEXTURE_UNBOUNDED or TEXTURE_DATA.
Spectrum texture_eval(SceneData scene, uint texture_id, TextureAt where, uint use_) {
    TextureProgram program = TextureArray(scene.textures).at[texture_id];
    UintArray w = UintArray(scene.texture_words);
    TextureStack s = TextureStack(Spectrum(0), Spectrum(0), Spectrum(0), Spectrum(0));
    uint at = program.first;
    for (uint i = 0; i < program.count; ++i) {
        Spectrum v = texture_operation(scene, w, w.at[at], at, where, use_, s); // takes operands off the stack
        texture_push(s, v);
    }
    return s.a;
}
float texture_number(SceneData scene, uint texture_id, TextureAt where) {
    return texture_eval(scene, texture_id, where, TEXTURE_DATA).x;
}
vec3 texture_data(SceneData scene, uint texture_id, TextureAt where) {
    return texture_eval(scene, texture_id, where, TEXTURE_DATA).xyz;
}

// The fraction of rays stopped at a point of a surface.
float hit_alpha(SceneData scene, InstanceData inst, uint prim, vec2 bary) {
    float alpha = inst.alpha;
    if (inst.alpha_texture != 0u) {
        vec4 uv = hit_uv(inst, prim, bary);
        alpha = texture_number(scene, inst.alpha_texture, texture_at(scene, inst, prim, bary, uv));
    }
    if ((inst.flags & INSTANCE_ALPHA_MASK) != 0u) return alpha > 0.0 ? 1.0 : 0.0; // as in pbrt-v3's Triangle::Intersect
    return clamp(alpha, 0.0, 1.0);
}

#endif
